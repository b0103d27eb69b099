"""Fits and cross-validates surrogates of all characteristics, and chooses one for each."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np

from doe_kc.campaign.executors import processes
from doe_kc.campaign.processes import available_cores
from doe_kc.ground.errors import DoeKcError, InputError, RunError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.calibration import (
    Calibrated,
    calibration_factors,
    coverage_after,
    coverage_interval,
)
from doe_kc.surrogate_models.folds import fold, fold_rows
from doe_kc.surrogate_models.interface import Fitted, LeftOut, SurrogateModel
from doe_kc.surrogate_models.models import SURROGATES, make
from doe_kc.surrogate_models.models.gp import FirstOrderTrend
from doe_kc.surrogate_models.models.gp_slopes import SlopeProcess
from doe_kc.surrogate_models.selection import choose, join
from doe_kc.surrogate_models.validation import Quality, quality
from doe_kc.surrogate_models.varying import fit_varying

VALIDATION_DESIGNS = 10
"""Designs below which a cross-validation says little."""
MANY_DESIGNS = 150
"""Designs from which a fold of a fifth leaves enough to learn from: the error grows by some 20 %."""
Progress = Callable[[int], None]


@dataclass(frozen=True)
class Judged:
    """A model of all outputs. held: residuals of rows it was not fitted to, by refitting where its own would
    be too small, and the variance that the model in use has for these rows left out. factors: (m,) of
    calibration. covered: (m,) coverage with them, counted on the same rows. limits: (m,) each, between which
    the coverage of new designs is with 95 % confidence. seconds: of one fit, of a processor.
    """

    fitted: Fitted
    held: LeftOut
    quality: Quality
    factors: FloatArray
    covered: FloatArray
    limits: tuple[FloatArray, FloatArray]
    seconds: float


@dataclass(frozen=True)
class SurrogateStudy:
    """x: (n, d) designs, y: (n, m) outputs. models: id -> result, the simplest first. skipped: id -> why.
    chosen: (m,) model id of each output.
    """

    x: FloatArray
    y: FloatArray
    models: dict[str, Judged]
    skipped: dict[str, str]
    chosen: tuple[str, ...]

    @property
    def model(self) -> Fitted:
        """The chosen models as one, variances calibrated."""
        return join({k: Calibrated(m.fitted, m.factors) for k, m in self.models.items()}, self.chosen)

    def of_chosen(self, values: dict[str, FloatArray]) -> FloatArray:
        """(..., m) of model -> (..., m): each output's from its chosen model."""
        return np.stack([values[name][..., j] for j, name in enumerate(self.chosen)], axis=-1)


def default_models(designs: int, variables: int, *, slopes: bool = False) -> list[str]:
    """Models worth their time at that many designs. slopes: whether exact ones are known."""
    return [
        k
        for k, kind in SURROGATES.items()
        if kind().worthwhile(designs, variables) and (slopes or not kind.uses_slopes)
    ]


def default_folds(designs: int) -> int:
    """Ten refits, five from 150 designs on, where they cost the most and tell the least."""
    return 10 if designs < MANY_DESIGNS else 5


def number_of_tasks(names: Sequence[str], designs: int, folds: int | None) -> int:
    """Steps of the progress of `fit_study`."""
    count = folds or default_folds(designs)
    return sum(
        1 + (min(count, designs) if SURROGATES[n].optimistic_loo else 0) for n in names if n in SURROGATES
    )


