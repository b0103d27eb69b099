"""Where an outside model and its twin disagree, in units of the records' noise: import errors show here."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.correlation.reach import answers_alike
from doe_kc.correlation.status import STATUS_LABELS, Status
from doe_kc.correlation.twin_changes import USEFUL_SHARE, explained_share
from doe_kc.curves import ANGLES, RESPONSE_UNITS, CaseCurves, CurveSet, response_name
from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label

AGREED = 1.0
"""Whitened RMS of a difference up to which the records could not tell the two models apart."""
SHIFT_SHARE = 0.5
"""Of the squared difference that a single variable has to explain to be named."""
WIDEST_SHIFT = 0.5
"""Of a variable's range: what needs more is no error of that variable, and first order says nothing of it."""
WORST = 3
"""Places that the sentence names."""
STATIC_CASE = "static"


@dataclass(frozen=True)
class TwinDifference:
    """The outside model less its twin in one response of a load case, both wheels.

    start, best: whitened RMS over the records' points, at the first design and at the one handed over; nan
    without records. largest: of the mean curve at the design handed over, signed, in the response's unit,
    at: its input (nan of a static angle). loop: the same of the half-widths; loop_noise: their RMS in
    standard deviations of a point of the mean curve, nan without records.
    """

    load_case: str
    response: str
    start: float
    best: float
    largest: float
    at: float
    loop: float
    loop_noise: float = np.nan

    @property
    def unit(self) -> str:
        """Of the response."""
        return RESPONSE_UNITS[self.response]

    @property
    def size(self) -> float:
        """The largest of the differences in noise; 0 without records."""
        return max(float(np.nan_to_num(v)) for v in (self.start, self.best, self.loop_noise))


@dataclass(frozen=True)
class VariableShift:
    """A change of one variable in the twin that would explain `share` of the difference at the start.

    change: absolute, in the parameter's unit.
    """

    path: str
    change: float
    unit: str
    share: float


@dataclass(frozen=True)
class TwinAgreement:
    """rows: worst first. share: of the outside model's changes from design to design that the twin makes too,
    see `explained_share`. shift: the variable that explains most of the difference, None when none does.
    reason: why the twin has no answer. alike: whether the characteristics with a target agree at the start,
    see `answers_alike`: all that there is to say without records.
    """

    rows: tuple[TwinDifference, ...]
    share: float | None
    shift: VariableShift | None
    reason: str = ""
    alike: bool = True

    @property
    def status(self) -> Status:
        """sound: the records cannot tell the models apart; doubtful: they can, and what differs was learnt;
        not_usable: the twin has no answer, or changes otherwise than the outside model."""
        if self.reason or (self.share is not None and self.share < USEFUL_SHARE):
            return "not_usable"
        return "doubtful" if self.beyond or not (self.by_records or self.alike) else "sound"

    @property
    def by_records(self) -> bool:
        """Whether there is noise to compare by."""
        return any(np.isfinite(r.best) for r in self.rows)

    @property
    def usable(self) -> bool:
        """Whether its slopes stand for those of the outside model."""
        return self.status != "not_usable"

    @property
    def line(self) -> str:
        """Status and what it rests on, in sentences."""
        return f"{STATUS_LABELS[self.status]}: {' '.join(self._sentences())}"

    @property
    def beyond(self) -> tuple[TwinDifference, ...]:
        """The places that differ by more than the records' noise, worst first."""
        return tuple(r for r in self.rows if r.size > AGREED)

    def _sentences(self) -> Iterator[str]:
        if self.reason:
            yield f"The twin gives no answer to compare: {self.reason}."
            return
        if self.beyond:
            places = ", ".join(
                f"{case_label(r.load_case)} ({response_name(r.response)}) {r.size:.1f}"
                for r in self.beyond[:WORST]
            )
            yield (
                f"The outside model and its twin differ, in units of the records' noise: {places}; an import "
                "error, or an effect that only one of them has, shows there."
            )
        elif self.by_records:
            yield "The records cannot tell the outside model from its twin."
        else:
            words = "agree to" if self.alike else "differ by more than"
            yield (
                "Without measured curves there is no noise to compare by; the characteristics of the outside "
                f"model and its twin {words} a fifth of their intervals' half-widths."
            )
        if self.share is not None:
            share = 100.0 * self.share
            yield f"The twin makes {share:.4g} % of the outside model's changes from design to design."
        if not self.usable:
            yield "That is too little to lead a search on, or to give slopes."
        if self.shift is not None:
            yield (
                f"{self.shift.path} changed by {self.shift.change:+.3g} {self.shift.unit} in the twin would "
                f"explain {100 * self.shift.share:.0f} % of the difference: compare it in both models first."
            )


def twin_agreement(problem: Problem, evaluated: Sequence[Evaluated], best: Evaluated) -> TwinAgreement | None:
    """What a run says of the twin; None without one. evaluated: all designs, the first one at the start."""
    if problem.twin is None:
        return None
    start = evaluated[0]
    answers = [problem.twin_answer(e.point) for e in (start, best)]
    failed = next((a.outcome.reason for a in answers if a.score is None), "")
    if failed:
        return TwinAgreement((), None, None, failed)
    first, last = ((e, a) for e, a in zip((start, best), answers, strict=True))
    rows = _rows(problem, first, last)
    return TwinAgreement(
        tuple(sorted(rows, key=lambda r: -r.size)),
        explained_share(problem, evaluated),
        _shift(problem, start, answers[0]) if any(r.size > AGREED for r in rows) else None,
        alike=answers_alike(problem.targets, answers[0].outcome, start.outcome),
    )


