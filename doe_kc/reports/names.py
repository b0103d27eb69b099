"""How figures, sheets and pages call load cases, inputs and responses: one name each, everywhere."""

from __future__ import annotations

import re

from doe_kc.curves import RESPONSE_UNITS, TYRE_LOAD, response_name
from doe_kc.load_cases import LOAD_CASES
from doe_kc.load_cases.roll import ROLL_TECHNIQUES


def input_label(load_case: str, unit: str) -> str:
    """Name, sign and unit of a load case's input; the technique of a roll is told by its unit, deg or mm."""
    cases = [LOAD_CASES[load_case], *(ROLL_TECHNIQUES.values() if load_case == "roll" else ())]
    name = next((c.input_label for c in cases if c.unit == unit), "Input")
    return f"{name} [{unit}]"


def without_remark(axis: str) -> str:
    """Label of an axis without its remark on signs, which does not fit a small panel."""
    return re.sub(r" \([^)]*\)", "", axis)


def within_sentence(label: str) -> str:
    """A label that does not begin a sentence: `Roll steer` becomes `roll steer`, `WC lateral` stays."""
    return label if label[1:2].isupper() else label[:1].lower() + label[1:]


def response_axis(response: str) -> str:
    """Axis of a response's curve, with its unit; all but the tyre load are changes from static (Δ)."""
    change = "" if response == TYRE_LOAD else "Δ "
    return f"{change}{response_name(response)} [{RESPONSE_UNITS[response]}]"
