"""What a live page draws of an outside solver while a slider moves: the surrogate of its stored designs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import with_values
from doe_kc.campaign.store import Store, read_store
from doe_kc.campaign.store_file import check_solver
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.linearization import Linearization, linearize
from doe_kc.correlation.twin import Twin
from doe_kc.ground.errors import InputError
from doe_kc.ground.numbers import number
from doe_kc.ground.typing import FloatArray
from doe_kc.live.answer_vector import AnswerVector
from doe_kc.live.curve_surrogate import (
    CurveSurrogate,
    LeftOutError,
    fit_curve_surrogate,
    left_out_error,
)
from doe_kc.solver.curve_gradient import interpolated
from doe_kc.solver.result import Solution
from doe_kc.study import Study
from doe_kc.surrogate_models.designs import place
from doe_kc.surrogate_models.study import VALIDATION_DESIGNS
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import Space

MOST_DESIGNS = 200
"""Stored designs that are learnt from, the latest ones: the cost grows with the cube of their number."""
ENOUGH_DESIGNS = 1
"""With a twin, which one design shifts onto the outside model."""


@dataclass(frozen=True)
class StoredDesign:
    """A design of the store that the page can learn from. base: (N,) of the twin's answer, zero without a
    twin."""

    key: str
    point: FloatArray
    vector: FloatArray
    base: FloatArray


@dataclass(frozen=True)
class OutsideModel:
    """twin: base that the surrogate adds to; None without one. drawn_axle: whose shape is drawn, the twin or
    the study's axle. designs: learnt from. error: of curves of designs left out."""

    study: Study
    space: Space
    form: AnswerVector
    drawn_axle: Axle
    twin: Twin | None
    designs: tuple[StoredDesign, ...]
    surrogate: CurveSurrogate
    error: LeftOutError

    def outcome(self, point: FloatArray, half_track: float, base: Outcome | None) -> Outcome:
        """What the surrogate says at a point (d,). base: the twin's answer there."""
        vector = self.surrogate.at(point) + self._base(base)
        return self.form.outcome(vector, self.study.windows, half_track)

    def _base(self, base: Outcome | None) -> FloatArray:
        return np.zeros(len(self.surrogate.middle)) if base is None else self.form.of(base)

    def expansion(
        self, point: FloatArray, half_track: float, solution: Solution, base: Outcome | None
    ) -> Linearization:
        """First-order expansion of what is drawn. solution, base: of the twin at the point."""
        slopes = self.surrogate.slopes(point)
        if self.twin is not None:
            own = linearize(self.twin.axle, self.space, point, self.study.windows, solve=lambda _: solution)
            slopes = slopes + _twin_slopes(self.form, own, slopes.shape)
        vector = self.surrogate.at(point) + self._base(base)
        characteristics = self.form.characteristic_slopes(vector, slopes, self.study.windows, half_track)
        return Linearization(characteristics, self.form.gradients(slopes, self.space.paths))

    def learnt(self, design: StoredDesign) -> OutsideModel:
        """With one more design; the error stays that of the designs before."""
        designs = (*(d for d in self.designs if d.key != design.key), design)[-MOST_DESIGNS:]
        points, rows = _arrays(designs)
        return replace(self, designs=designs, surrogate=fit_curve_surrogate(points, rows, self.form))

    @property
    def sentence(self) -> str:
        """What is dashed, how far it can be believed."""
        n, error = len(self.designs), self.error
        what = f"a surrogate of {n} stored designs" if self.surrogate.scores is not None else ""
        if self.twin is not None:
            shift = f"the twin, shifted onto {n} stored design{'s' if n > 1 else ''} of the outside solver"
            what = f"the twin, corrected by {what}" if what else shift
        words = f"Dashed: {what}."
        if np.isfinite(error.worst):
            words += (
                f" Stored designs that it was not fitted to: worst curve off by "
                f"{number(100.0 * error.median, 2)} % of its range in the median, "
                f"{number(100.0 * error.worst, 2)} % at most."
            )
        return f"{words} Solid: the outside solver, which answers when a slider is let go."


