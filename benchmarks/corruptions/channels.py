"""Channels with a wrong sign, side, column or unit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from corruptions.edit import ALL, Corruption, Edit, Frames, column, of_case


def scaled(quantity: str, sides: str, factor: float, case: str | None = None) -> Edit:
    def edit(frames: Frames) -> None:
        for frame in of_case(frames, case):
            for side in sides:
                frame[column(quantity, side)] *= factor

    return edit


def exchanged(one: str, other: str, case: str | None = None) -> Edit:
    def edit(frames: Frames) -> None:
        for frame in of_case(frames, case):
            frame[[one, other]] = frame[[other, one]].to_numpy()

    return edit


def sides_exchanged(case: str | None, quantities: Sequence[str]) -> Edit:
    def edit(frames: Frames) -> None:
        for quantity in quantities:
            exchanged(column(quantity, "L"), column(quantity, "R"), case)(frames)

    return edit


def signs() -> list[Corruption]:
    """Of a quantity, everywhere, of one wheel or in one load case."""
    out: list[Corruption] = []
    out += [Corruption(f"sign of {q}, all cases", ("sign",), f"{q}*", scaled(q, "LR", -1.0)) for q in ALL]
    for q, side in (
        ("toe", "R"),
        ("camber", "L"),
        ("caster", "R"),
        ("wc_x", "L"),
        ("wc_y", "R"),
        ("wc_z", "L"),
    ):
        out.append(Corruption(f"sign of {q}_{side}", ("sign",), f"{q}*", scaled(q, side, -1.0)))
    for q, case in (
        ("camber", "lateral"),
        ("wc_y", "lateral_opposite"),
        ("wc_x", "brake"),
        ("wc_z", "vertical"),
        ("caster", "drive"),
        ("toe", "steer"),
        ("toe", "vertical"),
        ("camber", "roll"),
        ("tyre_load", "roll"),
    ):
        out.append(
            Corruption(
                f"sign of {q} in {case}", ("sign", "sides"), f"[{q[0]}*]*", scaled(q, "LR", -1.0, case)
            )
        )
    return out


def sides() -> list[Corruption]:
    """Left and right exchanged."""
    out: list[Corruption] = []
    for case in (None, "roll", "lateral", "steer"):
        words = "all cases" if case is None else case
        out.append(
            Corruption(
                f"left and right exchanged, {words}", ("sides", "input_sign"), "*", sides_exchanged(case, ALL)
            )
        )
    out += [
        Corruption(f"left and right {q} exchanged", ("sides",), f"{q}*", sides_exchanged(None, (q,)))
        for q in ("toe", "camber", "wc_y", "wc_z", "tyre_load")
    ]
    return out


def columns() -> list[Corruption]:
    """Two quantities exchanged."""
    out: list[Corruption] = []
    for a, b, s in (
        ("toe", "camber", "LR"),
        ("wc_x", "wc_y", "LR"),
        ("camber", "caster", "L"),
        ("wc_y", "wc_z", "R"),
        ("toe", "caster", "LR"),
    ):

        def edit(frames: Frames, a: str = a, b: str = b, s: str = s) -> None:
            for side in s:
                exchanged(column(a, side), column(b, side))(frames)

        out.append(Corruption(f"columns {a} and {b} exchanged, {s}", ("columns",), f"*{b}*", edit))
    return out


def units() -> list[Corruption]:
    """Channels in other units than their headings say."""
    out: list[Corruption] = []
    for q, factor, unit in (
        ("toe", np.pi / 180, "rad"),
        ("camber", np.pi / 180, "rad"),
        ("caster", 60.0, "minutes"),
        ("toe", 60.0, "minutes"),
        ("wc_x", 1e-3, "m"),
        ("wc_y", 1 / 25.4, "in"),
        ("wc_z", 0.1, "cm"),
        ("wc_z", 1e-3, "m"),
        ("tyre_load", 1e-3, "kN"),
        ("tyre_load", 1 / 9.80665, "kg"),
        ("tyre_load", 1 / 4.4482216, "lbf"),
        ("toe", 2.0, "total toe"),
    ):
        out.append(Corruption(f"{q} in {unit}", ("unit",), f"{q}*", scaled(q, "LR", factor)))
    out.append(Corruption("toe_L in rad", ("unit",), "toe_L", scaled("toe", "L", np.pi / 180)))
    return out


def copies() -> list[Corruption]:
    """One channel given for another."""
    out: list[Corruption] = []
    out += [
        Corruption(
            "toe_R given as a copy of toe_L",
            ("copy",),
            "toe_R",
            lambda f: [x.__setitem__("toe_R [deg]", x["toe_L [deg]"]) for x in f.values()] and None,
        ),
    ]
    return out
