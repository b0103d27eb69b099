"""Where the work of a discovery is done: in worker processes, fits and screenings kept in the cache."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, as_completed, wait
from dataclasses import replace
from itertools import islice
from typing import Any, TypeVar

import numpy as np

from doe_kc.campaign.executors import InProcess
from doe_kc.discovery.deferred_tasks import begin_some
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, fit, known_columns
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result_arrays import fit_arrays, fit_of_arrays, screening_arrays, screening_of_arrays
from doe_kc.discovery.result_cache import Arrays, ResultCache, fingerprint, key_of
from doe_kc.discovery.screening.scan import Place
from doe_kc.discovery.screening.screen import Screened, effort, screen
from doe_kc.discovery.thresholds import CHUNKS, FREE_SHAPE_LOSS
from doe_kc.discovery.tuned_tasks import TunedTasks
from doe_kc.discovery.verdict.held_out import HeldOut, HeldOutScore, held_out_scores
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged

Watch = Callable[[str, int, int], None]
"""Told what has been done, how many steps of the work that were, and how many more are begun."""
T = TypeVar("T")
TASKS_AHEAD = 2
"""Tasks begun for each worker: one that it does, one that waits for it."""


class DiscoveryWorkers:
    """executor: where tasks run, default this process. cache: results of earlier runs, default none."""

    def __init__(
        self,
        executor: Executor | None = None,
        cache: ResultCache | None = None,
        watch: Watch = lambda *_: None,
        *,
        workers: int = 1,
    ) -> None:
        self._executor = executor or InProcess()
        self._cache = cache or ResultCache(None)
        self._told = watch
        self._begun = 0
        self._workers = workers
        self._tuned_tasks: TunedTasks | None = None

    def watch(self, words: str, steps: int) -> None:
        """Tell of steps that are done."""
        self._begun = max(0, self._begun - steps)
        self._told(words, steps, self._begun)

    def screenings(
        self, fit: Fit, hypotheses: Sequence[Hypothesis], *, shapes: Sequence[FloatArray] | None = None
    ) -> list[Screened]:
        """Every hypothesis added to a fitted model, in their order. shapes: where each begins, see
        `screen`."""
        return self.screenings_beside([(fit, hypotheses)], shapes=shapes)[0]

    def screenings_beside(
        self,
        fits: Sequence[tuple[Fit, Sequence[Hypothesis]]],
        *,
        shapes: Sequence[FloatArray] | None = None,
    ) -> list[list[Screened]]:
        """Hypotheses added to each of several fitted models, all at once. shapes: of all in their order."""
        wanted = [(k, h) for k, (_, hypotheses) in enumerate(fits) for h in hypotheses]
        begun: Sequence[FloatArray | None] = shapes or [None] * len(wanted)
        bases = [fingerprint(fit.model) for fit, hypotheses in fits]
        keys = [
            key_of("screen", bases[k], fits[k][0].z, repr(h), np.zeros(0) if shape is None else shape)
            for (k, h), shape in zip(wanted, begun, strict=True)
        ]
        self._begun += len(wanted)
        out: dict[int, Screened] = {}
        for i, (key, (_, h)) in enumerate(zip(keys, wanted, strict=True)):
            known = self._cache.get(key)
            if known is not None:
                out[i] = screening_of_arrays(h, known)
        if out:
            self.watch("screening effects", len(out))
        groups = self._groups([i for i in range(len(wanted)) if i not in out], wanted)
        tasks = [(fits[wanted[g[0]][0]][0], [(wanted[i][1], begun[i]) for i in g]) for g in groups]
        for at, results in self._run(_screen_many, tasks):
            for i, result in zip(groups[at], results, strict=True):
                self._cache.put(keys[i], screening_arrays(result))
                out[i] = result
            self.watch("screening effects", len(groups[at]))
        places = iter(range(len(wanted)))
        return [[out[next(places)] for _ in hypotheses] for _, hypotheses in fits]

    def _groups(self, missing: Sequence[int], wanted: Sequence[tuple[int, Hypothesis]]) -> list[list[int]]:
        """Tasks of one model each, an even share of what is missing for each worker some times over.

        The long ones first, or one worker ends alone.
        """
        out: list[list[int]] = []
        for k in dict.fromkeys(wanted[i][0] for i in missing):
            own = sorted((i for i in missing if wanted[i][0] == k), key=lambda i: -effort(wanted[i][1]))
            share = CHUNKS * self._workers * len(own) / len(missing)
            parts = max(1, min(len(own), round(share)))
            out += [own[j::parts] for j in range(parts)]
        return out

    def fits(
        self,
        starts: Sequence[FitStart],
        what: str,
        *,
        derivatives: Callable[[Fit], bool] = lambda _: True,
        enough: Callable[[Fit | None], bool] | None = None,
    ) -> list[Fit | None]:
        """Fits from several starts, None where one has no equilibrium.

        They are of the very models of `starts`, wherever they were computed: whether two fits are to the same
        errors is asked by identity. derivatives: whether a fit keeps its own, see `Fit.without_derivatives`.
        enough: whether the fit from the first start will do; then that alone is given. It is done before the
        others are begun: they take up workers longer than it does. Those are given up where they promise to
        end further above it than a free shape may cost.
        """
        if enough is not None:
            first = self.fits(starts[:1], what, derivatives=derivatives)
            others = [] if enough(first[0]) else starts[1:]
            if first[0] is not None:
                others = [_no_worse(s, first[0]) for s in others]
            return first + self.fits(others, what, derivatives=derivatives)
        keys = [_fit_key(start) for start in starts]
        self._begun += len(starts)
        out: dict[int, Fit | None] = {}

        def unpacked(i: int, arrays: Arrays) -> None:
            refit = fit_of_arrays(starts[i].model, arrays)
            out[i] = refit if refit is None or derivatives(refit) else refit.without_derivatives

        for i, key in enumerate(keys):
            arrays = self._cache.get(key)
            if arrays is not None:
                unpacked(i, arrays)
        if out:
            self.watch(what, len(out))
        missing = [i for i in range(len(starts)) if i not in out]
        missing.sort(key=lambda i: -starts[i].z.size)  # the long ones first, or one worker ends alone
        threads = self._workers if len(missing) == 1 else 1  # a task that is alone has every core
        tasks = (
            (s.model, s.z, known_columns(s.near, s.model), s.ceiling, threads)
            for s in (starts[i] for i in missing)
        )
        for at, result in self._run(_fit_one, tasks):
            self._cache.put(keys[missing[at]], result)
            unpacked(missing[at], result)
            self.watch(what, 1)
        return [out[i] for i in range(len(starts))]

    def residuals(self, points: Sequence[tuple[EffectModel, FloatArray]]) -> list[FloatArray | None]:
        """(M,) residual of each model at its point, None where it has no equilibrium."""
        self._begun += len(points)
        out: list[FloatArray | None] = [None] * len(points)
        for at, residual in self._run(_residual, points):
            out[at] = residual
            self.watch("solving", 1)
        return out

    def defer(self, tuned: Fit) -> None:
        """Have what a verdict takes of the re-tuned axle done where workers would be without work."""
        self._tuned_tasks = TunedTasks.of(tuned, self._executor)

    def held_out(
        self, tuned: Fit, with_effects: Fit, with_discrepancy: Fit
    ) -> Callable[[], tuple[HeldOut, ...]]:
        """Begins to predict every load case of the records from the others, see `held_out_scores`; what is
        returned waits for it."""
        cases = tuned.model.cases
        parts = min(len(cases), self._workers)  # each is sent two fits, of some 30 MB together
        with_effect = [
            self._executor.submit(_held_out_scores, with_effects, with_discrepancy, cases[k::parts])
            for k in range(parts)
        ]
        without = {case: task.begin() for case, task in self._of_tuned(tuned).held_out.items()}

        def waited() -> tuple[HeldOut, ...]:
            self._begun += len(cases)
            scores: dict[str, tuple[HeldOutScore, HeldOutScore]] = {}
            for future in as_completed(with_effect):
                scores |= future.result()
                self.watch("load cases held out", len(future.result()))
            return tuple(HeldOut(case, without[case].result(), *scores[case]) for case in cases)

        return waited

    def scan(self, tuned: Fit) -> Callable[[], list[tuple[Place, float]] | None]:
        """Begins the generic scan at a model, see `scanned_places`; what is returned waits for it.

        None when its axle has no equilibrium with the instruments in.
        """
        future = self._of_tuned(tuned).scan.begin()
        self._begun += 1

        def waited() -> list[tuple[Place, float]] | None:
            result = future.result()
            self.watch("scanning every interface", 1)
            return result

        return waited

    def _of_tuned(self, tuned: Fit) -> TunedTasks:
        known = self._tuned_tasks
        if known is None or known.tuned is not tuned:
            known = self._tuned_tasks = TunedTasks.of(tuned, self._executor)
        return known

    def _run(self, task: Callable[..., T], arguments: Iterable[tuple[Any, ...]]) -> Iterator[tuple[int, T]]:
        """(place, result) of every task as it is done; in this process one is done before the next begins.

        No more are begun ahead than keep every worker busy: what they are given is large. Beside a single
        task the other workers begin deferred ones: beside several those would hold up what comes next.
        """
        if isinstance(self._executor, InProcess):
            for i, call in enumerate(arguments):
                yield i, task(*call)
            return
        following = enumerate(arguments)
        begun: dict[Future[T], int] = {}
        for i, call in islice(following, TASKS_AHEAD * self._workers):
            begun[self._executor.submit(task, *call)] = i
        alone = len(begun) == 1
        while begun:
            deferred = self._begin_deferred() if alone else set()
            for future in wait({*begun, *deferred}, return_when=FIRST_COMPLETED).done - deferred:
                place = begun.pop(future)
                for i, call in islice(following, 1):
                    begun[self._executor.submit(task, *call)] = i
                yield place, future.result()

    def _begin_deferred(self) -> set[Future[Any]]:
        """Deferred tasks that are under way, on all workers but one."""
        known = self._tuned_tasks
        return set() if known is None else begin_some(known.tasks, self._workers - 1)


def _screen_many(fit: Fit, starts: Sequence[tuple[Hypothesis, FloatArray | None]]) -> list[Screened]:
    return [screen(fit, h, shape) for h, shape in starts]


def _held_out_scores(
    with_effects: Fit, with_discrepancy: Fit, cases: Sequence[str]
) -> dict[str, tuple[HeldOutScore, HeldOutScore]]:
    return {case: held_out_scores(with_effects, with_discrepancy, case) for case in cases}


def _residual(model: EffectModel, z: FloatArray) -> FloatArray | None:
    try:
        return model.residual(z)
    except NotConverged:
        return None


def _no_worse(start: FitStart, first: Fit) -> FitStart:
    """Given up where it promises to cost more than the first fit by what a free shape may cost."""
    return replace(start, ceiling=min(start.ceiling, first.cost + 2.0 * FREE_SHAPE_LOSS))


def _fit_key(start: FitStart) -> str:
    limit = [] if np.isinf(start.ceiling) else [np.array(start.ceiling)]
    return key_of("fit", fingerprint(start.model), start.z, *limit)


def _fit_one(
    model: EffectModel, start: FloatArray, known: FloatArray, ceiling: float, threads: int
) -> Arrays:
    model.solutions.threads = threads
    try:
        return fit_arrays(fit(model, start, known=known, ceiling=ceiling))
    except NotConverged:
        return fit_arrays(None)
