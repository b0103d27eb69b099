"""Advice on the true model: the best step, the sliders that help most, and what the records do not see."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.least_squares import bounded_step, normal_equations
from doe_kc.correlation.posterior import BOUND_SHARE, VISIBLE_SHARE, posterior
from doe_kc.curves import RESPONSE_UNITS
from doe_kc.ground.errors import RunError
from doe_kc.ground.numbers import number
from doe_kc.ground.typing import FloatArray
from doe_kc.live.answer import Compilation, LiveAnswer, LiveSlopes, slopes_of, solve_live
from doe_kc.targets.comparison import FLOOR
from doe_kc.variables import Space

MOST_ITERATIONS = 4
"""Gauss-Newton steps of one advice, 0.2 s each: the model is nearly linear, the second changes little."""
ENOUGH = 0.01
"""Share of the squared gap that a step must take off for another one to follow."""
FRACTIONS = (1.0, 0.5, 0.25, 0.1)
"""Of a step, tried in turn until the true model is better."""
HOLD_SHARE = 1e-5
"""Of a characteristic's scale: the standard deviation by which one that is held may move."""
HELD_WELL = 100.0
"""Of these standard deviations: a drift of a thousandth of the scale, by which a step that bends counts as
held; the next step takes it back."""
HELPERS = 3


@dataclass(frozen=True)
class Suggestion:
    """One slider of an advice. value: absolute, where it goes; note: why it is listed."""

    path: str
    value: float
    note: str


@dataclass(frozen=True)
class Advised:
    """what: best_step, helpers or invisible. adopt: values to go to; none where nothing moves."""

    what: str
    sentence: str
    rows: tuple[Suggestion, ...]
    adopt: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class _Local:
    """The quadratic of |r + J s|^2 + |(u + s - u0) / P|^2 in the free places, with their bounds."""

    free: np.ndarray
    hessian: FloatArray
    gradient: FloatArray
    lower: FloatArray
    upper: FloatArray

    def step(self, among: Sequence[int]) -> FloatArray:
        """(k,) best step of some of the free places alone."""
        i = np.array(among, dtype=int)
        return bounded_step(self.hessian[np.ix_(i, i)], self.gradient[i], self.lower[i], self.upper[i])

    def gain(self, among: Sequence[int], step: FloatArray) -> float:
        """How much less the half of the sum is after that step."""
        i = np.array(among, dtype=int)
        return -float(self.gradient[i] @ step + 0.5 * step @ self.hessian[np.ix_(i, i)] @ step)


def _local(
    slopes: LiveSlopes, space: Space, free: Sequence[bool], rows: FloatArray, residual: FloatArray
) -> _Local:
    """rows, residual: (M + h, d) and (M + h,) of the data and of what is held. space: with the bounds."""
    own, point = slopes.answer.model.space, slopes.answer.point
    hessian, gradient = normal_equations(rows, residual, own.prior_sd**-2.0, point - own.start)
    lower = np.array([o.place(v.lower) for o, v in zip(own.variables, space.variables, strict=True)]) - point
    upper = np.array([o.place(v.upper) for o, v in zip(own.variables, space.variables, strict=True)]) - point
    i = np.flatnonzero(np.array(free))
    return _Local(i, hessian[np.ix_(i, i)], gradient[i], np.minimum(lower[i], 0.0), np.maximum(upper[i], 0.0))


def best_step(
    slopes: LiveSlopes,
    space: Space,
    free: Sequence[bool],
    held: Collection[str],
    compilation: Compilation,
) -> Advised:
    """Gauss-Newton on the records with the free sliders within `space`, each confirmed by the true model.

    free: (d,) sliders that may move. held: characteristics that stay where they are. RunError when no
    fraction of the first step makes the true model better.
    """
    first = slopes.answer
    answer, now = first, slopes
    for _ in range(MOST_ITERATIONS):
        rows, residual = _with_held(now, first, held)
        local = _local(now, space, free, rows, residual)
        everything = range(len(local.free))
        better = _better(answer, first, held, local.free, local.step(everything), compilation)
        if better is None:
            break
        before, answer = answer, better
        settled = answer.gap**2 > (1.0 - ENOUGH) * before.gap**2
        if settled and np.all(np.abs(_drift(answer, first, held)) < HELD_WELL):
            break
        now = slopes_of(answer)
    if answer is first:
        raise RunError("no step with these sliders and bounds brings the model nearer to the records.")
    return _told(first, answer, space, free, held)


