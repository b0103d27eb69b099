"""Checked tables of numbers, as effects take them in files and calls."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from doe_kc.ground.errors import InputError, nearest


def checked_number(value: Any, name: str, *, positive: bool = False) -> float:
    """The value as a float; InputError unless it is a finite (positive) number."""
    try:
        number = math.nan if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise InputError(f"{name}, expected a finite number.")
    if positive and number <= 0:
        raise InputError(f"{name}, expected a number > 0.")
    return number


def checked_flag(value: Any, name: str) -> bool:
    """The value as a truth value; InputError unless it is true or false."""
    if not isinstance(value, bool):
        raise InputError(f"{name} = {value!r}, expected true or false.")
    return value


def named_numbers(
    options: Mapping[str, Any], known: Iterable[str], where: str, what: str, *, positive: bool = False
) -> dict[str, float]:
    """Options that are numbers by name. where: file and effect; what: such a name is, for the message."""
    known = tuple(known)
    for key in options:
        if key not in known:
            raise InputError(
                f"{where}: {key!r} is not {what}; expected one of {', '.join(known)}.{nearest(key, known)}"
            )
    return {k: checked_number(v, f"{where}: {k} = {v!r}", positive=positive) for k, v in options.items()}


def per_bushing(
    options: Mapping[str, Any], known: Collection[str], length: int, source: str
) -> dict[str, list[float]]:
    """Options of the form LLR = [x, y, z], keyed by the lower-case bushing name."""
    out = {}
    for key, value in options.items():
        if key.lower() not in known:
            raise InputError(
                f"{source}: {key!r} is not a bushing; known are {', '.join(k.upper() for k in known)}."
                f"{nearest(key.lower(), known)}"
            )
        if not isinstance(value, list | tuple) or len(value) != length:
            raise InputError(f"{source}: {key} = {value!r}, expected a list of {length} numbers.")
        out[key.lower()] = [checked_number(v, f"{source}: {key} = {value!r}") for v in value]
    return out
