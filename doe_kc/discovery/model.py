"""An axle with effects of unknown size, and its residuals against the records."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import must_be_positive
from doe_kc.axle.parameters import names_touched, with_values
from doe_kc.correlation.likelihood import Likelihood, Rewhitening
from doe_kc.curves import CurveSet
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.linear_nuisances import LinearNuisances
from doe_kc.discovery.nuisances import calibrated
from doe_kc.discovery.screening.contrasts import Contrasts, contrasts
from doe_kc.discovery.solutions import Solutions
from doe_kc.discovery.thresholds import (
    AMPLITUDE_LIMIT,
    NUISANCE_LIMIT,
)
from doe_kc.effects import apply_effect
from doe_kc.effects._base import observed
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.fields_only import FieldsOnly
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import curve_set
from doe_kc.variables import Space

NO_CHARACTERISTICS = np.zeros(0)


@dataclass(frozen=True)
class EffectModel(FieldsOnly):
    """An axle with effects of unknown size against the records of one car, or of the mean of several.

    A point is z = (u, b, a), (d + m,): places of the parameters, nuisances (calibrations of the rig's inputs,
    then differences between the sides and traces of absent effects, which are linear), d together, then m
    amplitudes of all members' sizes. The priors of b and a are Gaussian about `centre` with standard
    deviation 1, that of an amplitude cut at zero where it cannot be negative.
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
    own_scatter: tuple[float, ...] | None = None
    """(d,) standard deviations of parameters and nuisances as the records show them, over those assumed; None
    for those."""
    widened: float = 1.0
    """Factor by which all ranges of the parameters are wider than those asked for."""
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
        nuisances = np.ones(self.dimension - self.parameters)
        assumed = np.concatenate([self.scatter * self.space.prior_sd, nuisances])
        own = 1.0 if self.own_scatter is None else np.array(self.own_scatter)
        return np.concatenate([own * assumed, np.ones(len(self.sizes))])

    @cached_property
    def centre(self) -> FloatArray:
        """(d + m,) the axle as it is in the file, the rig as it says, traces as they are in the mean."""
        linear = np.zeros(0) if self.nuisances is None else self.nuisances.centre
        calibrations, sizes = np.zeros(len(self.cases)), np.zeros(len(self.sizes))
        return np.concatenate([self.space.start, calibrations, linear, sizes])

    @cached_property
    def lower(self) -> FloatArray:
        """(d + m,) lower bounds."""
        free = [-AMPLITUDE_LIMIT * s.most if s.any_sign else 0.0 for s in self.sizes]
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

    def with_likelihood(self, likelihood: Likelihood, units: Rewhitening | None = None) -> EffectModel:
        """The model against the same records with other errors. units: from its own to those, if known."""
        if self.nuisances is None:
            return replace(self, likelihood=likelihood)
        units = units or Rewhitening(self.likelihood, likelihood)
        return replace(self, likelihood=likelihood, nuisances=self.nuisances.rewhitened(units))

    def places(self) -> Iterator[tuple[Hypothesis, slice]]:
        """Each member with the places of its amplitudes in z."""
        at = self.dimension
        for h in self.members:
            yield h, slice(at, at + len(h.sizes))
            at += len(h.sizes)

    def member(self, name: str) -> Hypothesis:
        """The member of a name, by the law that the model has. KeyError for none."""
        return {h.name: h for h in self.members}[name]

    def place(self, member: Hypothesis) -> slice:
        """Where the amplitudes of a member are in z."""
        return next(place for h, place in self.places() if h == member)

    def with_effects(self, z: FloatArray) -> Axle:
        """The nominal axle with the members at their amplitudes."""
        axle = self.axle
        for h in self.members:
            axle = self._with(axle, h, z)
        return axle

    def _with(self, axle: Axle, member: Hypothesis, z: FloatArray) -> Axle:
        options = member.options(self.sizes_at(z, member))
        return apply_effect(axle, member.effect, options, source=member.name)

    def sizes_at(self, z: FloatArray, hypothesis: Hypothesis) -> dict[str, float]:
        """Amplitudes of a member by `Size.name`."""
        place = self.place(hypothesis)
        return {s.name: float(a) for s, a in zip(hypothesis.sizes, z[place], strict=True)}

    def axle_at(self, z: FloatArray) -> Axle:
        """The axle at a point, its load cases driven as the rig says."""
        extended = self.with_effects(z)
        return with_values(extended, self.values_with(extended, z))

    def values_with(self, extended: Axle, z: FloatArray) -> dict[str, float]:
        """Path -> value at a point that the axle with effects, members or some of them, is set to.

        A plain path is read from the left side. Where an effect changes that, as a bushing that is stiffer on
        the left alone, the parameter is what the left side would have without it: a mount that was 2.29 times
        its nominal stiffness on the left and 1.50 times on the right was cut off at its bound of 2.
        """
        values, ratios = self.space.values(z[: self.parameters]), self.effect_ratios(extended)
        return {path: value * ratios.get(path, 1.0) for path, value in values.items()}

    def effect_ratios(self, extended: Axle) -> dict[str, float]:
        """Path -> its value with effects over the nominal one, of the stiffnesses that they change."""
        known = self.axle.values
        return {
            path: extended.values[left] / known[left]
            for path, left in self._stiffness_paths
            if extended.values[left] != known[left]
        }

    @cached_property
    def _stiffness_paths(self) -> tuple[tuple[str, str], ...]:
        """Every plain path of a stiffness with two sides that the space sets, and its left internal value."""
        paths = [p for p in self.space.values(self.space.start) if must_be_positive(p)]
        return tuple((p, f"{p}@L") for p in paths if f"{p}@L" in self.axle.values)

    def axles_beside(
        self, z: FloatArray, here: Axle, places: Sequence[int], step: float
    ) -> Iterator[tuple[int, Axle]]:
        """Each place of an amplitude, and the axle at z, `here`, with that amplitude larger by a step, see
        `Size.beside`."""
        before, plain = self.axle, self.with_effects(z)
        tuned = names_touched(plain, tuple(self.space.values(z[: self.parameters])))
        members = list(self.places())
        tables = [(h, h.options(self.sizes_at(z, h))) for h, _ in members]
        for k, (member, own) in enumerate(members):
            for i in (i for i in places if own.start <= i < own.stop):
                beside = z.copy()
                beside[i] = member.sizes[i - own.start].beside(float(z[i]), step)
                axle = self._with(before, member, beside)
                for other, options in tables[k + 1 :]:
                    axle = apply_effect(axle, other.effect, options, source=other.name)
                same = axle.topology == plain.topology and axle.load_cases == plain.load_cases
                moved = {n: v for n, v in axle.values.items() if v != plain.values.get(n)}
                if same and axle.values.keys() == plain.values.keys() and tuned.isdisjoint(moved):
                    yield i, here.changed(moved)  # what tuning sets it sets alike
                else:
                    yield i, with_values(axle, self.values_with(axle, z))
            before = self._with(before, member, z)

    def curves(self, z: FloatArray) -> CurveSet:
        """What the rig would read; NotConverged when the axle has no equilibrium."""
        return self._read(self.axle_at(z), z)

    def _read(self, axle: Axle, z: FloatArray) -> CurveSet:
        driven = self.driven(axle, z)
        return observed(driven, curve_set(self.solutions(driven)))

    def driven(self, axle: Axle, z: FloatArray) -> Axle:
        """The axle, its load cases driven by their inputs as calibrated at a point."""
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
