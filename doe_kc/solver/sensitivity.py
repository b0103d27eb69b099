"""Exact sensitivities of every equilibrium to every parameter, by the implicit function theorem.

R(x, c, u, z) = 0 at an equilibrium, so dx = -J^-1 (R_c dc + R_u du + R_z dz). The constants c depend on
the parameters; the controls u through the static state (pad heights, preload); the friction states z
through the path, z_next = g(x, c, u, z), so they are carried along with their derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import sparse

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import internal_gradient, switched_topology
from doe_kc.axle.topology import Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.solver.blocks import Block, Points, blocks, equilibrium_change
from doe_kc.solver.datum import control_gradient, gradient_between
from doe_kc.solver.kernel import kernel
from doe_kc.solver.result import BranchSolution, Solution, StaticState


@dataclass(frozen=True)
class Sensitivities:
    """Derivatives of outputs to parameters, per unit of the parameter.

    paths: (np,). static: (ny, np). branches: load case -> one (n, ny, np) per branch, rows as in the
    branch's input. Output columns as in `Solution.output_names`.
    """

    paths: tuple[str, ...]
    static: FloatArray
    branches: Mapping[str, tuple[FloatArray, ...]]


def sensitivities(
    axle: Axle,
    solution: Solution,
    paths: Sequence[str],
    directions: Mapping[str, Mapping[str, float]] | None = None,
) -> Sensitivities:
    """Derivatives of every output in every equilibrium of `solution` to the parameters `paths`.

    To a flexibility at 0, where its bound is and the topology changes, the one-sided derivative. directions:
    further ones by name, behind the paths: what each changes the axle's internal values by, per unit.
    ValueError when the solution has no static state; cases that it lacks are left out.
    """
    if solution.static is None:
        raise ValueError("a solution without a static state has no sensitivities")
    further = directions or {}
    names, moves = (*paths, *further), [*(internal_gradient(axle, p) for p in paths), *further.values()]
    exact = _Differentiator(axle, solution.static, names, moves).run(solution)
    soft = [i for i, path in enumerate(paths) if switched_topology(axle, path) != axle.topology]
    if soft:
        bent = replace(axle, topology=switched_topology(axle, paths[soft[0]]))
        lifted = in_topology(solution, axle.topology, bent.topology)
        assert lifted.static is not None
        own = tuple(paths[i] for i in soft)
        columns = _Differentiator(bent, lifted.static, own, [moves[i] for i in soft]).run(lifted)
        exact.static[:, soft] = columns.static
        for ident, branches in columns.branches.items():
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
    ) -> None:
        self._static, self._paths, self._moves = static, paths, moves
        self._kernel = kernel(axle.topology)
        self._c = self._kernel.constant_values(dict(axle.values))
        functions = blocks(axle.topology)
        self._block = {n: Block(f) for n, f in functions.items() if n != "constants"}
        self._dp = self._parameter_directions()
        p = np.array([axle.values[n] for n in self._kernel.layout.parameter_names])
        self._dc = sparse.csr_array(Block(functions["constants"])(p) @ self._dp)
        self._parts = ("R", "Y", "Z") if self._kernel.nz else ("R", "Y")
        self._outputs = self._kernel.layout.output_names

    def _parameter_directions(self) -> FloatArray:
        """(internal parameters, paths): how internal values move with each path or direction."""
        names = {n: i for i, n in enumerate(self._kernel.layout.parameter_names)}
        out = np.zeros((len(names), len(self._paths)))
        for column, move in enumerate(self._moves):
            for internal, weight in move.items():
                if internal in names:
                    out[names[internal], column] = weight
        return out

    def run(self, solution: Solution) -> Sensitivities:
        dx, dy, dz, datum = self._static_state()
        branches = {
            ident: self._case(case.load_case, case.branches, dx, dy, dz, datum)
            for ident, case in solution.cases.items()
        }
        return Sensitivities(self._paths, dy, branches)

    def _points(
        self, x: FloatArray, u: FloatArray, z: FloatArray, du: FloatArray, dz: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, ., np) dx and dy of consecutive equilibria, and dz after the last.

        x, u: (n, ...); z: (n, nz) friction states before each; du: (n, nu, np); dz: before the first.
        """
        k, block = self._kernel, self._block
        points = [(x[i], self._c, u[i], z[i]) for i in range(len(x))]
        known = {
            p: block[f"{p}_c"].times(points, self._dc) + block[f"{p}_u"].times_each(points, du)
            for p in self._parts
        }
        matrix = block["R_x"].dense(points)
        if not k.nz:
            dx = equilibrium_change(k, matrix, known["R"])
            return dx, known["Y"] + block["Y_x"].times_each(points, dx), dz
        dx, before, after = self._carried(points, matrix, known, dz)
        dy = known["Y"] + block["Y_x"].times_each(points, dx) + block["Y_z"].times_each(points, before)
        return dx, dy, after

    def _carried(
        self, points: Points, matrix: FloatArray, known: Mapping[str, FloatArray], dz: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, ., np) dx of each equilibrium and dz before it, and dz after the last.

        matrix: (n, nx, nx); known: what moves with the parameters directly; dz: before the first. One point
        after the other: the states, some hundred with rubber, never become right-hand sides.
        """
        blocks_each = (self._block[name].each(points) for name in ("R_z", "Z_x", "Z_z"))
        dx, before = np.empty_like(known["R"]), np.empty((len(points), *dz.shape))
        for i, (r_z, z_x, z_z) in enumerate(zip(*blocks_each, strict=True)):
            before[i] = dz
            dx[i] = equilibrium_change(self._kernel, matrix[i], known["R"][i] + r_z @ dz)
            dz = known["Z"][i] + z_x @ dx[i] + z_z @ dz
        return dx, before, dz

    def _point(
        self, x: FloatArray, u: FloatArray, z: FloatArray, du: FloatArray, dz: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(dx, dy, dz) of one equilibrium."""
        dx, dy, dz = self._points(x[None], u[None], z[None], du[None], dz)
        return dx[0], dy[0], dz

    def _static_state(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Derivatives of the static state and of its datum as in `DATUM`."""
        k, s, count = self._kernel, self._static, len(self._paths)
        no_z, no_du = np.zeros((k.nz, count)), np.zeros((k.nu, count))
        z0 = np.zeros(k.nz)
        dx0, _, _ = self._point(s.x0, s.u0, z0, no_du, no_z)
        raised = self._change_of("ride_height")
        du = no_du.copy()
        for control, unknown, shift in (
            ("pad_L", "pad L", raised),
            ("pad_R", "pad R", raised),
            ("preload", "preload", 0.0),
        ):
            du[k.layout.control_names.index(control)] = dx0[k.index(unknown)] + shift
        dx, dy, dz = self._point(s.x, s.u, z0, du, no_z)
        heights = [dy[self._outputs.index(f"wc_z@{side}")] for side in ("L", "R")]
        pads = [du[k.layout.control_names.index(f"pad_{side}")] for side in ("L", "R")]
        preload = du[k.layout.control_names.index("preload")]
        dimensions = [-self._change_of("WLC.y@L"), self._change_of("steering.rack_mm_per_rev")]
        return dx, dy, dz, np.array([*pads, *heights, preload, *dimensions])

    def _change_of(self, internal: str) -> FloatArray:
        """(np,) d(internal value) / d(path)."""
        return np.array([move.get(internal, 0.0) for move in self._moves])

    def _case(
        self,
        case: LoadCase,
        branches: tuple[BranchSolution, ...],
        dx0: FloatArray,
        dy0: FloatArray,
        dz0: FloatArray,
        datum: FloatArray,
    ) -> tuple[FloatArray, ...]:
        out: list[FloatArray] = []
        loop = self._kernel.topology.frictional
        dz, dy_start = dz0, dy0
        for branch in branches:
            if not (loop and out):
                dz, dy_start = dz0, dy0
            du = control_gradient(self._kernel, case, branch.input, self._static.datum) @ datum
            inside = branch.path.between
            if inside is None:
                _, dy, dz = self._points(branch.x[1:], branch.u[1:], branch.z[:-1], du[1:], dz)
            else:  # friction remembers where a motion reversed inside a step
                between = gradient_between(du, inside)
                _, dy, dz = self._points(inside.x, inside.u, inside.z, between, dz)
                dy = dy[inside.share == 1.0]
            out.append(np.concatenate([dy_start[None], dy]))
            dy_start = out[-1][-1]
        return tuple(out)
