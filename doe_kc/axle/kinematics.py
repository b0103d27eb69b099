"""The axle with joints in place of its bushings: pure kinematics, as other programs know them.

A joint is the bushing with stiffnesses so large (`RIGID`) or so small (`FREE`) that no result tells them from
ideal ones: a force of 5000 N across a rigid one moves it by 5e-6 mm. Two ball joints between the same bodies
thus make a hinge and more of them hold one body to the other, without a choice of which one to leave out.
A link between two points does not spin about its line: its bushing holds that turn alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from doe_kc.axle.freedoms import free_spins, wheel_freedoms
from doe_kc.axle.model import BUSHING_AXES, FORCE_AXES, Axle
from doe_kc.axle.small_motions import FreeTurns
from doe_kc.axle.structure import BushingConnection, KinematicJoint, Structure, of_side
from doe_kc.ground.errors import InputError

RIGID = 1e9
"""N/mm, also of the steering column."""
RIGID_TURN = 1e5
"""Nm/deg."""
FREE = 1e-3
"""Nm/deg."""
TURNS = ("Tx", "Ty", "Tz")
FREE_TURNS: Mapping[KinematicJoint, tuple[str, ...]] = {
    "ball": TURNS,
    "rigid": (),
    "hinge_x": ("Tx",),
    "hinge_y": ("Ty",),
    "hinge_z": ("Tz",),
}
"""Rotations that a joint leaves free, in the bushing's local axes."""
HELD_EFFECTS = ("ride_height_offset",)
"""Effects that are no elasticity, play or friction."""


def as_mechanism(axle: Axle, *, source: str = "kinematic") -> Axle:
    """The axle with every bushing as the joint that its type names, by default a ball joint; a rigid column.

    InputError for an axle with effects that are not of its kinematics, or whose joints bind: then the wheels
    move through bushings alone.
    """
    others = [ident for ident in axle.effects if ident not in HELD_EFFECTS]
    if others:
        raise InputError(
            f"{source}: the axle has the effect {others[0]}, but kinematics are of rigid parts; "
            f"remove [effects.{others[0]}]."
        )
    values: dict[str, float] = {}
    for name, joint, sides in _bushings(axle):
        if joint != "none":
            for side in sides:
                values |= _as_joint(name, joint, side)
    structure = axle.topology.structure
    free = {bush.name: FREE_TURNS.get(bush.joint) for bush in structure.bushings}
    holding = _holding_bushings(axle, structure, free)
    for bush in holding.values():
        sides = structure.sides(single=bush.single)
        values |= {of_side(f"{bush.name}.stiffness.Tx", side): RIGID_TURN for side in sides}
    _check_wheels(axle, structure, free, source)
    if "steering.column" in axle.values:
        values |= {"steering.column": RIGID, "scb.Tz": 1.0}
    tables = tuple(entry for entry in axle.topology.tables if of_side(f"{entry[0]}.Fx", "L") not in values)
    bushings = tuple(holding.get(bush.name, bush) for bush in structure.bushings)
    topology = replace(axle.topology, tables=tables, structure=replace(structure, bushings=bushings))
    return replace(axle.changed(values), topology=topology)


def _bushings(axle: Axle) -> Iterator[tuple[str, KinematicJoint, tuple[str, ...]]]:
    """Name, joint and sides of every bushing."""
    structure = axle.topology.structure
    for bush in structure.bushings:
        yield bush.name, bush.joint, structure.sides(single=bush.single)


def _as_joint(name: str, joint: KinematicJoint, side: str) -> dict[str, float]:
    free = FREE_TURNS[joint]
    stiffness = dict.fromkeys(FORCE_AXES, RIGID) | {a: FREE if a in free else RIGID_TURN for a in TURNS}
    out: dict[str, float] = {}
    for axis in BUSHING_AXES:
        out[of_side(f"{name}.{axis}", side)] = 1.0
        out[of_side(f"{name}.stiffness.{axis}", side)] = stiffness[axis]
    for axis in FORCE_AXES:
        out[of_side(f"{name}.cubic.{axis}", side)] = out[of_side(f"{name}.preload.{axis}", side)] = 0.0
    return out


def _holding_bushings(axle: Axle, structure: Structure, free: FreeTurns) -> dict[str, BushingConnection]:
    """Of every link one bushing, with local x along its line, by name."""
    out: dict[str, BushingConnection] = {}
    for body, along in free_spins(axle, structure, free).items():
        joined = [bush for bush in structure.bushings if body in (bush.inner, bush.outer)]
        holding = next((b for b in joined if b.joint == "ball" and b.line is None), None)
        if holding is not None:
            out[holding.name] = replace(holding, axes=_axes_along(along))
    return out


def _axes_along(along: np.ndarray) -> tuple[tuple[float, ...], ...]:
    """(3, 3) local axes with x along a unit vector, as `BushingConnection.axes`."""
    _, _, across = np.linalg.svd(along[None, :])
    axes = np.column_stack([along, across[1], np.cross(along, across[1])])
    return tuple(tuple(float(value) for value in row) for row in axes)


def _check_wheels(axle: Axle, structure: Structure, free: FreeTurns, source: str) -> None:
    """InputError unless both wheels can move up and down on their own."""
    if (count := wheel_freedoms(axle, structure, free)) < 2:
        ways = "only together" if count else "not at all"
        raise InputError(
            f"{source}: with joints in place of its bushings the wheels of a {structure.type} move up and "
            f"down {ways}: its links bind, and it has no pure kinematics. Simulate it with its bushings."
        )
