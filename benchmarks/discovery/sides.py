"""One side's bushing against the other's: a rig whose model may tune both alike tells their ratio only.

`LLR_L` 25 % stiffer and `LLR_R` 20 % softer are the same answer, since the common stiffness is tuned.
"""

from __future__ import annotations

from collections.abc import Mapping

ASYMMETRY = "left_right_asymmetry"
Numbers = Mapping[str, tuple[float, float]]
"""Name -> (value, standard deviation)."""


def place(effect: str, location: str) -> str:
    """A location to compare: without its side where only the ratio of the sides is told."""
    known = location.lower()
    return known.removesuffix("_l").removesuffix("_r") if effect == ASYMMETRY else known


def numbers(effect: str, given: Numbers) -> dict[str, tuple[float, float]]:
    """Parameters to compare: factors of a side as right over left."""
    if effect != ASYMMETRY:
        return dict(given)
    return dict(_right_over_left(name, *pair) for name, pair in given.items())


def _right_over_left(name: str, value: float, sd: float) -> tuple[str, tuple[float, float]]:
    bushing, _, side = name.rpartition("_")
    if side.upper() == "L" and value > 0:
        value, sd = 1.0 / value, sd / value**2
    return f"{bushing}: right over left", (value, sd)
