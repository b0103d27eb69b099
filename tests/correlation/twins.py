"""Synthetic outside models with a twin: the twin's map lacks what the outside model's has."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.problem import Problem
from doe_kc.correlation.twin import Twin
from doe_kc.ground.typing import FloatArray
from doe_kc.true_solver.outcome import Outcome, failure
from doe_kc.variables import Space
from tests.correlation.synthetic import COUNT, Map, Synthetic, answer, synthetic


@dataclass(frozen=True, kw_only=True)
class OutsideModel(Synthetic):
    """Its slopes are those of the twin."""

    def linearize(self, point: FloatArray) -> Linearization:
        return Problem.linearize(self, point)


@dataclass(frozen=True)
class MapTwin(Twin):
    """of: a problem whose map is the twin's. fails: whether it has no answer."""

    of: Synthetic | None = None
    fails: bool = False

    def answer(self, space: Space, point: FloatArray) -> Outcome:
        assert self.of is not None
        return failure("no equilibrium") if self.fails else answer(self.of, point)

    def linearize(self, space: Space, point: FloatArray) -> Linearization:
        assert self.of is not None
        return self.of.linearize(point)


def with_twin(known: Map, *, base: Synthetic | None = None, fails: bool = False) -> OutsideModel:
    """The synthetic problem as an outside model whose twin answers by `known`."""
    real = base or synthetic()
    own = replace(real, map=known)
    fields = {name: getattr(real, name) for name in Synthetic.__dataclass_fields__}
    fields |= {"exact": False, "twin": MapTwin(real.axle, of=own, fails=fails)}
    return OutsideModel(**fields)


def lacking(known: Map, *, size: float = 0.3, seed: int = 9) -> Map:
    """The map less a constant and a tenth of its slopes in part of the outputs: what effects do."""
    rng = np.random.default_rng(seed)
    some = rng.random(known.value.size) < 0.3
    shift = size * np.abs(known.value) * some
    shift[COUNT:] = 0.0
    return replace(known, value=known.value - shift, slope=known.slope * np.where(some, 0.9, 1.0)[:, None])


def unrelated(known: Map, seed: int = 4) -> Map:
    """Values of the map with slopes that have nothing to do with it."""
    rng = np.random.default_rng(seed)
    return replace(known, slope=known.slope[:, rng.permutation(known.slope.shape[1])] * -1.0)
