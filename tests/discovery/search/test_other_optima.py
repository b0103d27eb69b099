"""Other optima of the same set: where fits begin, and which of their ends is taken."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, fit
from doe_kc.discovery.search.other_optima import at_best_optimum, other_shapes, shorter_travels
from doe_kc.discovery.thresholds import COMPLIANT_LIMIT, COMPLIANT_TRAVEL
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.rubber_hysteresis import SPREAD_STARTS
from tests.discovery.cases import library, model
from tests.discovery.search.law_answers import Answers, agreeing, beside_a_hub, rubber_alone, with_member


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


def test_a_friction_on_a_mount_begins_from_shorter_travels() -> None:
    """Beside a hub, or alone, its travel is its own."""
    (mount,) = library("rack_mount_compliance")
    current = with_member(agreeing(), mount)
    (friction, _), own = current.model.members, agreeing().z
    place = current.model.place(friction)
    starts = shorter_travels(current)
    limits, travels = np.array([s.z[place] for s in starts]).T
    np.testing.assert_allclose(limits / own[place][0], [1.0, COMPLIANT_LIMIT])
    travel = friction.sizes[1].value
    expected = COMPLIANT_TRAVEL * travel(own[place][1])
    assert [travel(t) for t in travels] == pytest.approx([expected] * 2)
    assert all(start.ceiling == np.inf and start.near is current for start in starts)
    assert not shorter_travels(agreeing()) and not shorter_travels(beside_a_hub())


def test_shorter_travels_are_asked_for_until_none_is_better() -> None:
    """361 N on a mount of 3120 N/mm were 272 N, then 316 N, then 360 N."""
    (mount,) = library("rack_mount_compliance")
    costs = [-100.0, -60.0, 0.0]

    class Falling(Answers):
        def fits(self, starts: Sequence[FitStart], *told: Any, **options: Any) -> list[Fit | None]:
            self.cost = costs.pop(0)
            return super().fits(starts, *told, **options)

    current = with_member(agreeing(), mount)
    assert at_best_optimum(current, Falling(0.0)).cost == current.cost - 160.0 and not costs