@one_thread()
def fit_study(
    x: FloatArray,
    y: FloatArray,
    *,
    models: Sequence[str] = (),
    folds: int | None = None,
    seed: int = 0,
    workers: int | None = None,
    progress: Progress = lambda _: None,
    trend: FirstOrderTrend | None = None,
) -> SurrogateStudy:
    """Every model fitted to designs x (n, d) in the unit cube and outputs y (n, m), judged and chosen from.

    models: ids, default those of `default_models`. Models that learn many hyper-parameters are judged by
    refitting them to `folds`, default `default_folds`; the others by their own cross-validation. trend: exact
    first-order expansion of the outputs, for the models that use one. A model that cannot be fitted is
    skipped with its reason; InputError when none can, or there are fewer than 10 designs.
    """
    if len(x) < VALIDATION_DESIGNS:
        raise InputError(
            f"surrogates: {len(x)} designs, needs at least {VALIDATION_DESIGNS}; run more with doe-kc sample."
        )
    known = models or default_models(*x.shape, slopes=trend is not None)
    names = sorted(known, key=lambda n: make(n).complexity)
    folds = folds or default_folds(len(x))
    results = _all(_tasks(names, trend, x, y, folds, seed), workers, progress)
    judged: dict[str, Judged] = {}
    skipped: dict[str, str] = {}
    for name in names:
        parts = results[name]
        failed = [p for p in parts if isinstance(p, str)]
        if failed:
            skipped[name] = failed[0]
        else:
            judged[name] = _judged(parts, x, y, folds, seed)
    if not judged:
        raise InputError(next(iter(skipped.values())))
    complexity = {name: SURROGATES[name].complexity for name in judged}
    chosen = choose({name: j.quality.q2 for name, j in judged.items()}, complexity)
    return SurrogateStudy(x, y, judged, skipped, chosen)


@dataclass(frozen=True)
class _Whole:
    fitted: Fitted
    seconds: float


_Part = _Whole | tuple[FloatArray, FloatArray] | str
_Task = Callable[[], _Part]


def model_of(name: str, trend: FirstOrderTrend | None) -> SurrogateModel:
    """The registered model, about the expansion if it uses one."""
    return SlopeProcess(trend) if name == SlopeProcess.id else make(name)


def _tasks(
    names: Sequence[str], trend: FirstOrderTrend | None, x: FloatArray, y: FloatArray, folds: int, seed: int
) -> list[tuple[str, _Task]]:
    tasks: list[tuple[str, _Task]] = []
    for name in names:
        model = model_of(name, trend)
        tasks.append((name, partial(_whole, model, x, y, seed)))
        if SURROGATES[name].optimistic_loo:
            rows = fold_rows(len(x), folds, seed)
            tasks += [(name, partial(_fold, model, x, y, left, seed)) for left in rows]
    return tasks


def _whole(model: SurrogateModel, x: FloatArray, y: FloatArray, seed: int) -> _Part:
    started = time.process_time()
    try:
        fitted = fit_varying(model, x, y, seed=seed)
    except DoeKcError as error:
        return str(error)
    return _Whole(fitted, time.process_time() - started)


def _fold(model: SurrogateModel, x: FloatArray, y: FloatArray, left: np.ndarray, seed: int) -> _Part:
    try:
        return fold(model, x, y, left, seed)
    except DoeKcError as error:
        return str(error)


def _all(tasks: list[tuple[str, _Task]], workers: int | None, progress: Progress) -> dict[str, list[_Part]]:
    results: dict[str, list[_Part]] = {name: [] for name, _ in tasks}
    count = min(workers or available_cores(), len(tasks))
    if count <= 1:
        for name, task in tasks:
            results[name].append(task())
            progress(1)
        return results
    with processes(count) as executor:
        try:
            futures = [(name, executor.submit(task)) for name, task in tasks]
            for name, future in futures:
                results[name].append(future.result())
                progress(1)
        except BrokenExecutor:
            raise RunError("a worker process was ended from outside; use fewer --workers.") from None
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)
            raise
    return results


def _judged(parts: list[_Part], x: FloatArray, y: FloatArray, folds: int, seed: int) -> Judged:
    whole = next(p for p in parts if isinstance(p, _Whole))
    refits = [p for p in parts if isinstance(p, tuple)]
    own = whole.fitted.cross_validate()
    residual = own.residual
    if refits:
        residual = np.empty_like(y)
        for left, (errors, _) in zip(fold_rows(len(x), folds, seed), refits, strict=True):
            residual[left] = errors
    # The variance is the model's own, hyper-parameters as in use: those of the folds are other ones, and
    # what they promise says nothing of what it promises (at 50 designs: 90 % covered instead of 94 %).
    held = LeftOut(residual, own.variance)
    count = min(folds, len(x)) if refits else len(x)
    return Judged(
        whole.fitted,
        held,
        quality(y, held),
        calibration_factors(held, count),
        coverage_after(held, count),
        coverage_interval(held, count),
        whole.seconds,
    )
