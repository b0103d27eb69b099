"""Which variables to free for the measured differences at hand, how far each moves, with what bounds.

A linear Gaussian view of the correlation: differences d (target minus baseline) of sd s, parameters with
a prior sd p about nominal, Jacobian J, scaled sensitivities S = J p / s. See `identifiability`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from doe_kc.axle.design_parameters import Parameter
from doe_kc.characteristics import Characteristic
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.identifiability import (
    Pivots,
    choose,
    collinearity_index,
    cosines,
    expected_move,
    posterior_ratio,
)
from doe_kc.parameter_influence.selection_result import CharacteristicForecast, Selection, VariableAdvice
from doe_kc.parameter_influence.study import Influence
from doe_kc.targets.comparison import constraint_interval

BOUND_TOLERANCE = 1e-6
"""Share of the range within which a move counts as being at its bound."""
BOUND_MARGIN = 1.25
"""A widened bound reaches the move wanted without bounds times this."""
WIDEST = 3.0
"""Largest widening, in multiples of the default distance from nominal to bound."""

USE = "use"
USE_AT_BOUND = "use, at bound"
FIX_NO_INFLUENCE = "fix (no influence)"
FIX_FAILED = "fix (axle fails at its step)"


@one_thread()
def select_variables(
    influence: Influence,
    targets: Mapping[str, float],
    *,
    sd: Mapping[str, float] | None = None,
) -> Selection:
    """Verdict, expected move and bounds of every parameter of `influence` for `targets`.

    targets: characteristic id -> measured value in its unit; a nan is left out.
    sd: standard deviations, by default half the thesis's constraint interval, equations 5.1 and 5.2.
    A parameter's prior standard deviation about nominal is a quarter of the distance of its bounds.
    InputError for an unknown characteristic, an sd that is not positive, or no usable target.
    """
    problem = _problem(influence, targets, sd or {})
    pivots = choose(problem.scaled)
    columns = list(pivots.order)
    values = np.linalg.svd(problem.scaled, compute_uv=False)
    variables = _variables(problem, pivots)
    return Selection(
        variables=tuple(sorted(variables, key=lambda v: (v.pivot or math.inf, -v.influence))),
        outcomes=tuple(_outcomes(problem, variables)),
        singular_values=tuple(map(float, values)),
        rank=int(np.linalg.matrix_rank(problem.scaled)),
        informed=int((values > 1.0).sum()),
        condition=float(np.linalg.cond(problem.scaled[:, columns])) if columns else math.nan,
    )


@dataclass(frozen=True)
class _Problem:
    """m characteristics with a target, n parameters.

    jacobian: (m, n) per unit, zero columns where `failed`. baseline, target, sd: (m,). prior: (n,).
    lower, upper: (n,) bounds as offsets from nominal, in prior sd.
    """

    parameters: tuple[Parameter, ...]
    characteristics: tuple[Characteristic, ...]
    jacobian: FloatArray
    failed: NDArray[np.bool_]
    baseline: FloatArray
    target: FloatArray
    sd: FloatArray
    prior: FloatArray
    lower: FloatArray
    upper: FloatArray

    @property
    def scaled(self) -> FloatArray:
        """(m, n) S = J p / s."""
        return self.jacobian * self.prior / self.sd[:, None]


def _problem(
    influence: Influence,
    targets: Mapping[str, float],
    sd: Mapping[str, float],
) -> _Problem:
    rows = _rows(influence, targets)
    known = tuple(influence.characteristics[j] for j in rows)
    slopes = per_unit(influence)[:, rows].T
    failed = np.asarray(~np.isfinite(slopes).all(axis=0))
    prior = np.array([(p.upper - p.lower) / 4.0 for p in influence.parameters])
    return _Problem(
        parameters=influence.parameters,
        characteristics=known,
        jacobian=np.where(failed, 0.0, slopes),
        failed=failed,
        baseline=influence.baseline[rows],
        target=np.array([targets[c.id] for c in known]),
        sd=np.array([_sd(c.id, targets[c.id], sd) for c in known]),
        prior=prior,
        lower=np.array([p.lower - p.nominal for p in influence.parameters]) / prior,
        upper=np.array([p.upper - p.nominal for p in influence.parameters]) / prior,
    )


def _variables(problem: _Problem, pivots: Pivots) -> list[VariableAdvice]:
    columns = list(pivots.order)
    scaled, wish = problem.scaled[:, columns], (problem.target - problem.baseline) / problem.sd
    z, free = np.zeros(problem.prior.size), np.zeros(problem.prior.size)
    z[columns] = expected_move(scaled, wish, problem.lower[columns], problem.upper[columns])
    free[columns] = expected_move(scaled, wish)
    ratio = posterior_ratio(problem.scaled)
    return [
        _failed(p)
        if problem.failed[i]
        else _variable(problem, pivots, i, float(z[i]), float(free[i]), float(ratio[i]))
        for i, p in enumerate(problem.parameters)
    ]


def _outcomes(problem: _Problem, variables: list[VariableAdvice]) -> Iterator[CharacteristicForecast]:
    moves = np.array([v.move for v in variables])
    expected = problem.baseline + problem.jacobian @ moves
    for j, entry in enumerate(problem.characteristics):
        yield CharacteristicForecast(
            characteristic=entry.id,
            unit=entry.unit,
            baseline=float(problem.baseline[j]),
            target=float(problem.target[j]),
            sd=float(problem.sd[j]),
            expected=float(expected[j]),
        )


def per_unit(influence: Influence) -> FloatArray:
    """(parameters, characteristics) exact slope per unit of the parameter; one at a time where none."""
    steps = np.array([p.step for p in influence.parameters])[:, None]
    return np.asarray(np.where(np.isfinite(influence.exact), influence.exact, influence.absolute) / steps)


def suggested_bounds(parameter: Parameter, side: str, wanted: float) -> tuple[float, float]:
    """Default bounds, the `side` at which the move ends widened towards `wanted` (offset from nominal).

    A bound of what must stay positive (stiffnesses, factors, radii, clearances) is at most halved, so
    that it never reaches zero.
    """
    lower, upper = parameter.lower, parameter.upper
    if side == "upper":
        span = upper - parameter.nominal
        upper = parameter.nominal + max(span, min(WIDEST * span, BOUND_MARGIN * wanted))
    if side == "lower":
        span = parameter.nominal - lower
        widened = parameter.nominal - max(span, min(WIDEST * span, -BOUND_MARGIN * wanted))
        positive = parameter.quantity != "coordinate" and lower >= 0.0
        lower = max(widened, lower / 2.0) if positive else widened
    return lower, upper


def _variable(
    problem: _Problem, pivots: Pivots, i: int, z: float, free: float, ratio: float
) -> VariableAdvice:
    parameter, scaled = problem.parameters[i], problem.scaled
    others = [j for j in pivots.order if j != i]
    length = float(np.linalg.norm(scaled[:, i]))
    pivot = pivots.order.index(i) + 1 if i in pivots.order else None
    partner = _partner(problem, pivots, i, others) if length > 0 else ""
    side = _bound_hit(z, problem.lower[i], problem.upper[i]) if pivot else ""
    lower, upper = suggested_bounds(parameter, side, free * float(problem.prior[i]))
    return VariableAdvice(
        parameter=parameter,
        verdict=_verdict(pivot, side, partner if i in pivots.alike else ""),
        pivot=pivot,
        influence=length,
        strongest=problem.characteristics[int(np.argmax(np.abs(scaled[:, i])))].id if length > 0 else "",
        collinearity=collinearity_index(scaled, i, others),
        partner=partner,
        posterior_ratio=ratio,
        move=z * float(problem.prior[i]),
        at_bound=side,
        lower=lower,
        upper=upper,
    )


def _partner(problem: _Problem, pivots: Pivots, i: int, others: list[int]) -> str:
    if i in pivots.alike:
        return problem.parameters[pivots.alike[i]].path
    if not others:
        return ""
    return problem.parameters[others[int(np.argmax(cosines(problem.scaled, i, others)))]].path


def _failed(parameter: Parameter) -> VariableAdvice:
    return VariableAdvice(
        parameter=parameter,
        verdict=FIX_FAILED,
        pivot=None,
        influence=0.0,
        strongest="",
        collinearity=1.0,
        partner="",
        posterior_ratio=1.0,
        move=0.0,
        at_bound="",
        lower=parameter.lower,
        upper=parameter.upper,
    )


def _verdict(pivot: int | None, side: str, alike: str) -> str:
    if pivot is None:
        return f"fix (collinear with {alike})" if alike else FIX_NO_INFLUENCE
    return USE_AT_BOUND if side else USE


def _bound_hit(z: float, lower: float, upper: float) -> str:
    near = BOUND_TOLERANCE * (upper - lower)
    if z <= lower + near and z < 0.0:
        return "lower"
    return "upper" if z >= upper - near and z > 0.0 else ""


def _rows(influence: Influence, targets: Mapping[str, float]) -> list[int]:
    ids = [c.id for c in influence.characteristics]
    for name in targets:
        if name not in ids:
            raise InputError(f"target {name!r} is not a characteristic of the study.{nearest(name, ids)}")
    known = [math.isfinite(targets.get(i, math.nan)) for i in ids]
    rows = [j for j in range(len(ids)) if known[j] and math.isfinite(influence.baseline[j])]
    if not rows:
        raise InputError("no characteristic has a measured value; a selection needs at least one target.")
    return rows


def _sd(name: str, target: float, values: Mapping[str, float]) -> float:
    low, high = constraint_interval(target)
    value = values.get(name, (high - low) / 2.0)
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"standard deviation of {name} is {value:g}, expected a number > 0.")
    return value
