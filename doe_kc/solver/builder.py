"""Collects bodies, joints, wrenches and outputs of the axle; `equations.finish` closes them.

Equilibrium is Newton's and Euler's: every element pushes and turns bodies; a joint projects what its
body receives on the motion it leaves free, and hands the wrench on to the body it hangs on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import casadi as ca

from doe_kc.axle.topology import Topology
from doe_kc.solver import rotation
from doe_kc.solver.probe import Probe

Response = Callable[[], ca.SX]

FORCE_SCALE = 1.0
"""N: the unit of the convergence norm."""
MOMENT_SCALE = 100.0
"""N mm that weigh as much as 1 N in the convergence norm: a lever of 100 mm."""
LENGTH_SCALE = 1e-3
"""mm of constraint violation that weigh as much as 1 N: 1000 N/mm."""
LOAD_CASE = "load_case"
"""Control that is 1 in a load case and 0 at rest, where friction has no force and no memory."""
HOLD_WHEEL = "hold_wheel_centre"
"""Control that is 1 where the travel of the wheel centres is prescribed, whatever the pads must do."""


@dataclass(frozen=True)
class Body:
    """Rigid body: at the design position its axes are the chassis axes.

    design: its origin in the chassis frame at design; origin: now; gibbs, axes: orientation.
    """

    name: str
    design: ca.SX
    origin: ca.SX
    gibbs: ca.SX
    axes: ca.SX

    def point(self, design_position: ca.SX) -> ca.SX:
        """Where the material point that lay at `design_position` is now."""
        return self.origin + self.axes @ (design_position - self.design)


def body(name: str, design: ca.SX, origin: ca.SX, gibbs: ca.SX) -> Body:
    """Body at `origin` turned by `gibbs`."""
    return Body(name, design, origin, gibbs, rotation.matrix(gibbs))


@dataclass(frozen=True)
class Freedom:
    """One motion that a joint leaves free; its row is axis . (force or moment) - resistance = 0.

    compliance: factor on the first term, so that resistance is what the joint would offer at compliance 1
    and a joint without any does not move. It is a number of the axle's, not of the equilibrium.
    """

    name: str
    symbol: ca.SX
    axis: ca.SX
    rotates: bool
    compliance: ca.SX | float = 1.0


@dataclass(frozen=True)
class Joint:
    """How a body hangs on another. Moments are about the body's origin.

    parent None: free in space. carries_moment False: a ball joint at the body's origin.
    """

    label: str
    child: Body
    parent: Body | None
    freedoms: tuple[Freedom, ...]
    carries_moment: bool = True


@dataclass(frozen=True)
class Unknown:
    """One entry of the state vector; `scale`: residual of its row that weighs as much as 1 N."""

    name: str
    joint: str
    scale: float


@dataclass
class Builder:
    """Mutable only while an axle's equations are assembled."""

    topology: Topology
    bodies: dict[str, Body] = field(default_factory=dict)
    points: dict[str, ca.SX] = field(default_factory=dict)
    joints: list[Joint] = field(default_factory=list)
    resistances: dict[str, ca.SX] = field(default_factory=dict)
    wrenches: dict[str, tuple[ca.SX, ca.SX]] = field(default_factory=dict)
    multipliers: list[tuple[Unknown, ca.SX, ca.SX]] = field(default_factory=list)
    tail: list[tuple[Unknown, ca.SX]] = field(default_factory=list)
    tail_equations: dict[str, ca.SX] = field(default_factory=dict)
    parameters: dict[str, ca.SX] = field(default_factory=dict)
    constants: list[tuple[ca.SX, ca.SX]] = field(default_factory=list)
    controls: dict[str, ca.SX] = field(default_factory=dict)
    states: list[tuple[ca.SX, ca.SX]] = field(default_factory=list)
    slips: list[str] = field(default_factory=list)
    outputs: dict[str, ca.SX] = field(default_factory=dict)
    probes: list[tuple[Probe, ca.SX, Response]] = field(default_factory=list)

    def join(
        self,
        label: str,
        child: Body,
        parent: Body | None,
        freedoms: list[Freedom],
        *,
        carries_moment: bool = True,
    ) -> Body:
        """Register a body and the joint it hangs by; returns the body."""
        self.joints.append(Joint(label, child, parent, tuple(freedoms), carries_moment))
        return child

    def push(self, on: Body, force: ca.SX, at: ca.SX) -> None:
        """Force (3,) in N on the material point of `on` that is now at `at`."""
        self.wrench(on, force, ca.cross(at - on.origin, force))

    def turn(self, on: Body, moment: ca.SX) -> None:
        """Moment (3,) in N mm on `on`."""
        self.wrench(on, ca.SX.zeros(3), moment)

    def wrench(self, on: Body, force: ca.SX, moment: ca.SX) -> None:
        """Force and moment about the body's origin, chassis axes."""
        before = self.wrenches.get(on.name, (ca.SX.zeros(3), ca.SX.zeros(3)))
        self.wrenches[on.name] = (before[0] + force, before[1] + moment)

    def resist(self, freedom: str, force: ca.SX) -> None:
        """Internal force (N) or moment (N mm) of a joint against one of its free motions."""
        self.resistances[freedom] = self.resistances.get(freedom, ca.SX(0)) + force

    def parameter(self, name: str) -> ca.SX:
        """Scalar symbol of an axle value by its internal name, e.g. `LLF.x@L`."""
        if name not in self.parameters:
            self.parameters[name] = ca.SX.sym(name)
        return self.parameters[name]

    def constant(self, expression: ca.SX) -> ca.SX:
        """Fresh symbols for something that depends on parameters alone, computed once per design."""
        symbols = ca.SX.sym("c", *expression.shape)
        self.constants.append((ca.vec(symbols), ca.vec(expression)))
        return symbols

    def control(self, name: str) -> ca.SX:
        """Scalar symbol of a load-case control."""
        if name not in self.controls:
            self.controls[name] = ca.SX.sym(name)
        return self.controls[name]

    def rigid(self, name: str, joint: str, violation: ca.SX, compliance: ca.SX | float = 0.0) -> ca.SX:
        """Constraint violation(q) = compliance * force in mm, ideal without compliance (mm/N).

        Returns the symbol of its force in N.
        """
        force = ca.SX.sym(name)
        self.multipliers.append((Unknown(name, joint, LENGTH_SCALE), force, violation - compliance * force))
        return force

    def state(self, previous: ca.SX, following: ca.SX, *, freedom: str | None = None) -> None:
        """Path-dependent state (mm, rad): symbols of its previous value, expression of the next.

        freedom: the free motion that it resists, in which steps are halved where it reverses; None for one
        so soft beside its spring that a reversal inside a step is not seen.
        """
        if freedom is not None:
            self.slips.append(freedom)
        self.states.append((ca.vec(previous), ca.vec(following)))

    def tail_unknown(self, name: str, joint: str, scale: float) -> ca.SX:
        """Unknown that load cases mostly prescribe; its equation is given by `close_tail`."""
        symbol = ca.SX.sym(name)
        self.tail.append((Unknown(name, joint, scale), symbol))
        return symbol

    def close_tail(self, name: str, equation: ca.SX) -> None:
        """Equation = 0 of a tail unknown."""
        self.tail_equations[name] = equation

    def output(self, name: str, expression: ca.SX) -> None:
        """Named scalar result of an equilibrium."""
        self.outputs[name] = expression

    def probe(self, probe: Probe, response: Response) -> ca.SX:
        """Symbol of a probe, in its unit; exactly zero where the topology has no probes.

        response: what the finished axle shows there, in the probe's response unit.
        """
        if not self.topology.probes:
            return ca.SX(0)
        symbol = ca.SX.sym(probe.name)
        self.probes.append((probe, symbol, response))
        return symbol
