"""When an effect is named: not where a trace of another would do, nor where another predicts the same."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.findings import _alike, _mistaken, _stands_out, _trace_would_do
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import library


def trial(effect: str, sizes: list[float], gain: float, residual: float = 0.0) -> Any:
    """A refit whose sizes are known to a hundredth of the typical one."""
    (hypothesis,) = [h for h in library(effect) if h.location in (None, "ROB")]
    fit = SimpleNamespace(
        z=np.array(sizes), covariance=1e-4 * np.eye(len(sizes)), residual=np.array([residual])
    )
    return SimpleNamespace(hypothesis=hypothesis, fit=fit, gain=gain)


def step(*trials: Any) -> Any:
    return SimpleNamespace(trials=trials, temper=1.0)


@pytest.mark.parametrize(
    ("hub", "gain", "would_do"),
    [([0.05, 0.0], 15.4, True), ([0.3, 0.0], 15.4, False), ([0.05, 0.0], 12.0, False)],
    ids=["a trace as likely", "more than a trace", "a hundred times less likely"],
)
def test_an_effect_is_not_named_where_a_trace_of_another_would_do(
    hub: list[float], gain: float, would_do: bool
) -> None:
    strut = trial("strut_bending", [0.2, 0.0], 19.0)
    own: Hypothesis = strut.hypothesis
    assert _trace_would_do(step(strut, trial("hub_compliance", hub, gain)), own) is would_do


def test_effects_that_predict_the_same_are_mistaken_for_each_other() -> None:
    rod = trial("tie_rod_compliance", [1.5], 100.0)
    near, far = (trial("hub_compliance", [0.5, 0.5], 99.0, apart) for apart in (1.0, 6.0))
    assert _mistaken(step(rod, near))["hub_compliance"] == pytest.approx(0.3085, abs=1e-4)
    assert _mistaken(step(rod, far))["hub_compliance"] < 0.002


def test_a_free_play_without_a_gap_is_the_tie_rod_s_compliance_by_another_name() -> None:
    rod = trial("tie_rod_compliance", [1.5], 100.0)
    for gap, counted in ((0.0, False), (0.005, False), (0.1, True)):
        play = trial("tie_rod_free_play", [gap, 2.0], 99.0)
        chances = {"tie_rod_free_play": 0.4}
        assert ("tie_rod_free_play" in _mistaken(step(rod, play))) is counted
        own = SimpleNamespace(hypothesis=rod.hypothesis)
        assert _alike(step(rod, play), own, chances) == (("tie_rod_free_play",) if counted else ())


@pytest.mark.parametrize(
    ("loss", "chance", "named"),
    [(20.0, 0.5, True), (15.0, 0.5, False), (15.0, 0.005, True)],
    ids=["six standard deviations", "less, and noise explains what was there", "less, and noise does not"],
)
def test_a_weak_effect_is_named_where_noise_does_not_explain_what_it_explains(
    loss: float, chance: float, named: bool
) -> None:
    own = trial("tie_rod_compliance", [0.5], 15.0)
    here = SimpleNamespace(trials=(own,), accepted=True, map=SimpleNamespace(chance=chance))
    found: Any = SimpleNamespace(steps=[here], losses={own.hypothesis.name: loss})
    finding: Any = SimpleNamespace(hypothesis=own.hypothesis, gain=15.0)
    assert _stands_out(found, finding, 0.0) is named
    assert not _stands_out(found, finding, 16.0)
