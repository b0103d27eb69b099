"""Nuisances whose columns are the same at every point of a fit: differences between the sides, and traces.

Traces of every effect that is not in the model are further Gaussian unknowns of a fit. Every car has a
little of each. Without them what they do to the records would pass for another effect, or shift the
sizes of those in the model. With the slab prior of a member's sizes this is a spike and slab (T. J.
Mitchell, J. J. Beauchamp, Journal of the American Statistical Association 83, 1988): the errors of all sets
of effects are the same but for the members themselves.

Their means are zero, but for what every car is known to have: that is exponential before the records, which
assumes least of a size that cannot be negative (E. T. Jaynes, Physical Review 106, 1957), so that the mean
is the standard deviation. About zero, a steering friction was told 1 % too small, as the mount of every
rack yields: 58 of 75 were below the truth. For all compliances together means are too much, as many stand
for the same: a tyre of 89.7 N/mm became 101.6 ± 4.1 in place of 96.0 ± 3.7, and free plays 3 % less.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from doe_kc.correlation.likelihood import Rewhitening
from doe_kc.discovery.thresholds import TRACE_SD
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.fields_only import CommonArgument
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Trace:
    """One size of an effect, of which every car has a little."""

    hypothesis: Hypothesis
    """The effect in its place."""
    place: int
    """Place of the size among `hypothesis.sizes`."""

    @property
    def size(self) -> Size:
        """The size."""
        return self.hypothesis.sizes[self.place]


def trace_mean(size: Size) -> float:
    """Mean amplitude of its trace before the records, in typical sizes."""
    return TRACE_SD if size.present else 0.0


@dataclass(frozen=True)
class LinearNuisances(CommonArgument):
    """Their columns, of the sides about the axle with the set's effects, of traces about the re-tuned one, in
    the end those of compliances and of sizes of either sign about the axle with the set's effects too, for
    the sizes also those of frictions."""

    columns: FloatArray
    """(M, l) change of the residual by each, per its standard deviation; differences between the sides first,
    then traces."""
    traces: tuple[Trace, ...] = ()
    """What each of the last columns is the trace of."""
    _last: dict[bytes, FloatArray] = field(default_factory=dict, init=False, compare=False, repr=False)
    """Amounts last asked for -> their change: screenings vary nothing but the sizes of an effect."""

    @property
    def count(self) -> int:
        """l, the number of columns."""
        return int(self.columns.shape[1])

    @property
    def sides(self) -> int:
        """Number of the columns that are differences between the sides; none where those are not known."""
        return self.count - len(self.traces)

    @cached_property
    def centre(self) -> FloatArray:
        """(l,) means before the records, in standard deviations."""
        out = np.zeros(self.count)
        out[self.sides :] = [trace_mean(t.size) / TRACE_SD for t in self.traces]
        return out

    @cached_property
    def gram(self) -> FloatArray:
        """(l, l) inner products of the columns."""
        return np.asarray(self.columns.T @ self.columns)

    @cached_property
    def digest(self) -> bytes:
        """SHA-256 of the columns."""
        return hashlib.sha256(np.ascontiguousarray(self.columns).data).digest()

    def moved(self, amounts: FloatArray) -> FloatArray:
        """(M,) change of the residual by amounts (l,), in standard deviations."""
        key = amounts.tobytes()
        if key not in self._last:
            self._last.clear()
            self._last[key] = np.asarray(self.columns @ amounts)
        return self._last[key]

    def weights(self, members: Sequence[Hypothesis]) -> FloatArray:
        """(l,) 1 for a column that counts, 0 for the trace of an effect in the model."""
        names = {h.name for h in members}
        out = np.ones(self.count)
        out[self.sides :] = [t.hypothesis.name not in names for t in self.traces]
        return out

    def with_traces(self, traces: Sequence[Trace], columns: FloatArray) -> LinearNuisances:
        """The same and further traces (M, k)."""
        return LinearNuisances(np.hstack([self.columns, columns]), (*self.traces, *traces))

    def with_sides(self, columns: FloatArray) -> LinearNuisances:
        """The same with other columns (M, k) of the differences between the sides."""
        traces = self.columns[:, self.sides :]
        return LinearNuisances(np.hstack([columns, traces]), self.traces)

    @property
    def names_only(self) -> LinearNuisances:
        """The same nuisances without their columns: how many there are, and of what."""
        return replace(self, columns=self.columns[:0].copy())

    def rewhitened(self, units: Rewhitening) -> LinearNuisances:
        """The same in units of other errors of the same records."""
        return replace(self, columns=units(self.columns))