def _with_held(slopes: LiveSlopes, first: LiveAnswer, held: Collection[str]) -> tuple[FloatArray, FloatArray]:
    places, scale = _held_places(first, held)
    extra = slopes.expansion.characteristics[places] / scale[:, None]
    drift = _drift(slopes.answer, first, held)
    return np.vstack([slopes.jacobian, extra]), np.concatenate([slopes.answer.residual, drift])


def _held_places(first: LiveAnswer, held: Collection[str]) -> tuple[list[int], FloatArray]:
    """Rows of the characteristics that are held, and the standard deviations by which they may move."""
    places = [list(CHARACTERISTICS).index(name) for name in sorted(held)]
    return places, HOLD_SHARE * np.hypot(first.characteristics[places], math.sqrt(FLOOR))


def _drift(answer: LiveAnswer, first: LiveAnswer, held: Collection[str]) -> FloatArray:
    """(h,) how far each has moved, in those."""
    places, scale = _held_places(first, held)
    return np.asarray((answer.characteristics - first.characteristics)[places] / scale)


def _better(
    answer: LiveAnswer,
    first: LiveAnswer,
    held: Collection[str],
    free: np.ndarray,
    step: FloatArray,
    compilation: Compilation,
) -> LiveAnswer | None:
    """The true model's answer after the largest fraction of a step that makes it better."""
    space = answer.model.space
    for fraction in FRACTIONS:
        point = answer.point.copy()
        point[free] += fraction * step
        moved = {v.path: v.value(float(u)) for v, u in zip(space.variables, point, strict=True)}
        trial = solve_live(answer.model, moved, compilation)
        if not isinstance(trial, str) and _cost(trial, first, held) < _cost(answer, first, held):
            return trial
    return None


def _cost(answer: LiveAnswer, first: LiveAnswer, held: Collection[str]) -> float:
    own = answer.model.space
    drift = _drift(answer, first, held) / HELD_WELL
    moved = (answer.point - own.start) / own.prior_sd
    return float(answer.residual @ answer.residual + drift @ drift + moved @ moved)


def _told(
    first: LiveAnswer, answer: LiveAnswer, space: Space, free: Sequence[bool], held: Collection[str]
) -> Advised:
    rows = []
    for variable, u, before, may in zip(space.variables, answer.point, first.point, free, strict=True):
        value = answer.values[variable.path]
        if not may or abs(u - before) < BOUND_SHARE:
            continue
        near = BOUND_SHARE * (variable.upper - variable.lower)
        at = "at its lower bound" if value - variable.lower < near else ""
        at = "at its upper bound" if variable.upper - value < near else at
        rows.append((abs(u - before), Suggestion(variable.path, value, at)))
    rows.sort(key=lambda row: -row[0])
    leaning = sum(bool(s.note) for _, s in rows)
    sentence = (
        f"The gap falls from {number(first.gap)} to {number(answer.gap)} standard deviations, {_sure(answer)}"
    )
    if leaning:
        sentence += f"; {leaning} of {len(rows)} sliders end at a bound: widen it if the part allows"
    if held:
        sentence += f"; {len(held)} characteristics held"
    adopt = {
        v.path: min(max(answer.values[v.path], v.lower), v.upper)
        for v, may in zip(space.variables, free, strict=True)
        if may
    }
    return Advised("best_step", f"{sentence}.", tuple(s for _, s in rows), adopt)


