"""What parts and joints are called in messages, unknowns and probes."""

from __future__ import annotations

from doe_kc.axle.structure import Structure


def in_words(name: str) -> str:
    """Of a type file's name: `lower_arm` -> `lower arm`, `subframe` -> `sub-frame`."""
    return name.replace("_", " ").replace("subframe", "sub-frame")


def joint_words(name: str, side: str) -> str:
    """Of a connection of a side: `ball_joint`, `L` -> `ball joint L`."""
    return f"{in_words(name)} {side}".strip()


def part_words(structure: Structure, part: str) -> str:
    """Of a part by its name: `lower_arm.L` -> `lower arm L`, `subframe.L` -> `sub-frame half L`."""
    name, _, side = part.partition(".")
    half = side and structure.subframe is not None and name == structure.subframe.body
    return joint_words(f"{name} half" if half else name, side)
