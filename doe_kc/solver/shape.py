"""Where the axle's hardpoints are at an equilibrium: its deformed shape."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from doe_kc.axle.geometry import point
from doe_kc.axle.model import Axle
from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.curves import SIDES
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.assembly import collected
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements._base import mirror
from doe_kc.solver.equations import finish
from doe_kc.solver.kernel import Buffered, kernel
from doe_kc.solver.result import BranchSolution


@dataclass(frozen=True)
class Shape:
    """points: `<hardpoint>@<side>` -> (3,) mm, chassis frame, right side at y > 0. spin, contact: side ->
    (3,) outward axis of the wheel, and its contact point with the pad."""

    points: Mapping[str, FloatArray]
    spin: Mapping[str, FloatArray]
    contact: Mapping[str, FloatArray]


def shape_at(axle: Axle, branch: BranchSolution, row: int) -> Shape:
    """The axle at one equilibrium of a branch that was solved for it."""
    names = axle.topology.structure.design_points
    c = kernel(axle.topology).constant_values(dict(axle.values))
    design = np.concatenate([_design(axle, name, side) for side in SIDES for name in names])
    state = (branch.x[row], c, branch.u[row], branch.z[row])
    values = Buffered(_function(axle.topology))(*state, design)
    places = iter(values.copy().reshape(-1, 3))
    points = {f"{name}@{side}": next(places) for side in SIDES for name in names}
    return Shape(points, {s: next(places) for s in SIDES}, {s: next(places) for s in SIDES})


def _design(axle: Axle, name: str, side: str) -> FloatArray:
    """(3,) of the vehicle, mm."""
    return np.asarray(point(axle, name, side) * np.array([1.0, mirror(side), 1.0]))


@lru_cache(maxsize=TOPOLOGY_CACHE)
def _function(topology: Topology) -> ca.Function:
    """Places, spin axes and contact points of (x, c, u, z, design places).

    The design places are an input of its own: a topology without a sprung steer arm does not know SAH.
    """
    names, b = topology.structure.design_points, collected(topology)
    design = {f"{name}@{side}": ca.SX.sym(f"{name}@{side}", 3) for side in SIDES for name in names}
    places = [_place(b, name, side, design[f"{name}@{side}"]) for side in SIDES for name in names]
    places += [b.points[f"{what}.{side}"] for what in ("spin", "contact") for side in SIDES]
    eq = finish(b)
    state = [eq.x, eq.c, eq.u, eq.z, ca.vertcat(*design.values())]
    return ca.Function("shape", state, [ca.densify(ca.vertcat(*places))])


def _place(b: Builder, name: str, side: str, design: ca.SX) -> ca.SX:
    structure = b.topology.structure
    part = f"wheel.{side}" if name == "WLC" else structure.part_on_side(structure.body_at(name), side)
    return b.bodies[part].point(design)
