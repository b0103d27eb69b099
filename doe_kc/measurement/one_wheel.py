"""A rig that measures one wheel: the other is its mirror image, which is assumed and said."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from doe_kc.curves import RIG_RESPONSES, SIDES
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase

MIRRORED_CASES = ("vertical", "lateral_opposite", "drive", "brake")
"""Load cases that are their own mirror image; in the others the right wheel at +u is the left one at -u."""
SYMMETRIC_SHARE = 0.05
"""Of the input's range: how far input and reversed input half a cycle later may differ."""


def with_mirror_image(
    label: str, case: LoadCase, values: Mapping[str, FloatArray], loop_input: FloatArray
) -> tuple[dict[str, FloatArray], tuple[str, ...]]:
    """Response -> (2, n) and the channels that were filled in by mirroring.

    values: role (`toe_L`) -> (n,). A response of neither wheel is left out. Where left and right differ in
    input, the mirror image is the other wheel half a cycle later. InputError for a record that is no
    symmetric
    cycle.
    """
    out: dict[str, FloatArray] = {}
    filled: list[str] = []
    for response in RIG_RESPONSES:
        sides = [values.get(f"{response}_{s}") for s in SIDES]
        measured = next((v for v in sides if v is not None), None)
        if measured is None:
            continue
        if any(v is None for v in sides):
            filled.append(f"{response}_{SIDES[0 if sides[0] is None else 1]}")
            sign = -1.0 if response == "wc_y" else 1.0
            image = sign * _half_cycle_later(label, case, measured, loop_input)
            sides = [image if v is None else v for v in sides]
        out[response] = np.stack([v for v in sides if v is not None])
    return out, tuple(filled)


def _half_cycle_later(label: str, case: LoadCase, values: FloatArray, loop_input: FloatArray) -> FloatArray:
    if case.id in MIRRORED_CASES:
        return values
    shift = values.size // 2
    later = np.roll(loop_input, -shift)
    if np.abs(later + loop_input).max() > SYMMETRIC_SHARE * np.ptp(loop_input):
        raise InputError(
            f"{label}: holds one wheel in a load case that moves the wheels differently, and is no symmetric "
            f"cycle through ±{case.amplitude:g} {case.unit}; expected that to mirror it, record both wheels."
        )
    return np.asarray(np.roll(values, -shift))
