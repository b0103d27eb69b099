"""The design parameters of an axle whose type is data, in the order of its type file."""

from __future__ import annotations

from collections.abc import Mapping

from doe_kc.axle.model import BUSHING_AXES
from doe_kc.axle.parameter_kinds import COORDINATES, OTHER_KINDS, ParameterKind, bushing_kind, point_kind
from doe_kc.axle.structure import Structure

OWN_PART: Mapping[str, str] = {
    "scb": "rack",
    "bump_stop": "damper",
    "rebound_stop": "damper",
    "arb": "bar",
    "strut": "strut",
    "steer_arm": "steer_arm",
}
"""First name of a path -> the part of the structure that it is of; every axle has the others."""
SPRING_RATE = "spring.rate"


def structure_kinds(structure: Structure, labels: Mapping[str, str]) -> dict[str, ParameterKind]:
    """Path -> declaration. labels: of points and elements by name."""
    out: dict[str, ParameterKind] = {}
    for name in (*structure.design_points, *structure.single_points):
        for axis in COORDINATES:
            out[f"{name}.{axis}"] = point_kind(labels.get(name, name), axis)
    for bush in structure.bushings:
        for axis in BUSHING_AXES:
            out[f"{bush.name}.{axis}"] = bushing_kind(labels.get(bush.name, bush.name), axis)
    for path, kind in OTHER_KINDS.items():
        part = OWN_PART.get(path.split(".")[0])
        if path == SPRING_RATE:
            out |= {f"{spring.name}.rate": kind for spring in structure.springs}
        elif part is None or getattr(structure, part) is not None:
            out[path] = kind
    return out