def _sure(answer: LiveAnswer) -> str:
    return "confirmed by the true model" if answer.true else "by the surrogate; the outside solver is asked"


def most_helpful(slopes: LiveSlopes, space: Space, free: Sequence[bool]) -> Advised:
    """The three sliders that close most of the gap together, chosen one after the other (forward selection).

    To first order, within the bounds.
    """
    answer = slopes.answer
    local = _local(slopes, space, free, slopes.jacobian, answer.residual)
    chosen: list[int] = []
    for _ in range(min(HELPERS, len(local.free))):
        rest = [i for i in range(len(local.free)) if i not in chosen]
        chosen.append(max(rest, key=lambda i: local.gain([*chosen, i], local.step([*chosen, i]))))
    step = local.step(chosen)
    own, rows = answer.model.space, []
    for i, s in zip(chosen, step, strict=True):
        place = int(local.free[i])
        variable = own.variables[place]
        alone = local.step([i])
        after = answer.residual + slopes.jacobian[:, [place]] @ alone
        note = f"alone to {number(math.sqrt(float(np.mean(after**2))))}"
        rows.append(Suggestion(variable.path, variable.value(float(answer.point[place] + s)), note))
    after = answer.residual + slopes.jacobian[:, local.free[chosen]] @ step
    gap = math.sqrt(float(np.mean(after**2)))
    sentence = (
        f"To first order these {len(chosen)} take the gap from {number(answer.gap)} to {number(gap)} "
        "standard deviations together."
    )
    return Advised("helpers", sentence, tuple(rows))


def not_visible(slopes: LiveSlopes, space: Space, free: Sequence[bool]) -> Advised:
    """The free sliders whose standard deviation the records do not at least halve, all free ones adjusted."""
    answer, i = slopes.answer, np.flatnonzero(np.array(free))
    own = answer.model.space
    seen = posterior(slopes.jacobian[:, i], own.prior_sd[i], residual=answer.residual, point=answer.point[i])
    share = np.asarray(seen.sd / seen.prior)
    hidden = [k for k in np.argsort(-share) if not seen.visible[k]]
    rows = tuple(
        Suggestion(
            space.paths[i[k]],
            answer.values[space.paths[i[k]]],
            f"the records leave {100.0 * min(1.0, share[k]):.0f} % of its uncertainty",
        )
        for k in hidden
    )
    sentence = (
        f"{len(rows)} of {len(i)} free sliders are not visible: adjusted together, the records leave more "
        f"than {100.0 * VISIBLE_SHARE:.0f} % of their uncertainty. Lock them, or fewer others with them."
    )
    return Advised("invisible", sentence, rows)


def influence(slopes: LiveSlopes, space: Space) -> FloatArray:
    """(1 + characteristics + curves, d) of each slider, for the page's bars and order.

    First row: what the slider alone, at its best within the bounds, takes off the gap, with the sign of its
    move. Then the derivative of every registered characteristic, its unit per the parameter's. Then the RMS
    change of every curve of the left wheel, load cases and responses in the order of the answer's curves.
    """
    answer, per_unit = slopes.answer, slopes.per_unit
    gap = np.zeros(len(per_unit))
    if answer.residual.size:
        local = _local(slopes, space, [True] * len(per_unit), slopes.jacobian, answer.residual)
        diagonal = np.diag(local.hessian)
        step = np.clip(-local.gradient / diagonal, local.lower, local.upper)
        after = answer.residual[:, None] + slopes.jacobian * step
        gap = (answer.gap - np.sqrt(np.mean(after**2, axis=0))) * np.sign(step)
    curves = [
        np.sqrt(np.mean(slopes.expansion.curves.cases[case][response][0] ** 2, axis=0)) * np.abs(per_unit)
        for case in answer.curves.cases
        for response in RESPONSE_UNITS
    ]
    return np.vstack([gap, slopes.expansion.characteristics * per_unit, *curves])
