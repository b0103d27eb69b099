"""When an effect is named: not where a trace of another would do, nor where another predicts the same."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.findings import _mistaken, _trace_would_do
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
    # a free play without a gap is the tie rod's compliance by another name
    assert _mistaken(step(rod, trial("tie_rod_free_play", [0.0, 2.0], 99.0))) == {}
