"""Chooses a model for every output by cross-validation, and joins the chosen ones to one surrogate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, LeftOut

ERROR_MARGIN = 0.1
"""Share by which the left-out squared error may exceed the best model's for the sake of simplicity."""
EXACT = 1e-6
"""1 - Q2 below which a model counts as exact, and the simplest such model is taken: a thousandth of the
spread, less than any rig resolves."""


def choose(q2: Mapping[str, FloatArray], complexity: Mapping[str, int]) -> tuple[str, ...]:
    """Model id of each output (m): the simplest whose squared error is within the margin of the best, or
    whose 1 - Q2 is at most EXACT.

    The error is the geometric mean of the output's own 1 - Q2 and of the model's over all outputs: some
    dozens of left-out designs of one output alone take a worse model for the better one in every fourth case
    (50 designs: error 0.085 instead of 0.089). q2: model -> (m,). Where no model has a Q2 (an output that
    does not vary), the simplest.
    """
    order = sorted(q2, key=lambda name: complexity[name])
    missed = np.array([np.nan_to_num(1.0 - q2[name], nan=0.0) for name in order])
    logarithm = np.log(np.maximum(missed, EXACT))
    score = 0.5 * (logarithm + logarithm.mean(axis=1, keepdims=True))
    allowed = (score <= score.min(axis=0) + np.log1p(ERROR_MARGIN)) | (missed <= EXACT)
    return tuple(order[int(k)] for k in np.argmax(allowed, axis=0))


@final
@dataclass(frozen=True)
class Chosen(Fitted):
    """parts: fitted models, each of its own outputs. part: (m,) which of them predicts each output."""

    parts: tuple[Fitted, ...]
    part: np.ndarray

    @property
    def variables(self) -> int:
        """d."""
        return self.parts[0].variables

    @property
    def outputs(self) -> int:
        """m."""
        return len(self.part)

    def of(self, outputs: np.ndarray) -> Fitted:
        """See `Fitted.of`."""
        places = [np.flatnonzero(self.part == k) for k in range(len(self.parts))]
        own = [np.searchsorted(places[k], outputs[self.part[outputs] == k]) for k in range(len(self.parts))]
        used = [k for k, some in enumerate(own) if some.size]
        if len(used) == 1:
            return self.parts[used[0]].of(own[used[0]])
        parts = tuple(self.parts[k].of(own[k]) for k in used)
        return Chosen(parts, np.searchsorted(used, self.part[outputs]))

    def cross_validate(self) -> LeftOut:
        """Of each output's own model."""
        held = [p.cross_validate() for p in self.parts]
        return LeftOut(self._pick([h.residual for h in held]), self._pick([h.variance for h in held]))

    def _pick(self, values: Sequence[FloatArray]) -> FloatArray:
        """(p, m, ...) of the outputs of every part."""
        out = np.empty((len(values[0]), self.outputs, *values[0].shape[2:]))
        for k, value in enumerate(values):
            out[:, self.part == k] = value
        return out

    def _mean(self, x: FloatArray) -> FloatArray:
        return self._pick([p.predict(x) for p in self.parts])

    def _variance(self, x: FloatArray) -> FloatArray:
        return self._pick([p.variance(x) for p in self.parts])

    def _gradient(self, x: FloatArray) -> FloatArray:
        return self._pick([p.gradient(x) for p in self.parts])

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        return self._pick([p.variance_gradient(x) for p in self.parts])


def join(models: Mapping[str, Fitted], names: Sequence[str]) -> Fitted:
    """One surrogate of the model named for each output; only those in use are kept, each for its outputs."""
    used = list(dict.fromkeys(names))
    if len(used) == 1:
        return models[used[0]]
    part = np.array([used.index(name) for name in names])
    return Chosen(tuple(models[n].of(np.flatnonzero(part == k)) for k, n in enumerate(used)), part)