Pair = tuple[Evaluated, Evaluated]
"""The same design answered by the outside model and by its twin."""


def _rows(problem: Problem, first: Pair, last: Pair) -> list[TwinDifference]:
    start, best = (_whitened(problem, pair) for pair in (first, last))
    outside, twin = (e.outcome.curves for e in last)
    if outside is None or twin is None:
        return []
    places = [
        (case, response)
        for case, curves in outside.cases.items()
        for response in curves.mean
        if case in twin.cases and response in twin.cases[case].mean
    ]
    rows = [
        TwinDifference(
            case,
            response,
            start.get((case, response), np.nan),
            best.get((case, response), np.nan),
            *_largest(outside.cases[case], twin.cases[case], response, _level(problem, case, response)),
        )
        for case, response in places
    ]
    return rows + [
        TwinDifference(
            STATIC_CASE,
            angle,
            start.get((STATIC_CASE, angle), np.nan),
            best.get((STATIC_CASE, angle), np.nan),
            _static(outside, twin, angle),
            np.nan,
            np.nan,
        )
        for angle in ANGLES
        if angle in (outside.static or {}) and angle in (twin.static or {})
    ]


def _whitened(problem: Problem, pair: Pair) -> dict[tuple[str, str], float]:
    """(load case, response) -> whitened RMS of the difference, of both wheels."""
    data = problem.likelihood
    if any(e.outcome.curves is None for e in pair) or not data.size:
        return {}
    outside, twin = (data.residual(e.outcome.curves, e.outcome.characteristics) for e in pair)
    apart = outside - twin
    squares: dict[tuple[str, str], list[float]] = {}
    end = 0
    for curve, place in data.slices():
        squares.setdefault((curve.load_case, curve.response), []).extend(apart[place] ** 2)
        end = place.stop
    for figure, value in zip(data.figures, apart[end:], strict=True):
        if figure.row < 0:
            squares.setdefault((STATIC_CASE, figure.response), []).append(float(value**2))
    return {place: float(np.sqrt(np.mean(values))) for place, values in squares.items()}


def _level(problem: Problem, load_case: str, response: str) -> float:
    """RMS standard deviation of a measured point, both wheels, in its unit; nan without records."""
    curves = [c for c in problem.likelihood.curves if (c.load_case, c.response) == (load_case, response)]
    levels = np.concatenate([c.level for c in curves]) if curves else np.array([np.nan])
    return float(np.sqrt(np.mean(levels**2)))


def _largest(
    outside: CaseCurves, twin: CaseCurves, response: str, level: float
) -> tuple[float, float, float, float]:
    """Largest difference of the mean curves, its input, and that of the half-widths, signed; the latter's RMS
    over `level`."""
    grid = outside.input
    inside = (grid >= twin.input[0]) & (grid <= twin.input[-1])

    def apart(ours: FloatArray, other: FloatArray) -> FloatArray:
        return np.array([a - np.interp(grid, twin.input, b) for a, b in zip(ours, other, strict=True)])[
            :, inside
        ]

    mean = apart(outside.mean[response], twin.mean[response])
    loop = apart(outside.half_width[response], twin.half_width[response])
    place = np.unravel_index(np.argmax(np.abs(mean)), mean.shape)
    widest = float(loop.flat[np.argmax(np.abs(loop))])
    return float(mean[place]), float(grid[inside][place[1]]), widest, float(np.sqrt(np.mean(loop**2))) / level


def _static(outside: CurveSet, twin: CurveSet, angle: str) -> float:
    apart = (outside.static or {})[angle] - (twin.static or {})[angle]
    return float(apart[np.argmax(np.abs(apart))])


def _shift(problem: Problem, start: Evaluated, answer: Evaluated) -> VariableShift | None:
    """The single variable that explains most of the difference at the start, to first order."""
    if start.outcome.curves is None or not problem.likelihood.curves:
        return None
    try:
        expansion = problem.linearize(start.point)
    except RunError:
        return None
    data = problem.likelihood
    outside, twin = (data.residual(e.outcome.curves, e.outcome.characteristics) for e in (start, answer))
    apart = outside - twin
    jacobian = data.jacobian(expansion.curves, expansion.characteristics)
    along, square = jacobian.T @ apart, (jacobian**2).sum(axis=0)
    share = along**2 / np.maximum(square * (apart @ apart), 1e-300)
    share[np.abs(along) > WIDEST_SHIFT * square] = 0.0
    place = int(np.argmax(share))
    if share[place] < SHIFT_SHARE:
        return None
    variable = problem.space.variables[place]
    step = float(along[place] / square[place] * problem.space.slopes(start.point)[place])
    return VariableShift(variable.path, step, variable.parameter.unit, float(share[place]))
