"""What another tolerance of one parameter would do: the same cars again, its deviations scaled.

The change of each car is that of first order, added to what the true solver gave for it, so that before and
after are compared on the same cars.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.first_order import FirstOrderScatter
from doe_kc.production_scatter.model import Scatter, ScatterModel
from doe_kc.production_scatter.requirements import Requirement
from doe_kc.production_scatter.statistics import CarShare, car_share

HALVED, DOUBLED = 0.5, 2.0


@dataclass(frozen=True)
class Tightening:
    """Of one parameter. sd_ratio: (k,) standard deviation of each characteristic with the halved tolerance
    over that now. sd_slope: (k,) its derivative to the parameter's sd, of first order, in units of the
    characteristic per unit of the parameter. outside: (r,) share of cars outside each requirement, halved.
    any_outside: outside any of them, halved; doubled: with the tolerance doubled. missed, missed_doubled:
    mean number of requirements that a car misses, alike.
    """

    scatter: Scatter
    sd_ratio: FloatArray
    sd_slope: FloatArray
    outside: tuple[CarShare, ...]
    any_outside: CarShare
    doubled: CarShare
    missed: float
    missed_doubled: float


def tightenings(
    model: ScatterModel,
    deviations: FloatArray,
    values: FloatArray,
    first_order: FirstOrderScatter,
    requirements: Sequence[tuple[int, Requirement]],
) -> tuple[Tightening, ...]:
    """Of every parameter. deviations (n, m) and values (n, k) of the cars; requirements: with the column that
    each is about."""
    out = []
    sd = values.std(axis=0)
    for i, scatter in enumerate(model.scatters):
        own = model.owner == i
        change = deviations[:, own] @ first_order.slopes[:, own].T
        halved = values + (HALVED - 1.0) * change
        doubled = values + (DOUBLED - 1.0) * change
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(sd > 0.0, halved.std(axis=0) / sd, 1.0)
        each, twice = outside_table(halved, requirements), outside_table(doubled, requirements)
        out.append(
            Tightening(
                scatter,
                ratio,
                _sd_slope(model, first_order, own, scatter.sd),
                tuple(car_share(int(column.sum()), len(values)) for column in each.T),
                car_share(int(each.any(axis=1).sum()), len(values)),
                car_share(int(twice.any(axis=1).sum()), len(values)),
                float(each.sum(axis=1).mean()),
                float(twice.sum(axis=1).mean()),
            )
        )
    return tuple(out)


def _sd_slope(
    model: ScatterModel, first_order: FirstOrderScatter, own: NDArray[np.bool_], sd: float
) -> FloatArray:
    """d sd(y) / d sd(x) = sum of g_i (C g)_i over its sides / (sd(x) sd(y))."""
    parts = (first_order.slopes * (first_order.slopes @ model.covariance))[:, own].sum(axis=1)
    scale = sd * first_order.sd
    return np.asarray(np.divide(parts, scale, out=np.zeros_like(parts), where=scale > 0.0))


def outside_table(values: FloatArray, requirements: Sequence[tuple[int, Requirement]]) -> NDArray[np.bool_]:
    """(n, r) whether each car is outside each requirement."""
    columns = [requirement.outside(values[:, k]) for k, requirement in requirements]
    return np.column_stack(columns) if columns else np.zeros((len(values), 0), dtype=bool)
