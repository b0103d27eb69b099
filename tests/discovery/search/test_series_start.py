"""A set begins with a compliance where it makes the loops that it has without."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.law_variants import open_laws, other_laws, with_law
from doe_kc.discovery.search.series_start import in_series, series_starts
from doe_kc.discovery.thresholds import SERIES_RATIOS
from doe_kc.effects._backbone import virgin_curve
from doe_kc.effects._friction import BACKBONE_SHARES
from doe_kc.variables import VariableOptions, build_space
from tests.discovery.cases import TUNABLE, library, nominal
from tests.discovery.search.law_answers import agreeing, beside_a_hub, with_member

(MOUNT,) = library("rack_mount_compliance")
(FRICTION,) = library("steering_friction")
(FREE,) = open_laws(FRICTION)[-1:]


@cache
def tuned(column: float = 0.0) -> Fit:
    """A steering friction of free shape over 0.25 mm, more than a mount takes, with a column that may be
    tuned; at a place between its bounds, from its start."""
    current = agreeing()
    options = VariableOptions.model_validate({"use": [*TUNABLE, "scb.Tz"]})
    space = build_space(nominal(), options, "test")
    z = current.z.copy()
    z[-1] = FRICTION.sizes[1].amplitude(0.5)  # twice the free shape's
    model, z = with_law(current.model, z, FRICTION, FREE)
    own = dict(zip(model.space.paths, z[: model.parameters].tolist(), strict=True))
    places = [own.get(path, at) for path, at in zip(space.paths, space.start.tolist(), strict=True)]
    places[space.paths.index("scb.Tz")] += column
    z = np.concatenate([places, z[model.parameters :]])
    return replace(current, model=replace(model, space=space), z=z)


def apart(start: FitStart, fit: Fit) -> float:
    """RMS of what a start's records are off those of a fit, in standard deviations."""
    left = start.model.residual(start.z) - fit.model.residual(fit.z)
    return float(np.sqrt(np.mean(left**2)))


def numbers(start: FitStart) -> tuple[float, float, float]:
    """Limit, N, column, N/mm, and mount, N/mm, of a start."""
    values = start.model.axle_at(start.z).values
    column = values["steering.column"] * values["scb.Tz"]
    return values["steering_friction.force"], column, values["rack_mount.rate"]


def test_they_make_nearly_the_same_loops() -> None:
    """By the column's softening as much as by the friction's growth; a typical mount alone moves the records
    by many times as much."""
    fit = tuned(-0.3)
    typical = FitStart(fit.model.extended(MOUNT), np.append(fit.z, [1.0, 0.0]), fit)
    starts = list(series_starts(fit, FREE, FREE, MOUNT))
    assert len(starts) == len(SERIES_RATIOS)
    rigid = fit.model.axle_at(fit.z).values
    spring = rigid["steering.column"] * rigid["scb.Tz"]
    for start, ratio in zip(starts, SERIES_RATIOS, strict=True):
        limit, column, mount = numbers(start)
        assert limit == pytest.approx(ratio * rigid["steering_friction.force"], rel=0.02)
        assert column == pytest.approx(ratio * spring)
        assert 1.0 / column + 1.0 / mount == pytest.approx(1.0 / spring)
        assert apart(start, fit) < 0.2 * apart(typical, fit)


def test_from_one_stiffness_to_another() -> None:
    """The one that the fit is at is not asked again."""
    fit = tuned(-0.3)
    first, *others = series_starts(fit, FREE, FREE, MOUNT)
    there = replace(fit, model=first.model, z=first.z)
    starts = list(series_starts(there, FREE, FREE, MOUNT))
    assert len(others) == len(SERIES_RATIOS) - 1
    for start, other in zip(starts, others, strict=True):
        np.testing.assert_allclose(numbers(start), numbers(other), rtol=0.03)
        assert start.model == there.model and start.near is there


def test_a_spring_goes_no_further_than_its_bound() -> None:
    fit = tuned(0.35)
    for start in series_starts(fit, FREE, FREE, MOUNT):
        values = start.model.space.values(start.z[: start.model.parameters])
        assert values["scb.Tz"] <= 2.0 * (1.0 + 1e-12)
    assert not list(series_starts(tuned(0.5), FREE, FREE, MOUNT)), "it is there"


def test_a_spring_that_is_not_tuned_stays() -> None:
    fit = agreeing()
    starts = list(series_starts(fit, FRICTION, FRICTION, MOUNT, ceiling=9.0))
    assert len(starts) == len(SERIES_RATIOS) and all(start.ceiling == 9.0 for start in starts)
    own = fit.model.axle_at(fit.z).values
    for start, ratio in zip(starts, SERIES_RATIOS, strict=True):
        limit, column, mount = numbers(start)
        assert limit == pytest.approx(ratio * own["steering_friction.force"])
        assert column == own["steering.column"] * own["scb.Tz"]
        assert mount == pytest.approx(column * ratio / (ratio - 1.0))


@pytest.mark.parametrize("name", ["iwan", "duhem", "lognormal"])
def test_by_another_law_half_of_the_limit_is_where_the_mount_leaves_it(name: str) -> None:
    """At (y - (r - 1) f R / k) / r, f = 1/2; Dahl's law over a travel d has half of it at y = d ln(2) / 2."""
    current, travel = agreeing(), 0.25
    z = current.z.copy()
    z[-1] = FRICTION.sizes[1].amplitude(travel)
    fit = replace(current, z=z)
    rigid = fit.model.axle_at(z).values
    spring = rigid["steering.column"] * rigid["scb.Tz"]
    law = next(h for h in other_laws(FRICTION) if h.law == name)
    starts = list(series_starts(fit, FRICTION, law, MOUNT))
    for start, ratio in zip(starts, SERIES_RATIOS, strict=True):
        y, taken = 0.5 * math.log(2.0) * travel, 0.5 * rigid["steering_friction.force"] / spring
        values = start.model.axle_at(start.z).values
        shape = (values[f"steering_friction.{key}"] for key in ("exponent", "spread"))
        curve = virgin_curve(name, *shape, BACKBONE_SHARES)  # type: ignore[arg-type]
        half = values["steering_friction.presliding"] * curve.distance(0.5)
        assert half == pytest.approx((y - (ratio - 1.0) * taken) / ratio, rel=0.01)
        assert law in start.model.members and FRICTION not in start.model.members


def test_only_a_friction_beside_a_spring_stands_on_a_compliance() -> None:
    (strut,), (bending,) = library("strut_friction"), library("strut_bending")
    assert in_series(FRICTION, MOUNT) and not in_series(strut, MOUNT)
    assert not in_series(strut, bending) and not in_series(MOUNT, MOUNT)
    hub = beside_a_hub().model.members[-1]
    assert not list(series_starts(beside_a_hub(), FRICTION, FRICTION, hub))
    assert list(series_starts(with_member(agreeing(), MOUNT), FRICTION, FRICTION, MOUNT))
