"""Inputs with a wrong sign, unit or zero."""

from __future__ import annotations

import numpy as np
from corruptions.edit import INPUTS, Corruption, Edit, Frames, of_case


def input_scaled(case: str, factor: float) -> Edit:
    def edit(frames: Frames) -> None:
        for frame in of_case(frames, case):
            frame[INPUTS[case]] *= factor

    return edit


def input_shifted(case: str, offset: float) -> Edit:
    def edit(frames: Frames) -> None:
        for frame in of_case(frames, case):
            frame[INPUTS[case]] += offset

    return edit


def input_signs() -> list[Corruption]:
    """Of each load case's input."""
    out: list[Corruption] = []
    for case in INPUTS:
        name = INPUTS[case].split(" ")[0]
        kinds = ("input_sign", "sides") if case == "roll" else ("input_sign",)
        out.append(
            Corruption(f"sign of the input of {case}", kinds, f"[{name[0]}*]*", input_scaled(case, -1.0))
        )
    return out


def input_units() -> list[Corruption]:
    """Inputs in other units than their headings say."""
    out: list[Corruption] = []
    for case, factor, unit in (
        ("lateral", 1e-3, "kN"),
        ("brake", 1 / 9.80665, "kg"),
        ("vertical", 1e-3, "m"),
        ("vertical", 0.1, "cm"),
        ("steer", np.pi / 180, "rad"),
        ("roll", np.pi / 180, "rad"),
    ):
        name = INPUTS[case].split(" ")[0]
        out.append(
            Corruption(
                f"input of {case} in {unit}",
                ("refused", "input_unit"),
                f"{name}*",
                input_scaled(case, factor),
            )
        )
    return out


def input_offsets() -> list[Corruption]:
    """Inputs off their zero."""
    out: list[Corruption] = []
    out += [
        Corruption("input of vertical + 5 mm", ("input_offset",), "pad_z", input_shifted("vertical", 5.0)),
        Corruption("input of lateral + 300 N", ("input_offset",), "force_y", input_shifted("lateral", 300.0)),
        Corruption(
            "input of steer + 20 deg", ("input_offset",), "steering_wheel", input_shifted("steer", 20.0)
        ),
        Corruption("input of roll + 0.3 deg", ("input_offset",), "roll", input_shifted("roll", 0.3)),
    ]
    return out
