"""The prior of sets: shared between an effect's places, small for faults of the rig, open to many effects."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from doe_kc.discovery.search.set_prior import SetPrior
from tests.discovery.cases import library

KNOWN = library("hub_compliance", "tie_rod_compliance", "bushing_progression", "rig_channel_gain")
PRIOR = SetPrior.of(KNOWN)


def test_the_odds_of_an_effect_are_shared_between_its_places() -> None:
    (hub,), (one, *more) = library("hub_compliance"), library("bushing_progression")
    apart = PRIOR.log_odds([], hub) - PRIOR.log_odds([], one)
    assert apart == pytest.approx(np.log(1 + len(more)))


def test_a_fault_of_the_rig_is_twenty_times_less_likely() -> None:
    (hub,), gains = library("hub_compliance"), library("rig_channel_gain")
    apart = PRIOR.log_odds([], hub) - PRIOR.log_odds([], gains[0])
    assert apart == pytest.approx(np.log(20.0 * len(gains)))


def test_after_several_effects_a_further_one_is_likelier() -> None:
    (hub,), (rod,) = library("hub_compliance"), library("tie_rod_compliance")
    assert PRIOR.log_odds([rod], hub) > PRIOR.log_odds([], hub)


def test_it_is_a_beta_binomial_distribution() -> None:
    """Sets of five effects with one place each: probabilities add up to one."""
    effects = [
        h for ident in ("hub_compliance", "tie_rod_compliance", "strut_bending") for h in library(ident)
    ]
    effects += library("strut_friction", "steering_friction")
    prior = SetPrior.of(effects)
    logs = [prior.log(s) for k in range(6) for s in combinations(effects, k)]
    single = np.exp(prior.log([])) / np.exp(logs).sum()
    assert single == pytest.approx(20.0 / 25.0)
