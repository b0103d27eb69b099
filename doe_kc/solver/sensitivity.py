"""Exact sensitivities of every equilibrium to every parameter, by the implicit function theorem.

R(x, c, u, z) = 0 at an equilibrium, so dx = -J^-1 (R_c dc + R_u du + R_z dz). The constants c depend on
the parameters; the controls u through the static state (pad heights, preload); the friction states z
through the path, z_next = g(x, c, u, z), so they are carried along with their derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import sparse

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import internal_gradient, switched_topology
from doe_kc.axle.topology import Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.solver.blocks import Block
from doe_kc.solver.datum import control_gradient, gradient_between
from doe_kc.solver.derivatives import (
    CompiledDerivatives,
    StateDerivatives,
    StateSequence,
    constants_gradient,
    derivatives_of,
)
from doe_kc.solver.kernel import kernel
from doe_kc.solver.result import BranchSolution, CaseSolution, Solution, StaticState

TAIL = ("pad_L", "pad_R", "preload")
"""Controls that the static state decides."""


@dataclass(frozen=True)
class Sensitivities:
    """Derivatives of outputs to parameters, per unit of the parameter.

    paths: (np,). static: (ny, np), outputs as in `Solution.output_names`. branches: load case -> one
    (n, columns, np) per branch, rows as in the branch's input. columns: names of the outputs there.
    """

    paths: tuple[str, ...]
    static: FloatArray
    branches: Mapping[str, tuple[FloatArray, ...]]
    columns: tuple[str, ...]

    def along(self, ident: str, outputs: Sequence[str]) -> list[FloatArray]:
        """(n, outputs, np) of some outputs on each branch of a load case."""
        if tuple(outputs) == self.columns:
            return list(self.branches[ident])
        places = [self.columns.index(name) for name in outputs]
        return [rows[:, places] for rows in self.branches[ident]]


def sensitivities(
    axle: Axle,
    solution: Solution,
    paths: Sequence[str],
    directions: Mapping[str, Mapping[str, float]] | None = None,
    outputs: Sequence[str] | None = None,
    *,
    input_gain: str = "",
    pool: Executor | None = None,
) -> Sensitivities:
    """Derivatives of every output in every equilibrium of `solution` to the parameters `paths`.

    To a flexibility at 0, where its bound is and the topology changes, the one-sided derivative. directions:
    further ones by name, behind the paths: what each changes the axle's internal values by, per unit.
    outputs: those that are kept of the branches, default all. input_gain: name of a last column, to the gain
    of each branch's own load case, nothing at rest; default none. pool: see `suite.solve`.
    ValueError when the solution has no static state; cases that it lacks are left out.
    """
    if solution.static is None:
        raise ValueError("a solution without a static state has no sensitivities")
    further = directions or {}
    names, moves = (*paths, *further), [*(internal_gradient(axle, p) for p in paths), *further.values()]
    if input_gain:
        names, moves = (*names, input_gain), [*moves, {}]
    columns = solution.output_names if outputs is None else tuple(outputs)
    exact = _Differentiator(axle, solution.static, names, moves, columns, input_gain).run(solution, pool)
    soft = [i for i, path in enumerate(paths) if switched_topology(axle, path) != axle.topology]
    if soft:
        bent = replace(axle, topology=switched_topology(axle, paths[soft[0]]))
        lifted = in_topology(solution, axle.topology, bent.topology)
        assert lifted.static is not None
        own = tuple(paths[i] for i in soft)
        moved = [moves[i] for i in soft]
        bending = _Differentiator(bent, lifted.static, own, moved, columns).run(lifted, pool)
        exact.static[:, soft] = bending.static
        for ident, branches in bending.branches.items():
            for rows, other in zip(exact.branches[ident], branches, strict=True):
                rows[:, :, soft] = other
    return exact


def in_topology(solution: Solution, old: Topology, new: Topology) -> Solution:
    """The same equilibria as states of a topology that has further unknowns, zero there."""
    a, b = kernel(old), kernel(new)
    unknowns = np.array([b.index(u.name) for u in a.layout.unknowns])
    controls = np.array([b.layout.control_names.index(name) for name in a.layout.control_names])

    def placed(rows: FloatArray, places: np.ndarray, width: int) -> FloatArray:
        out = np.zeros((*rows.shape[:-1], width))
        out[..., places] = rows
        return out

    def moved(part: Any, *names: str) -> Any:
        changes = {n: placed(getattr(part, n), unknowns, b.nx) for n in names if n.startswith("x")}
        changes |= {n: placed(getattr(part, n), controls, b.nu) for n in names if n.startswith("u")}
        return replace(part, **changes)

    def carried(branch: BranchSolution) -> BranchSolution:
        between = None if branch.path.between is None else moved(branch.path.between, "x", "u")
        lifted: BranchSolution = moved(branch, "x", "u")
        return replace(lifted, path=replace(branch.path, between=between))

    cases = {
        ident: replace(case, branches=tuple(carried(branch) for branch in case.branches))
        for ident, case in solution.cases.items()
    }
    static = None if solution.static is None else moved(solution.static, "x0", "u0", "x", "u")
    return replace(solution, static=static, cases=cases)


class _Differentiator:
    def __init__(
        self,
        axle: Axle,
        static: StaticState,
        paths: tuple[str, ...],
        moves: Sequence[Mapping[str, float]],
        columns: tuple[str, ...],
        input_gain: str = "",
    ) -> None:
        self._static, self._paths, self._moves = static, paths, moves
        self._gain = np.array([float(p == input_gain) for p in paths])
        self._kernel = kernel(axle.topology)
        c = self._kernel.constant_values(dict(axle.values))
        p = np.array([axle.values[n] for n in self._kernel.layout.parameter_names])
        moved = Block(constants_gradient(axle.topology))(p) @ self._parameter_directions()
        self._derivatives = derivatives_of(axle.topology, c, sparse.csr_array(moved))
        self._outputs, self._columns = self._kernel.layout.output_names, columns
        self._kept = np.array([self._outputs.index(name) for name in columns])

    def _parameter_directions(self) -> FloatArray:
        """(internal parameters, paths): how internal values move with each path or direction."""
        names = {n: i for i, n in enumerate(self._kernel.layout.parameter_names)}
        out = np.zeros((len(names), len(self._paths)))
        for column, move in enumerate(self._moves):
            for internal, weight in move.items():
                if internal in names:
                    out[names[internal], column] = weight
        return out

    def run(self, solution: Solution, pool: Executor | None) -> Sensitivities:
        dy, dz, datum = self._static_state()

        def along(case: CaseSolution) -> tuple[FloatArray, ...]:
            return self._case(case.load_case, case.branches, dy, dz, datum)

        compiled = isinstance(self._derivatives, CompiledDerivatives)
        side_by_side = map if pool is None or not compiled else pool.map
        branches = dict(zip(solution.cases, side_by_side(along, solution.cases.values()), strict=True))
        return Sensitivities(self._paths, dy, branches, self._columns)

    def _at_rest(
        self, x: FloatArray, u: FloatArray, gradient: FloatArray, directions: FloatArray
    ) -> StateDerivatives:
        """Of one equilibrium that no friction has acted on; gradient: (nu, d) of its controls."""
        k = self._kernel
        states = StateSequence(x[None], u[None], np.zeros((1, k.nz)), gradient[None], np.ones(1, dtype=bool))
        none = np.zeros((k.ny, len(self._paths))), np.zeros((k.nz, len(self._paths)))
        return self._derivatives.along(states, directions, np.arange(k.ny), *none, unknowns=True)

    def _static_state(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Derivatives of the outputs and friction states at rest, and of its datum as in `DATUM`."""
        k, s = self._kernel, self._static
        gradient = np.zeros((k.nu, len(TAIL)))
        design = self._at_rest(s.x0, s.u0, gradient, np.zeros((len(TAIL), len(self._paths)))).dx[0]
        raised = self._change_of("ride_height")
        pads = [design[k.index(name)] + raised for name in ("pad L", "pad R")]
        directions = np.array([*pads, design[k.index("preload")]])
        gradient[[k.layout.control_names.index(control) for control in TAIL], np.arange(len(TAIL))] = 1.0
        at_rest = self._at_rest(s.x, s.u, gradient, directions)
        dy = at_rest.dy[-1]
        heights = [dy[self._outputs.index(f"wc_z@{side}")] for side in ("L", "R")]
        dimensions = [-self._change_of("WLC.y@L"), self._change_of("steering.rack_mm_per_rev")]
        return dy, at_rest.dz, np.array([*pads, *heights, directions[-1], *dimensions, self._gain])

    def _change_of(self, internal: str) -> FloatArray:
        """(np,) d(internal value) / d(path)."""
        return np.array([move.get(internal, 0.0) for move in self._moves])

    def _case(
        self,
        case: LoadCase,
        branches: tuple[BranchSolution, ...],
        dy0: FloatArray,
        dz0: FloatArray,
        datum: FloatArray,
    ) -> tuple[FloatArray, ...]:
        """(n, columns, np) of each branch; a loop with friction hands its states from branch to branch."""
        out: list[FloatArray] = []
        loop = self._kernel.topology.frictional
        dy0 = dy0[self._kept]
        dy, dz = dy0, dz0
        for branch in branches:
            if not loop:
                dy, dz = dy0, dz0
            gradient = control_gradient(self._kernel, case, branch.input, self._static.datum)
            after = self._derivatives.along(_states(branch, gradient), datum, self._kept, dy, dz)
            out.append(after.dy)
            dy, dz = after.dy[-1], after.dz
        return tuple(out)


def _states(branch: BranchSolution, gradient: FloatArray) -> StateSequence:
    """Equilibria of a branch after its first; gradient: (n, nu, d) of the controls at its inputs."""
    inside = branch.path.between
    if inside is None:
        wanted = np.ones(len(branch.x) - 1, dtype=bool)
        return StateSequence(branch.x[1:], branch.u[1:], branch.z[:-1], gradient[1:], wanted)
    # friction remembers where a motion reversed inside a step
    between = gradient_between(gradient, inside)
    return StateSequence(inside.x, inside.u, inside.z, between, inside.share == 1.0)
