"""What the model answers to the sliders, and the slopes of that answer."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.topology import Topology
from doe_kc.correlation.linearization import Linearization, linearize
from doe_kc.curves import CurveSet
from doe_kc.effects import observed
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.live.model import LiveModel
from doe_kc.live.outside_model import half_track_of
from doe_kc.solver.compiled import AdaptiveKernel
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import library_for, solve
from doe_kc.targets import Rating, rate, score
from doe_kc.true_solver.outcome import Outcome, from_curves


@dataclass(frozen=True)
class LiveAnswer:
    """Of one design. point: (d,) its place in the model's space, which the sliders may leave.

    axle, solution: of the true model; of an outside solver those of the package's own, whose shape is drawn.
    base: the twin's answer that a surrogate's is on top of. characteristics: (all registered,). residual:
    (M,) whitened, empty without data. rating: None without targets. seconds: wall time. true: whether the
    true model gave it, not a surrogate.
    """

    model: LiveModel
    axle: Axle
    values: Mapping[str, float]
    point: FloatArray
    solution: Solution
    base: Outcome | None
    curves: CurveSet
    characteristics: FloatArray
    residual: FloatArray
    rating: Rating | None
    seconds: float
    true: bool = True

    @property
    def gap(self) -> float:
        """Root of the mean squared residual, in standard deviations of the data; nan without data."""
        return math.sqrt(float(np.mean(self.residual**2))) if self.residual.size else math.nan


COMPILE_SHARE = 0.25
"""Of what a kernel does before it compiles by itself: early, so that no answer waits for a compiler."""


class Compilation:
    """Which topologies run in compiled code: a new one runs in Python until a thread has made its programs.

    One that is asked for often is compiled by a thread, while its programs go on.
    """

    def __init__(self) -> None:
        self._ready: set[Topology] = set()
        self._begun: set[Topology] = set()
        self._compiled: set[Topology] = set()
        self._threads: list[threading.Thread] = []

    def use_now(self, topology: Topology) -> bool | None:
        """The argument `compiled` of `solve` for a topology; begins to prepare one that is new."""
        if topology in self._ready:
            library = library_for(topology, None)
            often = isinstance(library, AdaptiveKernel) and library.share_before_compiling >= COMPILE_SHARE
            if isinstance(library, AdaptiveKernel) and often and topology not in self._compiled:
                self._compiled.add(topology)
                self._begin(library.compile)
            return None
        if topology not in self._begun:
            self._begun.add(topology)
            self._begin(lambda: self.prepare(topology))
        return False

    def _begin(self, work: Callable[[], None]) -> None:
        thread = threading.Thread(target=work, daemon=True)
        self._threads.append(thread)
        thread.start()

    def prepare(self, topology: Topology) -> None:
        """Make the programs now, in this thread."""
        self._begun.add(topology)
        library_for(topology, None)
        self._ready.add(topology)

    def wait(self) -> None:
        """Until nothing is being compiled, so that no compiler outlives the page."""
        for thread in self._threads:
            thread.join()


def solve_live(model: LiveModel, values: Mapping[str, float], compilation: Compilation) -> LiveAnswer | str:
    """The answer to slider values (absolute, those that moved), or why there is none: of the true model, of
    an outside solver that of the surrogate of its stored designs."""
    return _answer(model, values, compilation, None)


def answer_from(
    model: LiveModel, values: Mapping[str, float], compilation: Compilation, outcome: Outcome
) -> LiveAnswer | str:
    """The answer that an outside solver gave; outcome: its curves and characteristics."""
    return outcome.reason or _answer(model, values, compilation, outcome)


def _answer(
    model: LiveModel, values: Mapping[str, float], compilation: Compilation, outside_outcome: Outcome | None
) -> LiveAnswer | str:
    started = time.perf_counter()
    point = model.space.unit({v.path: values.get(v.path, v.start) for v in model.space.variables})
    everything = {**model.space.values(point), **values}
    try:
        axle = model.axle_at(everything)
    except InputError as error:
        return str(error)
    solution = solve(axle, throw=False, compiled=compilation.use_now(axle.topology))
    outside = model.outside
    if solution.failure is not None and outside is not None and (outside_outcome or outside.twin is None):
        axle, solution = model.axle, solve(model.axle, throw=False)  # nothing but a drawing depends on it
    if solution.failure is not None:
        return str(solution.failure)
    outcome = own = from_curves(observed(axle, curve_set(solution)), model.windows, 0.0)
    base = None
    if outside is not None:
        base = None if outside.twin is None else own
        outcome = outside_outcome or outside.outcome(point, half_track_of(outside, everything), base)
    if outcome.failed or outcome.curves is None:
        return outcome.reason
    residual = np.zeros(0)
    if model.likelihood is not None and model.likelihood.size:
        residual = model.likelihood.residual(outcome.curves, outcome.characteristics)
    rating = None
    if model.targets is not None:
        rating = rate(model.targets, score(model.targets, outcome.characteristics, outcome.curves))
    return LiveAnswer(
        model=model,
        axle=axle,
        values=everything,
        point=point,
        solution=solution,
        base=base,
        curves=outcome.curves,
        characteristics=outcome.characteristics,
        residual=residual,
        rating=rating,
        seconds=time.perf_counter() - started if outside_outcome is None else outside_outcome.seconds,
        true=outside is None or outside_outcome is not None,
    )


@dataclass(frozen=True)
class LiveSlopes:
    """Exact first-order change about an answer. expansion: to the places u. jacobian: (M, d) of the residual,
    (0, d) without data.
    """

    answer: LiveAnswer
    expansion: Linearization
    jacobian: FloatArray

    @property
    def per_unit(self) -> FloatArray:
        """(d,) d u / d value: turns derivatives to places into those to values in the parameters' units."""
        return np.asarray(1.0 / self.answer.model.space.slopes(self.answer.point))


def slopes_of(answer: LiveAnswer) -> LiveSlopes:
    """Sensitivities of an answer to all sliders, exact but for those of an outside solver, which are its
    surrogate's; nothing is solved again."""
    model, outside = answer.model, answer.model.outside
    if outside is None:
        expansion = linearize(
            model.axle, model.space, answer.point, model.windows, solve=lambda _: answer.solution
        )
    else:
        half_track = half_track_of(outside, answer.values)
        expansion = outside.expansion(answer.point, half_track, answer.solution, answer.base)
    jacobian = np.zeros((0, model.space.dimension))
    if model.likelihood is not None and model.likelihood.size:
        jacobian = model.likelihood.jacobian(expansion.curves, expansion.characteristics)
    return LiveSlopes(answer, expansion, jacobian)
