"""Which refit a step takes: by what it gains with its new sizes held where they are believed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.search import decision as decision_module
from doe_kc.discovery.search.decision import HypothesisGain, Step, next_decision, runners_up
from doe_kc.discovery.search.refits import HypothesisFit, held_loss
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import library, model

PLACES = library("left_right_asymmetry")


def one_sided(place: int, amplitude: float, gain: float) -> HypothesisFit:
    """A car fitted with one bushing stiffer on one side, as if it were so by an amplitude."""
    hypothesis = PLACES[place]
    extended = model("none").extended(hypothesis)
    start = np.append(extended.centre[: extended.dimension], np.zeros(len(hypothesis.sizes)))
    reached = fit(extended, start)
    return HypothesisFit(hypothesis, replace(reached, z=np.append(reached.z[:-1], amplitude)), gain)


def tuned() -> Fit:
    without = model("none")
    return fit(without, without.centre)


@pytest.mark.parametrize(
    ("sds_beyond", "gain", "taken"),
    [(3.0, 100.0, 1), (3.0, 60.0, 1), (3.0, 54.0, 0), (20.0, 100.0, 0), (20.0, 260.0, 1)],
)
def test_a_refit_beyond_belief_comes_first_where_it_gains_more_than_it_loses_at_the_limit(
    sds_beyond: float, gain: float, taken: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside a believed one of 50: three standard deviations beyond lose 4.5, twenty lose 200.

    A free play of 0.30 mm whose contact was too soft by 3 % came after one of 0.11 mm on both sides, with
    14 000 of ln evidence more.
    """
    believed = one_sided(0, 1.0, 50.0)
    most = PLACES[1].sizes[0].most
    at_limit = one_sided(1, most, gain)
    sd = float(np.sqrt(at_limit.fit.covariance[-1, -1]))
    beyond = one_sided(1, most + sds_beyond * sd, gain)
    assert held_loss(beyond.fit, ()) == pytest.approx(0.5 * sds_beyond**2)
    current = tuned()
    monkeypatch.setattr(decision_module, "_leader_refits", lambda *_: [believed, beyond])
    monkeypatch.setattr(decision_module, "refits_from_nominal", lambda *_: [])
    found = next_decision(
        current, PLACES, SetPrior.of(PLACES), DiscoveryWorkers(), (), (), runners_up=set(), laws_open=True
    )
    assert [t.hypothesis for t in found.trials] == [PLACES[taken], PLACES[1 - taken]]
    assert found.accepted


@pytest.mark.parametrize("laws_open", [True, False])
def test_what_runners_up_is_refitted_whatever_its_screening_promises(
    laws_open: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where no other law is left to try, and nothing else is accepted."""
    current, workers, prior = tuned(), DiscoveryWorkers(), SetPrior.of(PLACES)
    screened = workers.screenings(current, PLACES)
    assert all(s.gain < 0.0 for s in screened) and current.residual_map.agrees
    names = {PLACES[1].name, "no place of this axle"}
    found = next_decision(
        current, PLACES, prior, workers, screened, (), runners_up=names, laws_open=laws_open
    )
    assert [t.hypothesis for t in found.trials] == ([] if laws_open else [PLACES[1]])
    assert not found.accepted


def test_what_runners_up_is_told_by_the_last_refit_beside_others() -> None:
    """Not by what it gained where the set had nothing, beside which anything does, nor by its screening."""
    one, two, three = PLACES[:3]

    def step(members: int, *gains: HypothesisGain) -> Step:
        return Step((one,) * members, 1.0, gains, 1.0, (), False)

    alone = step(0, HypothesisGain(two, 900.0, True))
    assert runners_up([alone]) == set()
    rivals = step(1, HypothesisGain(two, 20.0, True), HypothesisGain(three, 30.0, False))
    assert runners_up([alone, rivals]) == {two.name}
    with_another = step(1, HypothesisGain(two, -3.0, True, (three,)))
    assert runners_up([rivals, with_another, step(1, HypothesisGain(two, -5.0, False))]) == {two.name}
    assert runners_up([rivals, step(1, HypothesisGain(two, 1.0, True))]) == set()
