"""Where the work of a discovery is done: in worker processes, each result kept in the cache."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, as_completed
from typing import Any, TypeVar

import numpy as np

from doe_kc.campaign.executors import InProcess
from doe_kc.discovery.fit import Fit, FitStart, cost_of, fit, known_columns
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result_cache import Arrays, ResultCache, fingerprint, key_of
from doe_kc.discovery.screening.scan import Scan, scan
from doe_kc.discovery.screening.screen import Screened, effort, screen
from doe_kc.discovery.thresholds import CHUNKS
from doe_kc.discovery.verdict.held_out import HeldOut, held_out
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged

Watch = Callable[[str, int, int], None]
"""Told what has been done, how many steps of the work that were, and how many more are begun."""
T = TypeVar("T")


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

    def watch(self, words: str, steps: int) -> None:
        """Tell of steps that are done."""
        self._begun = max(0, self._begun - steps)
        self._told(words, steps, self._begun)

    def screenings(
        self, fit: Fit, hypotheses: Sequence[Hypothesis], *, shapes: Sequence[FloatArray] | None = None
    ) -> list[Screened]:
        """Every hypothesis added to a fitted model, in their order. shapes: where each begins, see
        `screen`."""
        base = fingerprint(fit.model)
        begun: Sequence[FloatArray | None] = shapes or [None] * len(hypotheses)
        own = [np.zeros(0) if shape is None else shape for shape in begun]
        keys = [
            key_of("screen", base, fit.z, repr(h), shape) for h, shape in zip(hypotheses, own, strict=True)
        ]
        self._begun += len(hypotheses)
        out: dict[int, Screened] = {}
        missing: list[int] = []
        for i, (key, h) in enumerate(zip(keys, hypotheses, strict=True)):
            known = self._cache.get(key)
            if known is None:
                missing.append(i)
            else:
                out[i] = _unpacked(h, known)
        if out:
            self.watch("screening effects", len(out))
        missing.sort(key=lambda i: -effort(hypotheses[i]))  # the long ones first, or one worker ends alone
        parts = max(1, min(len(missing), CHUNKS * self._workers))
        groups = [missing[k::parts] for k in range(parts) if missing[k::parts]]
        tasks = [(fit, [(hypotheses[i], begun[i]) for i in part]) for part in groups]
        for at, results in self._run(_screen_many, tasks):
            part = groups[at]
            for i, result in zip(part, results, strict=True):
                self._cache.put(keys[i], _packed(result))
                out[i] = result
            self.watch("screening effects", len(part))
        return [out[i] for i in range(len(hypotheses))]

    def fits(self, starts: Sequence[FitStart], what: str) -> list[Fit | None]:
        """Fits from several starts, None where one has no equilibrium.

        They are of the very models of `starts`, wherever they were computed: whether two fits are to the same
        errors is asked by identity.
        """
        keys = [_fit_key(start) for start in starts]
        self._begun += len(starts)
        stored = {i: self._cache.get(key) for i, key in enumerate(keys)}
        known: dict[int, Arrays] = {i: arrays for i, arrays in stored.items() if arrays is not None}
        if known:
            self.watch(what, len(known))
        missing = [i for i in range(len(starts)) if i not in known]
        tasks = [
            (s.model, s.z, known_columns(s.near, s.model), s.ceiling) for s in (starts[i] for i in missing)
        ]
        for at, arrays in self._run(_fit_one, tasks):
            i = missing[at]
            known[i] = arrays
            self._cache.put(keys[i], arrays)
            self.watch(what, 1)
        return [_unpacked_fit(start.model, known[i]) for i, start in enumerate(starts)]

    def held_out(self, tuned: Fit, with_effects: Fit, with_discrepancy: Fit) -> tuple[HeldOut, ...]:
        """Every load case of the records, predicted from the others; see `held_out`."""
        cases = list(dict.fromkeys(c.load_case for c in tuned.model.likelihood.curves))
        predictions: dict[int, HeldOut] = {}
        self._begun += len(cases)
        for i, result in self._run(
            held_out, [(tuned, with_effects, with_discrepancy, case) for case in cases]
        ):
            predictions[i] = result
            self.watch("load cases held out", 1)
        return tuple(predictions[i] for i in range(len(cases)))

    def scan(self, tuned: Fit, temper: float) -> Callable[[], Scan | None]:
        """Begins the generic scan at a model; what is returned waits for it.

        None when its axle has no equilibrium with the instruments in.
        """
        future = self._executor.submit(_scan, tuned, temper)
        self._begun += 1

        def waited() -> Scan | None:
            result = future.result()
            self.watch("scanning every interface", 1)
            return result

        return waited

    def _run(self, task: Callable[..., T], arguments: Sequence[tuple[Any, ...]]) -> Iterator[tuple[int, T]]:
        """(place, result) of every task as it is done; in this process one is done before the next begins."""
        if isinstance(self._executor, InProcess):
            for i, call in enumerate(arguments):
                yield i, task(*call)
            return
        futures = {self._executor.submit(task, *call): i for i, call in enumerate(arguments)}
        for future in as_completed(futures):
            yield futures[future], future.result()


def _screen_many(fit: Fit, starts: Sequence[tuple[Hypothesis, FloatArray | None]]) -> list[Screened]:
    return [screen(fit, h, shape) for h, shape in starts]


def _scan(tuned: Fit, temper: float) -> Scan | None:
    try:
        return scan(tuned, temper=temper)
    except NotConverged:
        return None


def _fit_key(start: FitStart) -> str:
    limit = [] if np.isinf(start.ceiling) else [np.array(start.ceiling)]
    return key_of("fit", fingerprint(start.model), start.z, *limit)


def _fit_one(model: EffectModel, start: FloatArray, known: FloatArray, ceiling: float) -> Arrays:
    try:
        return _packed_fit(fit(model, start, known=known, ceiling=ceiling))
    except NotConverged:
        return {"z": np.zeros(0)}


def _packed_fit(fit: Fit) -> Arrays:
    """Without what its model says of it, the derivatives to linear nuisances among that."""
    return {
        "z": fit.z,
        "residual": fit.residual,
        "jacobian": fit.jacobian.own,
        "evaluations": np.array(float(fit.evaluations)),
        "converged": np.array(float(fit.converged)),
    }


def _unpacked_fit(model: EffectModel, known: Arrays) -> Fit | None:
    """The stored fit, None for one without an equilibrium."""
    if not known["z"].size:
        return None
    z, residual = known["z"], known["residual"]
    counts = int(known["evaluations"]), bool(known["converged"])
    return Fit(model, z, residual, model.jacobian(known["jacobian"]), cost_of(model, z, residual), *counts)


def _packed(screening: Screened) -> Arrays:
    return {
        "amplitudes": screening.amplitudes,
        "sd": screening.sd,
        "numbers": np.array([screening.gain, screening.score, screening.detectability, screening.absorbed]),
        "columns": screening.columns,
        "change": screening.change,
        "bend": screening.bend,
        "visible": screening.size_detectability,
        "failed": np.frombuffer(screening.failed.encode(), dtype=np.uint8).astype(float),
    }


def _unpacked(hypothesis: Hypothesis, known: Arrays) -> Screened:
    gain, score, detectability, absorbed = (float(v) for v in known["numbers"])
    return Screened(
        hypothesis,
        known["amplitudes"],
        known["sd"],
        gain,
        score,
        known["columns"],
        known["change"],
        known["bend"],
        detectability,
        absorbed,
        known["visible"],
        bytes(known["failed"].astype(np.uint8)).decode(),
    )
