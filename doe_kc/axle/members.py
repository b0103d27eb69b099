"""The lines by which an axle is drawn: which hardpoints its parts join."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from doe_kc.axle.geometry import point
from doe_kc.axle.model import Axle
from doe_kc.axle.structure import Structure

Member = tuple[str, str]


def members_of(axle: Axle) -> Mapping[str, tuple[Member, ...]]:
    """Lines between hardpoints of one side by the part they belong to."""
    if axle.lines:
        return axle.lines
    structure = axle.topology.structure
    out = {
        _part_words(name, structure): _shortest_lines(axle, _sided(structure, structure.points_on(name)))
        for name in (*structure.bodies, *structure.single_bodies)
    }
    damper = () if structure.damper is None else (structure.damper,)
    for line in (*structure.rods, *structure.springs, *damper):
        if not line.single:
            out[line.name.replace("_", " ")] = ((line.at_a, line.at_b),)
    return {name: lines for name, lines in out.items() if lines}


def shared_parts(axle: Axle) -> frozenset[str]:
    """Names, among those of `members_of`, of the parts that are one for both sides."""
    structure = axle.topology.structure
    return frozenset(_part_words(name, structure) for name in structure.single_bodies)


def _part_words(body: str, structure: Structure) -> str:
    subframe = structure.subframe
    return "sub-frame" if subframe is not None and body == subframe.body else body.replace("_", " ")


def _sided(structure: Structure, names: Sequence[str]) -> list[str]:
    return [name for name in names if name in structure.points]


def drawn_points(axle: Axle) -> tuple[str, ...]:
    """Hardpoints of a side; not those that are no design parameters."""
    return axle.topology.structure.design_points


def _shortest_lines(axle: Axle, names: Sequence[str]) -> tuple[Member, ...]:
    """The shortest tree that joins the points (Prim's algorithm)."""
    places = {name: point(axle, name) for name in names}
    joined, lines = list(names[:1]), list[Member]()
    while len(joined) < len(names):
        gaps = [
            (float(np.linalg.norm(places[a] - places[b])), a, b)
            for a in joined
            for b in names
            if b not in joined
        ]
        _, a, b = min(gaps)
        lines.append((a, b))
        joined.append(b)
    return tuple(lines)
