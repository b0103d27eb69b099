"""Reads `--set PATH=VALUE` and `--effect ID:key=value,...`."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator
from typing import Any

from doe_kc.axle import Axle, parameter_value, with_values
from doe_kc.axle.geometry import check_geometry
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError

SETTING = re.compile(r"\s*([^=+*\s]+)\s*([+*]?=)\s*(\S+)\s*$")


def apply_settings(axle: Axle, settings: Iterable[str]) -> Axle:
    """PATH=VALUE sets, PATH+=DELTA adds, PATH*=FACTOR scales; later ones see the earlier."""
    values: dict[str, float] = {}
    for text in settings:
        match = SETTING.match(text)
        if match is None:
            raise InputError(
                f"--set {text}: expected PATH=VALUE, PATH+=DELTA or PATH*=FACTOR, as in LLF.x+=1.0."
            )
        path, operator, number = match.groups()
        now = values.get(path)
        now = parameter_value(axle, path, source="--set") if now is None else now
        values[path] = _changed(now, operator, _number(number, text))
    changed = with_values(axle, values, source="--set") if values else axle
    check_geometry(changed, "--set")
    return changed


def _changed(now: float, operator: str, operand: float) -> float:
    if operator == "+=":
        return now + operand
    return now * operand if operator == "*=" else operand


def _number(text: str, setting: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"--set {setting}: {text!r} is not a number.") from None


def apply_effects(axle: Axle, effects: Iterable[str]) -> Axle:
    """ID or ID:key=value,...; values as in TOML, lists in brackets, plain words without quotes."""
    for text in effects:
        ident, _, rest = text.partition(":")
        options = dict(_options(rest, text)) if rest else {}
        axle = apply_effect(axle, ident.strip(), options, source="--effect")
    return axle


def _options(text: str, argument: str) -> Iterator[tuple[str, Any]]:
    for part in _split(text):
        key, equals, value = part.partition("=")
        if not equals or not key.strip():
            raise InputError(f"--effect {argument}: {part!r}, expected key=value.")
        yield key.strip(), _value(value.strip())


def _split(text: str) -> Iterator[str]:
    """At commas outside brackets."""
    depth, start = 0, 0
    for i, letter in enumerate(text):
        depth += (letter in "[{") - (letter in "]}")
        if letter == "," and depth == 0:
            yield text[start:i]
            start = i + 1
    yield text[start:]


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except RecursionError:
        return text
    except ValueError:  # TOMLDecodeError; plain for a number of 5000 digits
        if text.startswith("[") and text.endswith("]"):
            return [_value(part.strip()) for part in _split(text[1:-1])]
        return text
