"""Bounds are widened where a series is off nominal, and only there."""

from __future__ import annotations

import weakref
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search import bound_check
from doe_kc.discovery.search.bound_check import (
    at_bounds,
    beyond,
    bound_evidence,
    search_within_bounds,
    with_wider_bounds,
)
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.search import search
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import OFF_NOMINAL, discovery, known_to, model, space

CAR = "beyond"
OUTSIDE = {"LLF.z", "LLR.z", "ROB.z", "UPB.y", "llr.Fx"}


def test_an_effect_is_named_in_a_series_that_is_off_nominal() -> None:
    found = discovery(CAR)
    assert found.verdict == "named"
    assert [f.hypothesis.effect for f in found.findings] == ["hub_compliance"]
    camber = next(e for e in found.findings[0].estimates if e.key == "camber_Nm_deg")
    assert abs(camber.value - 15000.0) < 3.0 * camber.sd
    assert found.widened > 1.0
    assert set(found.beyond) == OUTSIDE <= set(OFF_NOMINAL[CAR])
    assert any(f"{len(OUTSIDE)} parameters outside the bounds" in s for s in found.sentences)


def test_between_the_bounds_the_gap_would_stay() -> None:
    narrow = search(model(CAR), known_to(CAR), DiscoveryWorkers()).with_effects
    wide = discovery(CAR).search.with_effects
    assert wide.rms < 1.0 < narrow.rms
    assert wide.evidence > narrow.evidence + 50.0
    assert at_bounds(narrow).sum() >= 3 and not at_bounds(wide).any()


@pytest.mark.parametrize("car", ["none", "named", "unexplained"])
def test_no_other_car_asks_for_wider_bounds(car: str) -> None:
    found = discovery(car)
    assert found.widened == 1.0 and found.beyond == ()
    assert not any("outside the bounds" in s for s in found.sentences)


@pytest.mark.parametrize(("gain", "asked"), [(100.0, [1.0, 1.5]), (-100.0, [1.0, 1.5, 1.0])])
def test_the_first_search_is_let_go_while_the_wider_one_runs(
    gain: float, asked: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It holds 80 MB; where it is the better one after all it is run again."""
    known, widened = discovery("none").search, []
    ended: list[weakref.ref[EffectSearch]] = []

    def searched(within: EffectModel, *_: object) -> EffectSearch:
        assert all(before() is None for before in ended)
        widened.append(within.widened)
        out = replace(known, shape_loss=gain if within.widened > 1.0 else 0.0)
        ended.append(weakref.ref(out))
        return out

    monkeypatch.setattr(bound_check, "search", searched)
    monkeypatch.setattr(bound_check, "bound_evidence", lambda *_: 1.5)
    last = search_within_bounds(model("none"), [], DiscoveryWorkers())
    assert widened == asked and last.shape_loss == max(gain, 0.0)


def test_bounds_are_not_widened_where_tuning_cannot_be_the_reason() -> None:
    final = discovery("unexplained").search.with_law_discrepancy
    z = final.z.copy()
    z[: final.model.parameters] = 0.0
    held = replace(final, z=z)
    assert at_bounds(held).all()
    assert bound_evidence(held, DiscoveryWorkers()) == 1.0


def test_a_wider_model_says_the_same_at_the_same_point() -> None:
    found = discovery("none").search.tuned
    wider, z = with_wider_bounds(found, 1.5)
    np.testing.assert_allclose(wider.residual(z), found.residual, atol=1e-6)
    assert (wider.space.prior_sd == found.model.space.prior_sd).all()
    again = fit(wider, z)
    assert again.misfit == pytest.approx(found.misfit, rel=0.05)
    assert beyond(space(), again) == ()


def test_a_parameter_at_its_bound_is_not_beyond_it() -> None:
    found = discovery("none").search.tuned
    count = found.model.parameters
    for bound in (0.0, 1.0):
        z = np.concatenate([np.full(count, bound), found.z[count:]])
        assert beyond(space(), replace(found, z=z)) == ()
        further = z + np.where(np.arange(z.size) < count, (bound - 0.5) * 0.02, 0.0)
        assert beyond(space(), replace(found, z=further)) == space().paths
