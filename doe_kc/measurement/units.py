"""Units that rig files use, and their factors to the units of the package: deg, mm, N, s."""

from __future__ import annotations

import math
from collections.abc import Mapping

from doe_kc.ground.errors import nearest

_DEG = 180.0 / math.pi
_GRAVITY = 9.80665

UNIT_FACTORS: Mapping[str, Mapping[str, float]] = {
    "deg": {
        **dict.fromkeys(("deg", "°", "degree", "degrees", "grad", "degs"), 1.0),
        **dict.fromkeys(("rad", "radian", "radians"), _DEG),
        "mrad": _DEG / 1000.0,
        **dict.fromkeys(("min", "arcmin", "'", "′", "minutes"), 1.0 / 60.0),
        **dict.fromkeys(("rev", "turn", "turns"), 360.0),
        "mdeg": 1e-3,
    },
    "mm": {
        **dict.fromkeys(("mm", "millimeter", "millimetre"), 1.0),
        **dict.fromkeys(("m", "meter", "metre"), 1000.0),
        "cm": 10.0,
        **dict.fromkeys(("µm", "μm", "um"), 1e-3),
        **dict.fromkeys(("in", "inch", '"', "inches"), 25.4),
        "ft": 304.8,
    },
    "N": {
        **dict.fromkeys(("n", "newton"), 1.0),
        "kn": 1000.0,
        "dan": 10.0,
        **dict.fromkeys(("kg", "kgf", "kp"), _GRAVITY),
        **dict.fromkeys(("lbf", "lb", "lbs"), 4.4482216152605),
    },
    "s": {
        **dict.fromkeys(("s", "sec", "second", "seconds"), 1.0),
        "ms": 1e-3,
        **dict.fromkeys(("min", "minutes"), 60.0),
        "h": 3600.0,
    },
}
"""Unit of the package -> spelling in lower case -> factor from that unit to it."""


def plain_unit(text: str) -> str:
    """A unit as it is looked up: without brackets and blanks, in lower case."""
    return text.strip().strip("[](){}").strip().lower()


def unit_factor(unit: str, target: str) -> float | None:
    """What a number in `unit` is multiplied by to be in `target` (deg, mm, N or s); None: not known of it."""
    return UNIT_FACTORS[target].get(plain_unit(unit))


def is_unit(text: str) -> bool:
    """Whether a cell below a heading reads as a unit; a dash or nothing in brackets is one, of a ratio."""
    plain = plain_unit(text)
    return plain in _OTHER or any(plain in factors for factors in UNIT_FACTORS.values())


def known_units(target: str) -> str:
    """Spellings for a message."""
    return ", ".join(UNIT_FACTORS[target])


def likely_unit(unit: str, target: str) -> str:
    """`' Did you mean "kn"?'` or nothing."""
    return nearest(plain_unit(unit), UNIT_FACTORS[target])


_OTHER = frozenset(
    (
        *("nm", "knm", "nmm", "bar", "kpa", "mpa", "psi", "v", "mv", "a", "ma", "hz", "rpm", "c", "°c", "k"),
        *("mm/s", "deg/s", "m/s", "m/s2", "m/s^2", "n/mm", "g", "deg/mm", "%", "-", "–", "1", ""),
    )
)
"""Units of channels that are not read, to tell a row of units from one of names."""