def outside_model(study: Study, space: Space) -> OutsideModel:
    """The model learnt from the study's store; InputError saying what to run where it holds too little."""
    twin = None if study.twin is None else Twin(study.twin, study.windows)
    with _opened(study) as store:
        places = (
            (r.key, place(r.parameters, space, study.axle)) for r in store.records() if not r.packed.reason
        )
        inside = [(key, point) for key, point in places if point is not None][-MOST_DESIGNS:]
        answers = [(key, point, store.outcome(key, study.windows)) for key, point in inside]
    needed = VALIDATION_DESIGNS if twin is None else ENOUGH_DESIGNS
    whole = [(key, p, outcome) for key, p, outcome in answers if outcome.curves is not None]
    if answers and not whole:
        raise InputError(
            f"{study.store}: holds no curves, which a live page draws; let the command write curves.csv, and "
            f"run doe-kc sample {study.source} --n {2 * needed} --curves all."
        )
    form = _form(whole[-1][2]) if whole else None
    designs = [] if form is None else list(_designs(form, whole, space, twin))
    if form is None or len(designs) < needed:
        raise InputError(_too_few(study, len(designs), needed))
    points, rows = _arrays(designs)
    return OutsideModel(
        study=study,
        space=space,
        form=form,
        drawn_axle=study.axle if study.twin is None else study.twin,
        twin=twin,
        designs=tuple(designs),
        surrogate=fit_curve_surrogate(points, rows, form),
        error=left_out_error(points, rows, np.array([d.vector for d in designs]), form),
    )


def _too_few(study: Study, count: int, needed: int) -> str:
    wanted = max(2 * VALIDATION_DESIGNS, study.space.dimension)
    beside = "at least 1 beside its twin" if needed == ENOUGH_DESIGNS else f"at least {needed}"
    return (
        f"{study.store}: holds {count} designs of the study's variables; a live page of an outside solver "
        f"needs {beside} and does well with {wanted}; run doe-kc sample {study.source} --n {wanted} first."
    )


def _opened(study: Study) -> Store:
    if not study.store.is_file():
        needed = VALIDATION_DESIGNS if study.twin is None else ENOUGH_DESIGNS
        raise InputError(_too_few(study, 0, needed))
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    store = read_store(study.store)
    try:
        check_solver(store.meta, solver.fingerprint(), solver.describe(), str(study.store))
    except InputError:
        store.close()
        raise
    return store


def _form(outcome: Outcome) -> AnswerVector:
    """As the latest design has it: the command that is used now."""
    curves = outcome.curves
    assert curves is not None
    alone = AnswerVector(curves, ())
    read = alone.outcome(alone.of(outcome), {}, curves.half_track).characteristics
    beside = np.isnan(read) & np.isfinite(outcome.characteristics)
    return AnswerVector(curves, tuple(int(i) for i in np.flatnonzero(beside[: len(CHARACTERISTICS)])))


def _designs(
    form: AnswerVector,
    answers: Iterable[tuple[str, FloatArray, Outcome]],
    space: Space,
    twin: Twin | None,
) -> Iterable[StoredDesign]:
    """Each point once, those that the twin has no equilibrium for left out."""
    seen: set[bytes] = set()
    for key, point, outcome in answers:
        mark = np.round(point, 10).tobytes()
        design = None if mark in seen else stored_design(form, key, point, outcome, space, twin)
        seen.add(mark)
        if design is not None:
            yield design


def stored_design(
    form: AnswerVector, key: str, point: FloatArray, outcome: Outcome, space: Space, twin: Twin | None
) -> StoredDesign | None:
    """A design to learn from; None where its answer lacks something or the twin has none."""
    if not form.fits(outcome):
        return None
    vector = form.of(outcome)
    if twin is None:
        return StoredDesign(key, point, vector, np.zeros_like(vector))
    own = twin.answer(space, point)
    return None if own.failed or own.curves is None else StoredDesign(key, point, vector, form.of(own))


def _arrays(designs: Iterable[StoredDesign]) -> tuple[FloatArray, FloatArray]:
    """(n, d) points, and (n, N) what the surrogate is of."""
    kept = list(designs)
    return np.array([d.point for d in kept]), np.array([d.vector - d.base for d in kept])


def _twin_slopes(form: AnswerVector, own: Linearization, shape: tuple[int, ...]) -> FloatArray:
    """(N, d) slopes of the twin at the pattern's inputs."""
    curves, out = own.curves, np.zeros(shape)
    for b in form.blocks:
        every: Mapping[str, Mapping[str, FloatArray]] = curves.half_width if b.half else curves.cases
        if b.load_case not in every:
            continue
        rows, grid = every[b.load_case][b.response], curves.inputs[b.load_case]
        wanted = form.pattern.cases[b.load_case].input
        out[b.place] = _rows_at(wanted, grid, rows).reshape(-1, shape[1])
    at = form.blocks[-1].place.stop
    for angle in form.angles:
        out[at : at + 2] = curves.static[angle]
        at += 2
    out[at:] = np.nan_to_num(own.characteristics[list(form.rows)])
    return out


def _rows_at(wanted: FloatArray, grid: FloatArray, rows: FloatArray) -> FloatArray:
    if wanted.size == grid.size and np.array_equal(wanted, grid):
        return rows
    return np.array([interpolated(wanted, grid, side) for side in rows])


def half_track_of(model: OutsideModel, values: Mapping[str, float]) -> float:
    """Of the study's axle at values, mm."""
    return with_values(model.study.axle, values).half_track
