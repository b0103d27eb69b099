"""Other optima of the same set: where fits begin, and which of their ends is taken."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.discovery.gauss_newton import FitStart, fit
from doe_kc.discovery.search.other_optima import at_best_optimum, other_starts
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.rubber_hysteresis import SPREAD_STARTS
from tests.discovery.cases import model
from tests.discovery.search.law_answers import Answers, agreeing, rubber_alone


def test_fits_begin_where_a_number_is_not() -> None:
    current = rubber_alone()
    (rubber,) = current.model.members
    at = current.model.place(rubber).start + [s.key for s in rubber.sizes].index("spread")
    starts = list(other_starts(current))
    assert [s.z[at] for s in starts] == [a for a in SPREAD_STARTS if a != current.z[at]]
    for start in starts:
        np.testing.assert_array_equal(np.delete(start.z, at), np.delete(current.z, at))
        assert start.near is current and start.model is current.model
    assert not list(other_starts(agreeing())), "a dry friction has other travels"


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
