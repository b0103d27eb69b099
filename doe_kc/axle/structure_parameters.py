"""The design parameters of an axle whose type is data, in the order of its type file."""

from __future__ import annotations

from collections.abc import Mapping

from doe_kc.axle.model import BUSHING_AXES
from doe_kc.axle.parameter_kinds import KINDS, ParameterKind, bushing_kind, point_kind
from doe_kc.axle.structure import Structure

WITH_RACK = ("scb.Tz",)
WITH_DAMPER = ("bump_stop.clearance", "rebound_stop.clearance")
WITH_BAR = ("arb.radius",)
ALWAYS = ("tyre.rate", "static.toe", "static.camber", "ride_height")


def structure_kinds(structure: Structure, labels: Mapping[str, str]) -> dict[str, ParameterKind]:
    """Path -> declaration. labels: of points and elements by name."""
    out: dict[str, ParameterKind] = {}
    for name in (*structure.points, *structure.single_points):
        for axis in "xyz":
            out[f"{name}.{axis}"] = point_kind(labels.get(name, name), axis)
    for bush in structure.bushings:
        for axis in BUSHING_AXES:
            out[f"{bush.name}.{axis}"] = bushing_kind(labels.get(bush.name, bush.name), axis)
    for spring in structure.springs:
        out[f"{spring.name}.rate"] = KINDS["spring.rate"]
    given = (
        (WITH_RACK, structure.rack),
        (WITH_DAMPER, structure.damper),
        (WITH_BAR, structure.bar),
    )
    names = [name for paths, present in given if present is not None for name in paths]
    return out | {name: KINDS[name] for name in (*names, *ALWAYS)}
