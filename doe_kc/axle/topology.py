"""Which bodies, joints and laws the axle has: what decides the equations, not their numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from doe_kc.axle.structure import Structure

FrictionLaw = Literal["none", "dahl", "iwan", "duhem", "lognormal", "backbone"]
NEARLY_DAHL = 1e-6
"""Exponent of Duhem's law less 1 that stands for Dahl's, where the closed form is 0 / 0."""

TOPOLOGY_CACHE = 64
"""Topologies whose kernels are kept: a search for effects tries dozens."""
EQUATIONS_CACHE = 4
"""Topologies whose equations are kept as expressions, some ten MB each; a compiled kernel does without."""


@dataclass(frozen=True)
class Topology:
    """One set of equations and one compiled kernel per topology; an absent effect costs nothing.

    bump_points, rebound_points: number of points of the stop curves.
    hub_stiffens, strut_stiffens: whether hub and strut clamp follow the law that is stiffer under load.
    tables: (bushing, axis, points) of every tabulated bushing axis, e.g. ("llr", "Fx", 7).
    rubber: bushings whose translational axes have friction beside their elastic law.
    probes: whether zero-valued dislocations and force pairs are in, for derivatives to them alone.
    structure: bodies and connections of the axle's type.
    elastic_balls, play_balls: ball joints that are springs, or have free play, by name of either side:
        `tlo@L`.
    """

    structure: Structure
    hub: bool = False
    hub_stiffens: bool = False
    strut_bending: bool = False
    strut_stiffens: bool = False
    steer_arm: bool = False
    rack_mount: bool = False
    power_assist: bool = False
    flexible_subframe: bool = False
    tyre_horizontal: bool = False
    free_play_left: bool = False
    free_play_right: bool = False
    steering_friction: FrictionLaw = "none"
    strut_friction: FrictionLaw = "none"
    rubber: tuple[str, ...] = ()
    bump_points: int = 7
    rebound_points: int = 5
    tables: tuple[tuple[str, str, int], ...] = ()
    probes: bool = False
    elastic_balls: tuple[str, ...] = ()
    play_balls: tuple[str, ...] = ()

    @property
    def frictional(self) -> bool:
        """True when the path matters, so that load cases run as loops."""
        return self.steering_friction != "none" or self.strut_friction != "none" or bool(self.rubber)
