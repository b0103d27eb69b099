"""The result of a tolerance study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from doe_kc.characteristics import Characteristic
from doe_kc.curves import CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.bands import CurveBand
from doe_kc.production_scatter.first_order import FirstOrderScatter
from doe_kc.production_scatter.model import ScatterModel
from doe_kc.production_scatter.requirements import Requirement
from doe_kc.production_scatter.statistics import (
    CarShare,
    Moments,
    car_share,
    moments,
    percentile_of,
)
from doe_kc.production_scatter.tightening import Tightening, outside_table, tightenings
from doe_kc.production_scatter.total_effects import TotalEffects, total_effects

LINEAR_SHARE = 0.95
"""Of the variance: a characteristic is linear over the scatter when its slopes explain as much, car by car.
The two standard deviations say less: that of the sample has an error of 2 % with 1000 cars."""


@dataclass(frozen=True)
class MeasuredCar:
    """values: characteristic id -> measured value, nan where it was not; curves: as measured."""

    name: str
    values: Mapping[str, float]
    curves: CurveSet


@dataclass(frozen=True)
class CharacteristicScatter:
    """One characteristic over the cars, in its unit.

    nominal: of the unchanged axle. first_order_sd: by the slopes. explained: share of the sample's variance
    that the slopes explain, car by car. outside: share of cars beyond the requirement; None without one.
    measured: name of each measured car -> value and percent of the cars below it.
    """

    entry: Characteristic
    nominal: float
    moments: Moments
    first_order_sd: float
    explained: float
    requirement: Requirement | None
    outside: CarShare | None
    measured: Mapping[str, tuple[float, float]]

    @property
    def shift(self) -> float:
        """Mean minus nominal: what curvature adds on average."""
        return self.moments.mean - self.nominal

    @property
    def linear(self) -> bool:
        """Whether first order describes its scatter."""
        return self.explained >= LINEAR_SHARE


@dataclass(frozen=True)
class Tolerance:
    """n cars that were solved, k characteristics, m deviations.

    deviations: (n, m), in units of the parameters. values: (n, k) in units of the characteristics. nominal:
    (k,). failures: reasons of cars without equilibrium. runs: of the true solver; seed: of the deviations.
    """

    model: ScatterModel
    characteristics: tuple[Characteristic, ...]
    nominal: FloatArray
    deviations: FloatArray
    values: FloatArray
    first_order: FirstOrderScatter
    requirements: Mapping[str, Requirement]
    bands: tuple[CurveBand, ...]
    cars: tuple[MeasuredCar, ...]
    failures: tuple[str, ...]
    runs: int
    seed: int
    seconds: float

    @property
    def n(self) -> int:
        """Cars that were solved."""
        return len(self.values)

    @cached_property
    def scatters(self) -> tuple[CharacteristicScatter, ...]:
        """Of every characteristic."""
        return tuple(self._scatter(k, entry) for k, entry in enumerate(self.characteristics))

    def _scatter(self, k: int, entry: Characteristic) -> CharacteristicScatter:
        values, requirement = self.values[:, k], self.requirements.get(entry.id)
        variance = float(values.var())
        rest = values - self.first_order.changes(self.deviations)[:, k]
        outside = None
        if requirement is not None:
            outside = car_share(int(requirement.outside(values).sum()), self.n)
        known = [(c.name, c.values.get(entry.id, np.nan)) for c in self.cars]
        return CharacteristicScatter(
            entry=entry,
            nominal=float(self.nominal[k]),
            moments=moments(values),
            first_order_sd=float(self.first_order.sd[k]),
            explained=1.0 - float(rest.var()) / variance if variance > 0.0 else 1.0,
            requirement=requirement,
            outside=outside,
            measured={name: (v, percentile_of(v, values)) for name, v in known if np.isfinite(v)},
        )

    @cached_property
    def required(self) -> tuple[tuple[int, Requirement], ...]:
        """Column of each characteristic that has a requirement, and that."""
        pairs = ((k, self.requirements.get(c.id)) for k, c in enumerate(self.characteristics))
        return tuple((k, r) for k, r in pairs if r is not None)

    @cached_property
    def any_outside(self) -> CarShare:
        """Cars outside any requirement."""
        return car_share(int(outside_table(self.values, self.required).any(axis=1).sum()), self.n)

    @cached_property
    def missed(self) -> float:
        """Mean number of requirements that a car misses."""
        return float(outside_table(self.values, self.required).sum(axis=1).mean())

    @cached_property
    def first_shares(self) -> FloatArray:
        """(p, k) share of each parameter, both sides together, in each variance of first order."""
        return self.model.by_parameter(self.first_order.shares.T)

    @cached_property
    def totals(self) -> TotalEffects:
        """Of every parameter, from the sample."""
        return total_effects(self.deviations, self.values, self.first_order.slopes, self.model)

    @cached_property
    def tightenings(self) -> tuple[Tightening, ...]:
        """Of every parameter, in their order."""
        return tightenings(self.model, self.deviations, self.values, self.first_order, self.required)
