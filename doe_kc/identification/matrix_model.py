"""The influence matrix of an axle by exact sensitivities, and its difference from a measured one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from doe_kc.axle.geometry import check_geometry
from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import ParameterKind
from doe_kc.axle.parameters import parameter_value, settable_paths
from doe_kc.axle.structure_parameters import structure_kinds
from doe_kc.characteristics import Characteristic
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.identification.measured_matrix import MeasuredMatrix
from doe_kc.identification.unknowns import Unknowns
from doe_kc.load_cases import LOAD_CASES, LoadCase
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.solver.curve_gradient import characteristic_gradients
from doe_kc.solver.result import NotConverged
from doe_kc.solver.suite import SEEDS, solve

WHEEL_HEIGHT = "WLC.z"
DIFFERENCE_STEP = 1e-3
"""Prior standard deviations; the exact matrix is smooth to 1e-8, so that a column of the Jacobian is good to
1e-5 of its size."""


@dataclass(frozen=True)
class MatrixModel:
    """noise: standard deviation of a cell, a share of the length of its column.

    any_sign: whether the overall sign of a column is free. wheel_radius_held: see `influence_matrix`.
    """

    unknowns: Unknowns
    measured: MeasuredMatrix
    noise: float
    any_sign: bool
    wheel_radius_held: bool = False

    @cached_property
    def _axle(self) -> Axle:
        return in_windows(self.unknowns.axle)

    @cached_property
    def _cells(self) -> np.ndarray:
        """(p, m) bool: cells that are fitted."""
        return np.asarray(self.measured.counted & self.measured.fitted_columns)

    @cached_property
    def _direction(self) -> FloatArray:
        """(p, m) measured columns of length 1 over the cells that are fitted, 0 elsewhere."""
        return _unit(np.where(self._cells, self.measured.values, 0.0))

    def matrix(self, z: FloatArray) -> FloatArray:
        """(p, m) change of each characteristic for a positive step of each parameter, of the axle at z (d,).

        NotConverged where it has no equilibrium, InputError where it is no axle.
        """
        axle = replace(self._axle, values=self.unknowns.axle_at(z).values)
        paths = [p.path for p in self.measured.parameters]
        return influence_matrix(
            axle, paths, self.measured.characteristics, wheel_radius_held=self.wheel_radius_held
        )

    def residual(self, z: FloatArray, sign: FloatArray | None = None) -> tuple[FloatArray, FloatArray] | None:
        """(n,) own less measured direction in `noise`, and (m,) the sign of each column; None without an
        equilibrium.

        sign: (m,) to be used instead of the better one.
        """
        try:
            own = self.matrix(z)
        except (NotConverged, InputError, np.linalg.LinAlgError):
            return None
        if not np.isfinite(own[self._cells]).all():
            return None
        own = _unit(np.where(self._cells, own, 0.0))
        chosen = self._sign(own) if sign is None else sign
        return ((own * chosen - self._direction) / self.noise)[self._cells], chosen

    def _sign(self, own: FloatArray) -> FloatArray:
        along = np.einsum("ij,ij->j", own, self._direction)
        return np.where((along < 0) & self.any_sign, -1.0, 1.0)

    def is_axle(self, z: FloatArray) -> bool:
        """Whether a car can have the hardpoints at z (d,)."""
        try:
            check_geometry(self.unknowns.axle_at(z), "identify")
        except InputError:
            return False
        return True

    def columns(
        self, z: FloatArray, residual: FloatArray, sign: FloatArray, which: Sequence[int]
    ) -> list[FloatArray]:
        """(n,) derivatives of the residual to some of the unknowns, by a one-sided difference."""
        return [self._column(z, residual, sign, i) for i in which]

    def _column(self, z: FloatArray, residual: FloatArray, sign: FloatArray, i: int) -> FloatArray:
        for step in (DIFFERENCE_STEP, -DIFFERENCE_STEP):
            moved = z.copy()
            moved[i] += step
            beside = self.residual(moved, sign)
            if beside is not None:
                return np.asarray((beside[0] - residual) / step)
        return np.zeros_like(residual)


def influence_matrix(
    axle: Axle,
    paths: Sequence[str],
    characteristics: Sequence[Characteristic],
    *,
    wheel_radius_held: bool = False,
) -> FloatArray:
    """(p, m) exact derivatives times the steps of the parameters (1 mm, a tenth of a stiffness), unit of the
    characteristic. NotConverged where the axle has no equilibrium.

    wheel_radius_held: WLC.z moves the contact point along with the wheel centre, as in models whose tyre has
    a radius of its own; else the ground stays, and the radius grows. A shift of axle and ground together
    changes nothing, so that this row is that of all other points moved down.
    """
    lowered = _points_beside_the_wheel(axle) if wheel_radius_held and WHEEL_HEIGHT in paths else []
    cases = list(dict.fromkeys(c.load_case for c in characteristics if c.load_case in axle.load_cases))
    gradients = characteristic_gradients(axle, solve(axle, cases), [*paths, *lowered], characteristics).T
    kinds = structure_kinds(axle.topology.structure, axle.labels)
    matrix = gradients[: len(paths)] * np.array([[_step(axle, path, kinds[path])] for path in paths])
    if lowered:
        matrix[list(paths).index(WHEEL_HEIGHT)] = -gradients[len(paths) :].sum(axis=0)
    return np.asarray(matrix)


def _points_beside_the_wheel(axle: Axle) -> list[str]:
    """Heights that together are all points but the wheel centre; those that follow another move with it."""
    still = {*axle.follow, WHEEL_HEIGHT.partition(".")[0]}
    return [p for p in settable_paths(axle) if p.endswith(".z") and p.partition(".")[0] not in still]


def _step(axle: Axle, path: str, kind: ParameterKind) -> float:
    return kind.step * (abs(parameter_value(axle, path)) if kind.relative else 1.0)


def in_windows(axle: Axle) -> Axle:
    """The axle with sweeps that end with the fit windows of the characteristics: the same matrix sooner.

    An axle with friction stays as it is: where its loops turn is part of its curves.
    """
    if axle.topology.frictional:
        return axle
    return replace(axle, load_cases={ident: _short(case) for ident, case in axle.load_cases.items()})


def _short(case: LoadCase) -> LoadCase:
    window = LOAD_CASES[case.id].window
    if case.unit != LOAD_CASES[case.id].unit:
        window = next(t.window for t in ROLL_TECHNIQUES.values() if t.unit == case.unit)
    step = case.amplitude / case.steps
    steps = min(case.steps, max(SEEDS, math.floor(window / step * (1.0 + 1e-9))))
    return replace(case, amplitude=steps * step, steps=steps)


def _unit(columns: FloatArray) -> FloatArray:
    length = np.linalg.norm(columns, axis=0)
    return np.asarray(np.divide(columns, length, out=np.zeros_like(columns), where=length > 0))
