"""Clutter: traces of every effect that is not in the model, further Gaussian unknowns of a fit.

Every car has a little of each. Without them what they do to the records would pass for another effect, or
shift the sizes of those in the model. With the slab prior of a member's sizes this is a spike and slab
(T. J. Mitchell, J. J. Beauchamp, Journal of the American Statistical Association 83, 1988): the errors of all
sets of effects are the same but for the members themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from doe_kc.correlation.likelihood import Likelihood, rewhitened
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Clutter:
    """Traces, linear about the re-tuned axle."""

    names: tuple[str, ...]
    """(k,) the hypothesis of each."""
    columns: FloatArray
    """(M, k) change of the residual by each, per its standard deviation."""

    @cached_property
    def _own(self) -> dict[str, list[int]]:
        out: dict[str, list[int]] = {}
        for i, name in enumerate(self.names):
            out.setdefault(name, []).append(i)
        return out

    def beside(self, members: Sequence[Hypothesis]) -> FloatArray:
        """(M, k) the columns, those of effects in the model nothing."""
        own = [i for h in members for i in self._own.get(h.name, ())]
        if not own:
            return self.columns
        columns = self.columns.copy()
        columns[:, own] = 0.0
        return columns

    def rewhitened(self, before: Likelihood, after: Likelihood) -> Clutter:
        """The same in units of other errors of the same records."""
        return replace(self, columns=rewhitened(self.columns, before, after))


def joined(sides: FloatArray | None, clutter: FloatArray | None) -> FloatArray | None:
    """(M, k) all nuisances that are linear, None without any."""
    there = [columns for columns in (sides, clutter) if columns is not None]
    return np.hstack(there) if there else None
