"""Reaction, displacement and influence at every interface of a solved axle, at no further march.

A rigid connection that an axle has could in truth give way, a free motion could in truth be resisted. The
probes are the places of both (see `Probe`); here is what each would do per unit, from the derivatives at the
equilibria that are known already.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.solver.datum import AT_REST, control_gradient, gradient_between
from doe_kc.solver.interface_blocks import InterfaceBlocks, Local
from doe_kc.solver.probe import Probe
from doe_kc.solver.result import BranchSolution, Solution, StaticState

WHEEL_CENTRES = ("wc_z@L", "wc_z@R")
GIVEN = (0, 1, 4)
"""Rows of the datum that the static state is under: both pads and the preload."""


@dataclass(frozen=True)
class BranchInfluences:
    """n equilibria of a branch, m probes, ny outputs; each derivative with all else held.

    seen: (n, m) what the probes show, in their response units. influence: (n, ny, m) of the outputs, per
    unit of a probe. datum: (n, ny, 5) of the outputs to the static state's datum. state: (n, ny, nz) to
    the friction states before the step; next_*: the same of the states after it, (n, nz, .). ends: (n,) which
    are the branch's own points; with friction there are others, inside its steps.
    """

    seen: FloatArray
    influence: FloatArray
    datum: FloatArray
    state: FloatArray
    next_influence: FloatArray
    next_datum: FloatArray
    next_state: FloatArray
    ends: np.ndarray


@dataclass(frozen=True)
class StaticInfluences:
    """The static state, found in two steps: pads and preload at the design height, then the offset.

    seen_design, seen: (m,) before and after the ride-height offset. datum_design, datum: (5, m) of the
    datum to the probes in either; output_design, output: (ny, m) of the static outputs; state_design,
    state: (nz, m) of the friction states.
    """

    seen_design: FloatArray
    seen: FloatArray
    datum_design: FloatArray
    datum: FloatArray
    output_design: FloatArray
    output: FloatArray
    state_design: FloatArray
    state: FloatArray


@dataclass(frozen=True)
class Influences:
    """branches: load case -> one a branch of `solution`.

    With a law h, the value of a probe at each equilibrium, outputs change by influence * h, plus
    datum @ (datum_design * h(static at design) + datum * h(static)), plus what earlier friction states hand
    on: see `law_columns`.
    """

    solution: Solution
    probes: tuple[Probe, ...]
    static: StaticInfluences
    branches: Mapping[str, tuple[BranchInfluences, ...]]


def interface_influences(axle: Axle, solution: Solution) -> Influences:
    """Influences of every probe in every equilibrium of a solution of the axle.

    ValueError when the solution has no static state; LinAlgError where an equilibrium is singular.
    """
    if solution.static is None:
        raise ValueError("a solution without a static state has no influences")
    blocks = InterfaceBlocks(axle)
    static = _static(blocks, solution.static)
    branches = {
        ident: tuple(_branch(blocks, solution.static, case.load_case, b) for b in case.branches)
        for ident, case in solution.cases.items()
    }
    return Influences(solution, blocks.probes, static, branches)


def _static(blocks: InterfaceBlocks, s: StaticState) -> StaticInfluences:
    k, m = blocks.kernel, len(blocks.probes)
    z0 = np.zeros(k.nz)
    unknowns = [k.index(name) for name in ("pad L", "pad R", "preload")]
    controls = [k.layout.control_names.index(name) for name in ("pad_L", "pad_R", "preload")]
    centres = [k.layout.output_names.index(name) for name in WHEEL_CENTRES]
    design = blocks.at(s.x0, s.u0, z0, np.zeros((k.nu, AT_REST)))
    du = np.zeros((k.nu, AT_REST))
    du[controls, GIVEN] = 1.0
    raised = blocks.at(s.x, s.u, z0, du)
    datum_design, datum = np.zeros((AT_REST, m)), np.zeros((AT_REST, m))
    datum_design[list(GIVEN)] = design.dx[unknowns, :m]
    output_design = raised.dy[:, m : m + AT_REST] @ datum_design
    datum_design[2:4], datum[2:4] = output_design[centres], raised.dy[centres, :m]
    return StaticInfluences(
        seen_design=design.seen,
        seen=raised.seen,
        datum_design=datum_design,
        datum=datum,
        output_design=output_design,
        output=raised.dy[:, :m],
        state_design=raised.dz[:, m : m + AT_REST] @ datum_design,
        state=raised.dz[:, :m],
    )


def _branch(
    blocks: InterfaceBlocks, static: StaticState, case: LoadCase, branch: BranchSolution
) -> BranchInfluences:
    """Of all rows; the first is where the branch starts, under its own controls."""
    du = control_gradient(blocks.kernel, case, branch.input, static.datum)[..., :AT_REST]
    x, u, before = branch.x, branch.u, np.vstack([branch.z[:1], branch.z[:-1]])
    ends = np.ones(len(x), dtype=bool)
    if (inside := branch.path.between) is not None:
        x, u, before = (np.vstack([a[:1], b]) for a, b in ((x, inside.x), (u, inside.u), (before, inside.z)))
        du = np.concatenate([du[:1], gradient_between(du, inside)])
        ends = np.concatenate([[True], inside.share == 1.0])
    steps = [blocks.at(*each) for each in zip(x, u, before, du, strict=True)]
    return _stacked(steps, len(blocks.probes), ends)


def _stacked(steps: list[Local], m: int, ends: np.ndarray) -> BranchInfluences:
    dy, dz = np.array([s.dy for s in steps]), np.array([s.dz for s in steps])
    probes, datum, state = slice(m), slice(m, m + AT_REST), slice(m + AT_REST, None)
    return BranchInfluences(
        np.array([s.seen for s in steps]),
        dy[:, :, probes],
        dy[:, :, datum],
        dy[:, :, state],
        dz[:, :, probes],
        dz[:, :, datum],
        dz[:, :, state],
        ends,
    )
