"""An axle with effects of unknown size: its residuals against the records, and their derivatives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import with_values
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.correlation.linearization import linearized_curves
from doe_kc.curves import CurveSet
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.linear_nuisances import LinearNuisances
from doe_kc.discovery.nuisances import calibrated
from doe_kc.discovery.screening.contrasts import Contrasts, contrasts
from doe_kc.discovery.solutions import Solutions
from doe_kc.discovery.thresholds import (
    AMPLITUDE_LIMIT,
    AMPLITUDE_STEP,
    DIRECTION_STEP,
    INPUT_GAIN,
    NUISANCE_LIMIT,
)
from doe_kc.effects import EFFECTS, apply_effect
from doe_kc.effects._base import observed, reading_gains
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.fields_only import FieldsOnly
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import scaled_gradients
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.result import NotConverged
from doe_kc.variables import Space

NO_CHARACTERISTICS = np.zeros(0)


@dataclass(frozen=True)
class EffectModel(FieldsOnly):
    """An axle with effects of unknown size against the records of one car, or of the mean of several.

    A point is z = (u, b, a), (d + m,): places of the parameters, nuisances (calibrations of the rig's inputs,
    then differences between the sides and traces of absent effects, which are linear), d together, then m
    amplitudes of all members' sizes. The priors of b and a are Gaussian with standard deviation 1, that of an
    amplitude cut at zero where it cannot be negative.
    """

    axle: Axle
    """The nominal axle, without the members."""
    space: Space
    """Tunable parameters with their bounds and priors."""
    likelihood: Likelihood
    """The records as data with their errors."""
    members: tuple[Hypothesis, ...] = ()
    """Effects in the model."""
    left_out: str | None = None
    """Load case whose records are held back from fits, None for none."""
    nuisances: LinearNuisances | None = None
    """Differences between the sides and traces of all effects, of which those of absent ones count; None
    before they are known."""
    scatter: float = 1.0
    """Standard deviation of parameters and of differences between the sides before the records, over that of
    one car: less of the mean of several."""
    solutions: Solutions = field(default_factory=Solutions, compare=False, repr=False)
    """Solver of its axles, the same for all models that come of one another."""

    @cached_property
    def used(self) -> NDArray[np.bool_]:
        """(M,) rows of the data that fits look at: all but those of the load case left out."""
        out = np.ones(self.likelihood.size, dtype=bool)
        for curve, place in self.likelihood.slices():
            out[place] = curve.load_case != self.left_out
        return out

    @cached_property
    def contrasts(self) -> Contrasts:
        """Contrasts of the data."""
        return contrasts(self.likelihood)

    @cached_property
    def sizes(self) -> tuple[Size, ...]:
        """(m,) sizes of all members, in order."""
        return tuple(s for h in self.members for s in h.sizes)

    @cached_property
    def cases(self) -> tuple[str, ...]:
        """(k,) load cases of the records, whose inputs' calibrations are the first nuisances."""
        return tuple(dict.fromkeys(c.load_case for c in self.likelihood.curves))

    @property
    def calibrations(self) -> slice:
        """Places of the calibrations in z."""
        return slice(self.space.dimension, self.space.dimension + len(self.cases))

    @property
    def traces(self) -> slice:
        """Places of the traces of absent effects in z."""
        count = 0 if self.nuisances is None else len(self.nuisances.traces)
        return slice(self.dimension - count, self.dimension)

    @property
    def parameters(self) -> int:
        """Number of tunable parameters of the axle."""
        return self.space.dimension

    @property
    def dimension(self) -> int:
        """d, parameters and nuisances: all that tuning may move."""
        linear = 0 if self.nuisances is None else self.nuisances.count
        return self.space.dimension + len(self.cases) + linear

    @property
    def linear(self) -> slice:
        """Places of the linear nuisances in z."""
        return slice(self.calibrations.stop, self.dimension)

    @cached_property
    def weights(self) -> FloatArray:
        """(l,) factor of each linear nuisance: none of the trace of a member."""
        return np.zeros(0) if self.nuisances is None else self.nuisances.weights(self.members)

    @cached_property
    def prior_sd(self) -> FloatArray:
        """(d + m,) standard deviations before the measurement."""
        others = self.dimension - self.parameters + len(self.sizes)
        return np.concatenate([self.scatter * self.space.prior_sd, np.ones(others)])

    @cached_property
    def centre(self) -> FloatArray:
        """(d + m,) the axle as it is in the file, the rig as it says."""
        others = self.dimension - self.parameters + len(self.sizes)
        return np.concatenate([self.space.start, np.zeros(others)])

    @cached_property
    def lower(self) -> FloatArray:
        """(d + m,) lower bounds."""
        free = [-AMPLITUDE_LIMIT * s.most if s.signed or s.shape else 0.0 for s in self.sizes]
        rig = np.full(self.dimension - self.parameters, -NUISANCE_LIMIT)
        return np.concatenate([np.zeros(self.parameters), rig, free])

    @cached_property
    def upper(self) -> FloatArray:
        """(d + m,) upper bounds."""
        rig = np.full(self.dimension - self.parameters, NUISANCE_LIMIT)
        return np.concatenate([np.ones(self.parameters), rig, [AMPLITUDE_LIMIT * s.most for s in self.sizes]])

    def extended(self, hypothesis: Hypothesis) -> EffectModel:
        """The model with one more effect."""
        return replace(self, members=(*self.members, hypothesis))

    def without(self, hypothesis: Hypothesis) -> EffectModel:
        """The model with one effect less."""
        return replace(self, members=tuple(h for h in self.members if h != hypothesis))

    def with_member(self, member: Hypothesis, other: Hypothesis) -> EffectModel:
        """The model with another hypothesis in a member's place."""
        return replace(self, members=tuple(other if h == member else h for h in self.members))

    def with_likelihood(self, likelihood: Likelihood) -> EffectModel:
        """The model against the same records with other errors."""
        known = self.nuisances
        after = None if known is None else known.rewhitened(self.likelihood, likelihood)
        return replace(self, likelihood=likelihood, nuisances=after)

    def places(self) -> Iterator[tuple[Hypothesis, slice]]:
        """Each member with the places of its amplitudes in z."""
        at = self.dimension
        for h in self.members:
            yield h, slice(at, at + len(h.sizes))
            at += len(h.sizes)

    def with_effects(self, z: FloatArray) -> Axle:
        """The nominal axle with the members at their amplitudes."""
        axle = self.axle
        for h in self.members:
            axle = apply_effect(axle, h.effect, h.options(self.sizes_at(z, h)), source=h.name)
        return axle

    def sizes_at(self, z: FloatArray, hypothesis: Hypothesis) -> dict[str, float]:
        """Amplitudes of a member by `Size.name`."""
        place = next(p for h, p in self.places() if h == hypothesis)
        return {s.name: float(a) for s, a in zip(hypothesis.sizes, z[place], strict=True)}

    def axle_at(self, z: FloatArray) -> Axle:
        """The axle at a point, its load cases driven as the rig says."""
        return with_values(self.with_effects(z), self.space.values(z[: self.parameters]))

    def curves(self, z: FloatArray) -> CurveSet:
        """What the rig would read; NotConverged when the axle has no equilibrium."""
        return self._read(self.axle_at(z), z)

    def _read(self, axle: Axle, z: FloatArray) -> CurveSet:
        driven = self._driven(axle, z)
        return observed(driven, curve_set(self.solutions(driven)))

    def _driven(self, axle: Axle, z: FloatArray) -> Axle:
        return calibrated(axle, self.cases, z[self.calibrations])

    def residual(self, z: FloatArray) -> FloatArray:
        """(M,) in standard deviations of the data."""
        return self.residual_of(self.axle_at(z), z)

    def residual_of(self, axle: Axle, z: FloatArray) -> FloatArray:
        """(M,) of any axle, the nuisances as at z."""
        residual = self.likelihood.residual(self._read(axle, z), NO_CHARACTERISTICS)
        if self.nuisances is None:
            return residual
        return np.asarray(residual + self.nuisances.moved(self.weights * z[self.linear]))

    def jacobian(self, own: FloatArray) -> Jacobian:
        """Of derivatives (M, p + m) to parameters, calibrations and amplitudes, and the linear nuisances."""
        if self.nuisances is None:
            return Jacobian(own)
        return Jacobian(own, self.calibrations.stop, self.nuisances, self.weights)

    def own_columns(self, z: FloatArray, residual: FloatArray) -> FloatArray:
        """(M, p + m) derivative of the residual to parameters, calibrations and amplitudes. residual: at z.

        Exact to parameters and calibrations, and to amplitudes that move nothing but numbers of the axle.
        """
        sound = self.axle_at(z)
        axle, moves = self._driven(sound, z), self._directions(z, sound)
        gradients = linearized_curves(
            axle,
            self.solutions(axle),
            self.space,
            z[: self.parameters],
            {str(i): m for i, m in moves.items()},
            "input gain",
        )
        gradients = scaled_gradients(gradients, reading_gains(axle))
        exact = self.likelihood.jacobian(gradients, np.zeros((0, len(gradients.paths))))
        out = np.zeros((residual.size, z.size - self.linear.stop + self.linear.start))
        out[:, : self.parameters] = exact[:, : self.parameters]
        self._set_calibration_columns(out, exact[:, -1], sound)
        amplitudes = out[:, self.calibrations.stop :]
        known = np.array(list(moves), dtype=int) - self.dimension
        amplitudes[:, known] = exact[:, self.parameters : -1]
        others = np.delete(np.arange(amplitudes.shape[1]), known)
        amplitudes[:, others] = self.amplitude_columns(z, residual, self.dimension + others)
        return out

    def _directions(self, z: FloatArray, here: Axle) -> dict[int, dict[str, float]]:
        """Place in z of an amplitude -> what it changes the internal values of the axle at z, `here`, by.

        Without those that change anything else, its equations or what the rig reads, and those so small that
        they stand for none: their derivatives are differences.
        """
        out: dict[int, dict[str, float]] = {}
        in_car = ((h, p) for h, p in self.places() if not EFFECTS[h.effect].on_rig)
        for i in (i for _, place in in_car for i in range(place.start, place.stop)):
            moved = z.copy()
            moved[i] += DIRECTION_STEP
            there = self.axle_at(moved)
            change = {
                name: (value - here.values[name]) / DIRECTION_STEP
                for name, value in there.values.items()
                if value != here.values.get(name)
            }
            same = there.topology == here.topology and there.load_cases == here.load_cases
            if same and change and there.values.keys() == here.values.keys():
                out[i] = change
        return out

    def _set_calibration_columns(self, columns: FloatArray, to_gain: FloatArray, sound: Axle) -> None:
        """Set those of the columns (M, p + m) that are derivatives to the calibrations, each of which moves
        its own load case alone. to_gain: (M,) to the gain of each curve's load case. sound: the axle with its
        inputs as yet not calibrated."""
        for curve, place in self.likelihood.slices():
            at = self.calibrations.start + self.cases.index(curve.load_case)
            columns[place, at] = INPUT_GAIN * sound.load_cases[curve.load_case].gain * to_gain[place]

    def amplitude_columns(
        self, z: FloatArray, residual: FloatArray, places: Iterable[int] | None = None
    ) -> FloatArray:
        """(M, k) derivative to amplitudes by differences. residual: at z. places: (k,) in z, default all."""
        columns = []
        for i in range(self.dimension, z.size) if places is None else places:
            step = AMPLITUDE_STEP if z[i] + AMPLITUDE_STEP <= self.upper[i] else -AMPLITUDE_STEP
            columns.append(self._difference(z, residual, np.eye(z.size)[i], step))
        return np.array(columns).T.reshape(residual.size, -1)

    def _difference(
        self, z: FloatArray, residual: FloatArray, direction: FloatArray, step: float
    ) -> FloatArray:
        """(M,) derivative along a direction, from one step; from one the other way where the axle has no
        equilibrium there, as at the end of its steering lock. NotConverged where it has none on that side
        either, or may not go there."""
        try:
            return np.asarray((self.residual(z + step * direction) - residual) / step)
        except NotConverged:
            back = z - step * direction
            if np.any((back < self.lower) | (back > self.upper)):
                raise
        return np.asarray((residual - self.residual(back)) / step)
