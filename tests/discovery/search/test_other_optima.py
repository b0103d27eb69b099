"""Other optima of the same set: where fits begin, and which of their ends is taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, fit
from doe_kc.discovery.search.law_variants import open_laws, with_law
from doe_kc.discovery.search.other_optima import (
    at_best_free_shape,
    at_best_optimum,
    other_compliances,
    other_shapes,
    other_sliders,
    other_stiffnesses,
)
from doe_kc.discovery.thresholds import COMPLIANCE_FACTORS, FREE_SHAPE_LOSS, GRID_FACTORS, SERIES_RATIOS
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.rubber_hysteresis import SPREAD_STARTS
from tests.discovery.cases import library, model
from tests.discovery.search.law_answers import Answers, agreeing, beside_a_hub, rubber_alone, with_member

FRICTION = "steering_friction"


def test_fits_begin_where_a_number_is_not() -> None:
    current = rubber_alone()
    (rubber,) = current.model.members
    at = current.model.place(rubber).start + [s.key for s in rubber.sizes].index("spread")
    starts = other_shapes(current)
    assert [s.z[at] for s in starts] == [a for a in SPREAD_STARTS if a != current.z[at]]
    for start in starts:
        np.testing.assert_array_equal(np.delete(start.z, at), np.delete(current.z, at))
        assert start.near is current and start.model is current.model
    assert not other_shapes(agreeing()), "a dry friction has other travels"


@pytest.mark.parametrize(("cost", "taken"), [(-8.0, False), (-12.0, True)], ids=["like noise", "better"])
def test_another_optimum_is_taken_if_better_by_more_than_an_effect_needs(cost: float, taken: bool) -> None:
    current = rubber_alone()
    better = at_best_optimum(current, Answers(cost))
    assert (better is not current) == taken
    assert better.cost == current.cost + (cost if taken else 0.0)


def test_the_best_optimum_of_a_car_is_found_from_a_worse_one() -> None:
    """A share of 0.3, a yield distance of 0.1 mm and a spread of 0.5; the fit from 0.8 ends at 0.73, 19 of ln
    evidence behind."""
    nominal = model("rubber")
    rubber, *_ = EFFECTS["rubber_hysteresis"].hypotheses()
    tuned, workers = fit(nominal, nominal.centre), DiscoveryWorkers()
    start = np.append(tuned.z, [1.0, -0.5, 0.0])
    (worse,) = workers.fits([FitStart(nominal.extended(rubber), start, tuned)], "from the typical spread")
    assert worse is not None and worse.converged
    best = at_best_optimum(worse, workers)
    assert best.evidence > worse.evidence + 10.0
    numbers = [size.value(a) for size, a in zip(rubber.sizes, best.amplitudes, strict=True)]
    np.testing.assert_allclose(numbers, [0.3, 0.1, 0.5], rtol=0.05)


def test_a_friction_on_a_mount_begins_from_other_stiffnesses() -> None:
    """Beside a hub, or alone, it begins from nowhere else."""
    current = on_a_mount()
    starts = other_stiffnesses(current)
    assert len(starts) == len(SERIES_RATIOS)
    assert all(start.ceiling == np.inf and start.near is current for start in starts)
    assert not other_stiffnesses(agreeing()) and not other_stiffnesses(beside_a_hub())
    assert not other_stiffnesses(current, free=True), "by a closed law"
    assert len(other_stiffnesses(on_a_mount(free=True), free=True)) == len(SERIES_RATIOS)


def test_beside_a_free_play_every_compliance_begins_from_others() -> None:
    """Its own contact too; not its gap, nor beside anything else."""
    current = beside_a_hub()
    assert not other_compliances(current)
    play = library("tie_rod_free_play")[0]
    model_ = current.model.extended(play)
    both = replace(current, model=model_, z=np.append(current.z, [1.0, 0.5]))
    gap = both.z.size - 2
    yields = [
        i
        for i in range(model_.dimension, both.z.size)
        if i != gap and model_.sizes[i - model_.dimension].growth == "compliance"
    ]
    starts = other_compliances(both)
    assert yields[-1] == gap + 1 and len(yields) > 1
    assert len(starts) == len(yields) * len(COMPLIANCE_FACTORS)
    for start, (i, factor) in zip(starts, [(i, f) for i in yields for f in COMPLIANCE_FACTORS], strict=True):
        assert start.z[i] == factor * both.z[i] and start.model is model_
        np.testing.assert_array_equal(np.delete(start.z, i), np.delete(both.z, i))


def test_other_stiffnesses_are_asked_for_until_none_is_better() -> None:
    """361 N on a mount of 3120 N/mm were 272 N, then 316 N, then 360 N."""
    current, asked = on_a_mount(), Falling([-100.0, -60.0, 0.0])
    assert at_best_optimum(current, asked).cost == current.cost - 160.0 and not asked.costs


def test_a_free_shape_goes_on_to_the_best_optimum_and_keeps_those_that_fit_as_well() -> None:
    """240 N on a mount of 3090 N/mm, the car's, ended 9 of ln evidence behind 173 N on 6060."""
    current, asked = on_a_mount(free=True), Falling([-100.0, 2.0 * FREE_SHAPE_LOSS - 1.0])
    best, near = at_best_free_shape(current, set(), asked)
    assert best.cost == current.cost - 100.0 and not asked.costs
    alike, worse = np.split(np.array([fit.cost - best.cost for fit in near]), [len(SERIES_RATIOS) - 1])
    assert not alike.any() and worse.size and (worse == 2.0 * FREE_SHAPE_LOSS - 1.0).all()
    forces = [fit.amplitudes[0] for fit in (best, *near)]
    assert len({round(float(force), 3) for force in forces}) == len(forces), "one of each"
    assert not any(fit.jacobian.own.size for fit in near)


