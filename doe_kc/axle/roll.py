"""The axle with the other roll technique."""

from __future__ import annotations

from dataclasses import replace

from doe_kc.axle.model import Axle
from doe_kc.ground.errors import InputError
from doe_kc.load_cases.roll import ROLL_TECHNIQUES


def with_roll(axle: Axle, technique: str | None, *, source: str = "roll") -> Axle:
    """The axle with that roll technique, None: as it is; InputError for an unknown one."""
    if technique is None:
        return axle
    if technique not in ROLL_TECHNIQUES:
        raise InputError(f"{source} {technique}: expected {' or '.join(ROLL_TECHNIQUES)}.")
    return replace(axle, load_cases={**axle.load_cases, "roll": ROLL_TECHNIQUES[technique]})
