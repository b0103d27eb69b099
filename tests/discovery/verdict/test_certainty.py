"""A partial answer: certain beside something unexplained only where nothing of an effect's own is left."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.discover import with_verdicts
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import Finding, Rival
from doe_kc.discovery.verdict.alternatives import Alternatives, alternatives
from doe_kc.discovery.verdict.certainty import certain, explained, name_doubt
from doe_kc.discovery.verdict.verdict import Verdict
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import discovery, library

OPEN = Verdict("unexplained", ("something remains",))


@pytest.fixture(scope="module")
def hub() -> tuple[Finding, Alternatives, Fit]:
    answer = discovery("named")
    (finding,) = answer.findings
    (own,) = alternatives(answer.search, 1.0, DiscoveryWorkers())
    return finding, own, answer.search.with_law_discrepancy


def disagreeing(fit: Fit, load_case: str, response: str, by: float) -> Fit:
    """The fit of records that deviate further in one response, by so many standard deviations in squares."""
    residual = fit.residual.copy()
    for curve, place in fit.model.likelihood.slices():
        if (curve.load_case, curve.response, curve.side, curve.branches) == (load_case, response, 0, "mean"):
            shape = curve.whitened(np.tanh(curve.input / (0.1 * np.abs(curve.input).max())))
            residual[place] += by * shape / np.linalg.norm(shape)
    return replace(fit, residual=residual)


def test_an_effect_stays_certain_where_something_else_remains_elsewhere(
    hub: tuple[Finding, Alternatives, Fit],
) -> None:
    finding, own, final = hub
    assert certain(finding, own, final)
    elsewhere = disagreeing(final, "vertical", "wc_x", 18.0)
    assert elsewhere.residual_map.chance < 0.01
    (named,) = with_verdicts([finding], [own], OPEN, elsewhere, discovery("unexplained").adequacy)
    assert named.verdict == "named"


def test_it_is_a_lead_where_its_own_deviations_are_not_explained(
    hub: tuple[Finding, Alternatives, Fit],
) -> None:
    finding, own, final = hub
    worst = own.without.model.contrasts.names[int(np.argmax(own.change.contrasts))]
    assert worst.response == "camber"
    assert explained(own, final.residual_map)
    spoilt = disagreeing(final, worst.load_case, worst.response, 60.0)
    assert not explained(own, spoilt.residual_map)
    (lead,) = with_verdicts([finding], [own], OPEN, spoilt, discovery("unexplained").adequacy)
    assert lead.verdict == "lead"


def test_it_is_a_lead_where_much_remains_or_a_rival_is_probable(
    hub: tuple[Finding, Alternatives, Fit],
) -> None:
    finding, own, final = hub
    much = disagreeing(final, "vertical", "wc_x", float(np.sqrt(0.3 * own.loss)) + 20.0)
    assert not certain(finding, own, much)
    unsure = replace(finding, probability=0.5, rivals=(Rival("strut_bending", 0.5),))
    assert not certain(unsure, own, final)


@pytest.mark.parametrize(
    ("effect", "named"),
    [("rig_channel_gain", False), ("rig_input_gain", False), ("roll_technique", True)],
)
def test_a_gain_of_the_rig_is_certain_of_no_set_that_leaves_something(
    effect: str, named: bool, hub: tuple[Finding, Alternatives, Fit]
) -> None:
    """Another roll technique is: it has no number that could fit anything."""
    finding, own, final = hub
    fault = replace(finding, hypothesis=library(effect)[0])
    assert bool(fault.hypothesis.sizes) is not named
    assert certain(fault, own, final) is named


def test_the_probability_falls_with_what_remains_and_is_no_constant(
    hub: tuple[Finding, Alternatives, Fit],
) -> None:
    _, own, final = hub
    good, poor = discovery("named").adequacy, discovery("unexplained").adequacy
    sure = name_doubt(own, final, good)
    assert sure < name_doubt(own, final, replace(good, map_chance=0.02)) < name_doubt(own, final, poor)
    assert name_doubt(own, disagreeing(final, "vertical", "wc_x", 40.0), good) > sure
    assert 0.9 < discovery("named").findings[0].probability < 0.99