def test_what_a_free_shape_may_not_cost_is_left_out() -> None:
    current = on_a_mount(free=True)
    assert at_best_free_shape(current, set(), Falling([2.0 * FREE_SHAPE_LOSS + 1.0])) == (current, ())
    closed = on_a_mount()
    assert at_best_free_shape(closed, {FRICTION}, Falling([])) == (closed, ())


def test_sliders_elsewhere_do_nearly_the_same() -> None:
    """Of those frictions that have no closed law: fits end at other sizes, for the cost is rough."""
    current = on_a_mount(free=True)
    starts = other_sliders(current, {FRICTION})
    assert len(starts) == len(GRID_FACTORS)
    friction = current.model.members[0]
    travel = [s.key for s in friction.sizes].index("presliding_mm")
    place = current.model.place(friction)
    for start, factor in zip(starts, GRID_FACTORS, strict=True):
        size = friction.sizes[travel]
        ratio = size.value(start.z[place][travel]) / size.value(current.z[place][travel])
        assert ratio == pytest.approx(factor)
        moved = current.z.copy()
        moved[place.start + travel] = start.z[place.start + travel]
        left = current.model.residual(start.z) - current.model.residual(current.z)
        alone = current.model.residual(moved) - current.model.residual(current.z)
        assert np.linalg.norm(left) < 0.7 * np.linalg.norm(alone)
    assert not other_sliders(current, set()) and not other_sliders(on_a_mount(), {FRICTION})


def on_a_mount(*, free: bool = False) -> Fit:
    """A steering friction, and a mount of no size, which moves nothing."""
    current = agreeing()
    if free:
        (friction,) = current.model.members
        law = open_laws(friction)[-1]
        model, z = with_law(current.model, current.z, friction, law)
        none = np.zeros((current.residual.size, z.size - current.z.size))
        jacobian = model.jacobian(np.hstack([current.jacobian.own, none]))
        current = replace(current, model=model, z=z, jacobian=jacobian)
    return with_member(current, library("rack_mount_compliance")[0])


class Falling(Answers):
    """Round by round better or worse by a cost."""

    def __init__(self, costs: list[float]) -> None:
        super().__init__(0.0)
        self.costs = costs

    def fits(self, starts: Sequence[FitStart], *told: Any, **options: Any) -> list[Fit | None]:
        self.cost = self.costs.pop(0)
        return super().fits(starts, *told, **options)
