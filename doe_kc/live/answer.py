"""What the true model answers to the sliders, and the exact slopes of that answer."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import with_values
from doe_kc.axle.topology import Topology
from doe_kc.correlation.linearization import Linearization, linearize
from doe_kc.curves import CurveSet
from doe_kc.effects import observed
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.live.model import LiveModel
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import library_for, solve
from doe_kc.targets import Rating, rate, score
from doe_kc.true_solver.outcome import from_curves


@dataclass(frozen=True)
class LiveAnswer:
    """Of one design. point: (d,) its place in the model's space, which the sliders may leave.

    characteristics: (all registered,). residual: (M,) whitened, empty without data. rating: None without
    targets. seconds: wall time.
    """

    model: LiveModel
    axle: Axle
    values: Mapping[str, float]
    point: FloatArray
    solution: Solution
    curves: CurveSet
    characteristics: FloatArray
    residual: FloatArray
    rating: Rating | None
    seconds: float

    @property
    def gap(self) -> float:
        """Root of the mean squared residual, in standard deviations of the data; nan without data."""
        return math.sqrt(float(np.mean(self.residual**2))) if self.residual.size else math.nan


class Compilation:
    """Which topologies run compiled: a new one runs interpreted until a thread has compiled it."""

    def __init__(self) -> None:
        self._ready: set[Topology] = set()
        self._begun: set[Topology] = set()
        self._threads: list[threading.Thread] = []

    def use_now(self, topology: Topology) -> bool | None:
        """The argument `compiled` of `solve` for a topology; begins to compile one that is new."""
        if topology in self._ready:
            return None
        if topology not in self._begun:
            self._begun.add(topology)
            thread = threading.Thread(target=self.compile, args=(topology,), daemon=True)
            self._threads.append(thread)
            thread.start()
        return False

    def compile(self, topology: Topology) -> None:
        """Compile now, in this thread."""
        self._begun.add(topology)
        library_for(topology, None)
        self._ready.add(topology)

    def wait(self) -> None:
        """Until nothing is being compiled, so that no compiler outlives the page."""
        for thread in self._threads:
            thread.join()


def solve_live(model: LiveModel, values: Mapping[str, float], compilation: Compilation) -> LiveAnswer | str:
    """The answer of the true model to slider values (absolute, those that moved), or why there is none."""
    started = time.perf_counter()
    point = model.space.unit({v.path: values.get(v.path, v.start) for v in model.space.variables})
    everything = {**model.space.values(point), **values}
    try:
        axle = with_values(model.axle, everything)
    except InputError as error:
        return str(error)
    solution = solve(axle, throw=False, compiled=compilation.use_now(axle.topology))
    if solution.failure is not None:
        return str(solution.failure)
    outcome = from_curves(observed(axle, curve_set(solution)), model.windows, 0.0)
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
        curves=outcome.curves,
        characteristics=outcome.characteristics,
        residual=residual,
        rating=rating,
        seconds=time.perf_counter() - started,
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
    """Exact sensitivities of an answer to all sliders; nothing is solved again."""
    model = answer.model
    expansion = linearize(
        model.axle, model.space, answer.point, model.windows, solve=lambda _: answer.solution
    )
    jacobian = np.zeros((0, model.space.dimension))
    if model.likelihood is not None and model.likelihood.size:
        jacobian = model.likelihood.jacobian(expansion.curves, expansion.characteristics)
    return LiveSlopes(answer, expansion, jacobian)
