"""Screening: what each hypothesis would gain, re-tuning projected out, without refitting the parameters.

The parameters follow to first order (their Jacobian at the tuned axle), the effect is solved for at its own
size: with Q an orthonormal basis of the tuning, residual and columns are reduced to what it cannot absorb,
and the amplitudes follow by Gauss-Newton steps on true solutions. That is the score test, followed beyond
its linear range, where effects that are large or have a dead band would mislead it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.correlation.least_squares import bounded_step
from doe_kc.correlation.likelihood import Likelihood, Rewhitening
from doe_kc.discovery.derivatives import amplitude_columns
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.projection import Changes
from doe_kc.discovery.thresholds import (
    HOPELESS,
    NULL_SHARE,
    PROBE,
    PROBE_FACTOR,
    SCREEN_DECREASE,
    SCREEN_STEP_SHARES,
    SCREEN_STEPS,
    SHAPE_STARTS,
)
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged

REWHITENED_TOGETHER = 16
"""Hypotheses that are rewhitened at the same time: of all at once three copies of 18 MB lie side by side."""


@dataclass(frozen=True)
class Screened:
    """One hypothesis added to a fitted model, the parameters following to first order."""

    hypothesis: Hypothesis
    """The effect in its place."""
    amplitudes: FloatArray
    """(m,) most probable amplitudes, in typical sizes."""
    sd: FloatArray
    """(m,) standard deviations of them, after re-tuning and the prior."""
    gain: float
    """ln of the evidence over the model without it; -inf where it has no equilibrium."""
    columns: FloatArray
    """(M, m) derivative of the residual to the amplitudes, at `amplitudes`."""
    change: FloatArray
    """(M,) whitened change of the data at typical size."""
    bend: FloatArray
    """(M,) what the change of the data at `amplitudes` is beyond `columns` times them."""
    detectability: float
    """Standard deviations of the change after re-tuning."""
    absorbed: float
    """Share of its square that re-tuning hides, 0 to 1."""
    size_detectability: FloatArray
    """(m,) detectability of each size alone, whatever the others are; nan for a shape."""
    failed: str = ""
    """Why the axle with it has no equilibrium; empty where it has."""

    @property
    def change_only(self) -> Screened:
        """Without derivatives, which are several times as large as the change."""
        return replace(self, columns=self.columns[:0].copy(), bend=self.bend[:0].copy())

    @property
    def numbers_only(self) -> Screened:
        """Without anything of the size of the records."""
        return replace(self.change_only, change=self.change[:0].copy())


def rewhitened_screenings(
    screened: Sequence[Screened], before: Likelihood, after: Likelihood
) -> list[Screened]:
    """Their changes in units of other errors of the same records; what was concluded stays."""
    if before is after or not screened:
        return list(screened)
    units = Rewhitening(before, after)
    parts = (screened[i : i + REWHITENED_TOGETHER] for i in range(0, len(screened), REWHITENED_TOGETHER))
    return [one for part in parts for one in _rewhitened(part, units)]


def _rewhitened(screened: Sequence[Screened], units: Rewhitening) -> list[Screened]:
    blocks = [np.column_stack([s.change, s.bend, s.columns]) for s in screened]
    ends = np.cumsum([block.shape[1] for block in blocks])
    every = np.hsplit(units(np.hstack(blocks)), ends[:-1])
    return [
        replace(s, change=own[:, 0].copy(), bend=own[:, 1].copy(), columns=own[:, 2:].copy())
        for s, own in zip(screened, every, strict=True)
    ]


def screen(fit: Fit, hypothesis: Hypothesis, shape: FloatArray | None = None) -> Screened:
    """The hypothesis on its own; one without equilibria comes back as failed.

    shape: (s,) its shapes to begin with, by default the most promising of `SHAPE_STARTS`.
    """
    model = fit.model.extended(hypothesis)
    try:
        shape = _promising_shape(model, fit, hypothesis) if shape is None else shape
        starts = _start(hypothesis, PROBE, shape), _start(hypothesis, PROBE_FACTOR * PROBE, shape)
        best = amplitude_solution(model, fit, *starts)
        change = _typical(model, fit, hypothesis)
    except NotConverged as error:
        return _failure(fit, hypothesis, str(error))
    return _summary(fit, hypothesis, best, change)


def shape_of(screened: Screened) -> FloatArray:
    """(s,) the shapes at which a hypothesis was screened, as a start for the next time."""
    own = [a for s, a in zip(screened.hypothesis.sizes, screened.amplitudes, strict=True) if s.shape]
    return np.asarray(np.clip(own, min(SHAPE_STARTS), max(SHAPE_STARTS)), dtype=np.float64)


def _failure(fit: Fit, hypothesis: Hypothesis, reason: str) -> Screened:
    empty = np.zeros(len(hypothesis.sizes))
    nothing = np.zeros((fit.residual.size, empty.size))
    none = np.zeros(fit.residual.size)
    return Screened(hypothesis, empty, empty + np.inf, -np.inf, nothing, none, none, 0.0, 0.0, empty, reason)


def _promising_shape(model: EffectModel, fit: Fit, hypothesis: Hypothesis) -> FloatArray:
    """(s,) of `SHAPE_STARTS`, all shapes alike, the one along which one solution promises most."""
    count = sum(s.shape for s in hypothesis.sizes)
    starts = [np.full(count, shape) for shape in SHAPE_STARTS]
    if not count:
        return starts[0]
    promised = [_promise(model, fit, _start(hypothesis, PROBE, shape)) for shape in starts]
    return starts[int(np.argmax(promised))]


def _promise(model: EffectModel, fit: Fit, amplitudes: FloatArray) -> float:
    """Decrease of the cost along the straight line to a true solution, as far as it goes one way; -inf
    without one."""
    try:
        residual = model.residual(np.concatenate([fit.z, amplitudes]))
    except NotConverged:
        return -np.inf
    along = fit.changes(residual - fit.residual)
    slope = min(0.0, float(fit.projection.inner(along, fit.remainder)[0, 0]))
    return slope**2 / (float(fit.projection.squares(along)[0]) + float(amplitudes @ amplitudes))


def _typical(model: EffectModel, fit: Fit, hypothesis: Hypothesis) -> FloatArray:
    """(M,) change of the data at typical size; to first order where the axle has no equilibrium there."""
    amplitudes = np.array([0.0 if s.shape else 1.0 for s in hypothesis.sizes])
    least = PROBE_FACTOR * PROBE
    for share in (1.0, PROBE):
        try:
            return _change(model, fit, share * amplitudes) / share
        except NotConverged:
            continue
    return _change(model, fit, least * amplitudes) / least


def _change(model: EffectModel, fit: Fit, amplitudes: FloatArray) -> FloatArray:
    return np.asarray(model.residual(np.concatenate([fit.z, amplitudes])) - fit.residual)


def effort(hypothesis: Hypothesis) -> int:
    """Work of its screening, relative to others: solutions of a step."""
    return 1 + len(hypothesis.sizes)


def _start(hypothesis: Hypothesis, first: float, shape: FloatArray) -> FloatArray:
    start = np.array([0.0 if s.any_sign else first for s in hypothesis.sizes])
    start[[i for i, s in enumerate(hypothesis.sizes) if s.shape]] = shape
    return start


@dataclass(frozen=True)
class _AmplitudeSolution:
    """A point of the search for the amplitudes."""

    amplitudes: FloatArray
    """(m,)."""
    columns: Changes
    """(M, m) derivative of the residual to them."""
    change: Changes
    """(M, 1) of the residual, from the model without the effect."""
    cost: float
    """Sum of squares of what re-tuning leaves of the residual, and of the amplitudes."""
    solved: bool = True
    """False where amplitudes and cost are those that a first step promises, which is nothing."""


def amplitude_solution(
    model: EffectModel, fit: Fit, start: FloatArray, smaller: FloatArray
) -> _AmplitudeSolution:
    """Gauss-Newton steps of the amplitudes on true solutions, given up where they promise nothing.

    A promise that is worse than the model without the effect is none: along a straight line the effect could
    be absent. Then the search begins anew, from `smaller`, where the effect is closer to linear; and so it
    does where the axle has no equilibrium at `start`.
    """
    place = slice(fit.z.size, fit.z.size + start.size)
    low, high = model.lower[place], model.upper[place]
    without = fit.misfit_left
    try:
        best = _derived(model, fit, _solved(model, fit, start), place)
    except NotConverged:
        if np.array_equal(start, smaller):
            raise
        return amplitude_solution(model, fit, smaller, smaller)
    for k in range(SCREEN_STEPS if start.size else 0):
        hessian = fit.projection.gram_of(best.columns) + np.eye(start.size)
        pulled = fit.projection.inner(best.columns, fit.remainder) + fit.projection.inner(
            best.columns, best.change
        )
        slope = pulled[:, 0] + best.amplitudes
        step = bounded_step(hessian, slope, low - best.amplitudes, high - best.amplitudes)
        predicted = best.cost + 2.0 * float(slope @ step) + float(step @ hessian @ step)
        if k == 0 and predicted > without + 2.0 * HOPELESS and not np.array_equal(start, smaller):
            return amplitude_solution(model, fit, smaller, smaller)
        if without - predicted < 2.0 * HOPELESS:
            return replace(best, amplitudes=best.amplitudes + step, cost=predicted, solved=False)
        trial = _better(model, fit, best, step)
        if trial is None:
            break
        gained, best = best.cost - trial.cost, trial
        if gained < SCREEN_DECREASE:
            break
        best = _derived(model, fit, best, place)
    return best


def _better(
    model: EffectModel, fit: Fit, best: _AmplitudeSolution, step: FloatArray
) -> _AmplitudeSolution | None:
    """The longest of the shortened steps that gains, None when none does or has an equilibrium."""
    for share in SCREEN_STEP_SHARES:
        try:
            trial = _solved(model, fit, best.amplitudes + share * step, best)
        except NotConverged:
            continue
        if trial.cost < best.cost:
            return trial
    return None


def _solved(
    model: EffectModel, fit: Fit, amplitudes: FloatArray, near: _AmplitudeSolution | None = None
) -> _AmplitudeSolution:
    """The true solution at some amplitudes, its columns those of a point that is near or still none."""
    residual = model.residual(np.concatenate([fit.z, amplitudes]))
    change = fit.changes(residual - fit.residual)
    along = float(fit.projection.inner(change, fit.remainder)[0, 0])
    seen = fit.misfit_left + 2.0 * along + float(fit.projection.squares(change)[0])
    columns = change.columns(slice(0)) if near is None else near.columns
    return _AmplitudeSolution(amplitudes, columns, change, seen + float(amplitudes @ amplitudes))


def _derived(model: EffectModel, fit: Fit, best: _AmplitudeSolution, place: slice) -> _AmplitudeSolution:
    """The same with columns taken there. place: of the amplitudes in z."""
    z, residual = np.concatenate([fit.z, best.amplitudes]), fit.residual + best.change.rows[:, 0]
    columns = amplitude_columns(model, z, residual, range(place.start, place.stop))
    return replace(best, columns=fit.changes(columns))


def _summary(fit: Fit, hypothesis: Hypothesis, best: _AmplitudeSolution, change: FloatArray) -> Screened:
    columns, done = best.columns.rows, best.change.rows[:, 0]
    hessian = fit.projection.gram_of(best.columns) + np.eye(best.amplitudes.size)
    seen, square = float(fit.without_traces.squares(fit.changes(change))[0]), float(change @ change)
    alone = fit.without_traces.gram_of(best.columns)
    solved = done if best.solved else columns @ best.amplitudes
    return Screened(
        hypothesis,
        best.amplitudes,
        np.sqrt(np.diag(np.linalg.inv(hessian))),
        0.5 * (fit.misfit_left - best.cost) - 0.5 * float(np.linalg.slogdet(hessian)[1]),
        columns,
        change,
        solved - columns @ best.amplitudes,
        float(np.sqrt(seen)),
        1.0 - seen / square if square > 0.0 else 0.0,
        size_detectability(hypothesis, alone, float(np.sqrt(seen))),
    )


def size_detectability(hypothesis: Hypothesis, gram: FloatArray, detectability: float) -> FloatArray:
    """(m,) see `Screened`. gram: (m, m) of the effect's columns, re-tuning projected out."""
    out = np.full(len(hypothesis.sizes), np.nan)
    amounts = [i for i, s in enumerate(hypothesis.sizes) if not s.shape]
    if len(amounts) == 1:
        out[amounts] = detectability
    elif amounts:
        own = gram[np.ix_(amounts, amounts)]
        least = NULL_SHARE * max(float(np.trace(own)), NULL_SHARE)
        out[amounts] = 1.0 / np.sqrt(np.diag(np.linalg.inv(own + least * np.eye(len(amounts)))))
    return out
