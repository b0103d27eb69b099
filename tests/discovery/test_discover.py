"""The whole chain on small cars: each kind of verdict, and controls that must not pass."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.correlation.likelihood import Likelihood, record_likelihood
from doe_kc.discovery.discover import discover, gaps, library_statuses, resolved, shown_traces
from doe_kc.discovery.fit import rewhitened_fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result_cache import ResultCache
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.measurement import reduce_measurement
from doe_kc.variables import VariableOptions
from doe_kc.workflow.discover import discovery_space
from tests.discovery.cases import AXLE, LATERAL, RIG, discovery, library, model, nominal, records, space


def test_nothing_hidden_nothing_named() -> None:
    found = discovery("none")
    assert found.verdict == "none"
    assert found.findings == ()
    assert found.gap.tuned == pytest.approx(1.0, abs=0.06)


@pytest.mark.parametrize(
    ("car", "effect", "key", "value"),
    [
        ("named", "hub_compliance", "camber_Nm_deg", 5000.0),
        ("friction", "steering_friction", "force_N", 200.0),
    ],
)
def test_one_effect_is_named_with_its_size(car: str, effect: str, key: str, value: float) -> None:
    found = discovery(car)
    assert found.verdict == "named"
    (finding,) = found.findings
    assert finding.hypothesis.effect == effect
    assert finding.probability > 0.9
    size = next(e for e in finding.estimates if e.key == key)
    assert abs(size.value - value) < 3.0 * size.sd
    assert size.sd < 0.1 * value


@pytest.mark.parametrize("car", ["named", "friction"])
def test_the_gap_closes_on_load_cases_held_out_and_a_decoy_does_not_close_it(car: str) -> None:
    found = discovery(car)
    tuned = np.sqrt(np.mean([h.tuned.rms**2 for h in found.held_out]))
    after = np.sqrt(np.mean([h.with_effect.rms**2 for h in found.held_out]))
    assert 1.0 - (after - 1.0) / (tuned - 1.0) > 0.9
    assert found.gap.with_effect < 1.1 < found.gap.best_decoy


def test_an_effect_of_a_set_that_counts_for_the_sizes_is_not_excluded() -> None:
    found = discovery("friction")
    search, count = found.search, len(found.statuses)
    status = next(s for s in found.statuses if s.status == "excluded")
    larger = replace(search, larger=(HypothesisFit(status.hypothesis, search.with_effects, 0.0),))
    before, after = (
        {s.hypothesis.name: s.status for s in library_statuses(one, found.findings, count, resolved=True)}
        for one in (search, larger)
    )
    assert {name for name in before if before[name] != after[name]} == {status.hypothesis.name}
    assert after[status.hypothesis.name] == "not testable"


def test_two_effects_are_both_found() -> None:
    found = discovery("two")
    assert {f.hypothesis.effect for f in found.findings} == {"strut_friction", "rig_channel_gain"}


@pytest.mark.parametrize(("car", "loops"), [("steady", 1), ("friction", 0)])
def test_the_loop_that_the_rig_recorded_is_driven(car: str, loops: int) -> None:
    found = discovery(car)
    assert found.verdict == "named"
    assert found.fitted.model.axle.conditioning == loops
    assert found.gap.with_effect < 1.05


def test_effects_that_look_alike_are_a_class() -> None:
    found = discovery("class")
    assert found.verdict == "class"
    assert {"steer_arm_compliance", "tie_rod_compliance"} <= set(found.classes[0])


def test_an_effect_outside_the_library_is_not_given_another_name() -> None:
    found = discovery("unexplained")
    assert found.verdict == "unexplained"
    assert found.unexplained
    assert found.scan is not None
    assert "tie rod" in found.scan.places[0].interface or "steer" in found.scan.places[0].interface


def test_no_trace_of_the_rig_where_the_model_does_not_hold() -> None:
    """Rubber beside friction looks like a wrong input of a few load cases."""
    (strut,) = discovery("named").findings
    gain = replace(strut, hypothesis=library("rig_input_gain")[0], relevant=False)
    small = replace(strut, relevant=False)
    good, bad = discovery("named").adequacy, discovery("unexplained").adequacy
    assert shown_traces((strut, gain, small), good) == (gain, small)
    assert shown_traces((strut, gain, small), bad) == (small,)
    assert shown_traces((strut, gain, replace(small, seen=False)), good) == (gain,)


def test_limits_mean_nothing_where_the_model_or_a_friction_s_law_does_not_hold() -> None:
    good, bad = discovery("named").adequacy, discovery("unexplained").adequacy
    hub, friction = discovery("named").search, discovery("friction").search
    assert resolved(hub, good)
    assert not resolved(hub, bad)
    name = friction.with_law_discrepancy.model.members[0].name
    assert resolved(replace(friction, discrepancy_shares={name: 0.0}), good)
    assert not resolved(replace(friction, discrepancy_shares={name: 0.02}), good)
    assert resolved(
        replace(hub, discrepancy_shares={hub.with_law_discrepancy.model.members[0].name: 0.02}), good
    )


def test_records_of_other_load_cases_are_noticed() -> None:
    """Negative control: lateral and lateral_opposite exchanged, as by a wrong file name."""
    car = model("none")
    other = {"lateral": "lateral_opposite", "lateral_opposite": "lateral"}
    curves = tuple(replace(c, load_case=other.get(c.load_case, c.load_case)) for c in car.likelihood.curves)
    found = discover(replace(car, likelihood=Likelihood(curves, car.likelihood.figures)), library())
    assert found.verdict == "unexplained"
    assert "lateral" in {c.load_case for c, _ in found.unexplained} | {"lateral_opposite"}


def test_white_noise_assumed_where_it_is_not_does_not_pass_for_agreement() -> None:
    """Negative control: offset, gain and smooth errors denied, so that noise itself looks like structure."""
    measured = records("none")
    noise = {
        case: {
            r: replace(m, components=replace(m.components, offset=0.0, gain=0.0, smooth=0.0), loop=0.0)
            for r, m in of.items()
        }
        for case, of in measured.noise.items()
    }
    likelihood = record_likelihood(nominal(), replace(measured, noise=noise))
    found = discover(EffectModel(nominal(), space(), likelihood), library())
    assert found.tuned_map.mean_square > 1.5
    assert not found.tuned_map.agrees


def test_with_a_cache_nothing_is_computed_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "discovery.sqlite"
    car, few = model("named", LATERAL), library("hub_compliance")
    with ResultCache(path) as cache:
        first = discover(car, few, DiscoveryWorkers(cache=cache))
    for task in ("_screen_many", "_fit_one"):
        monkeypatch.setattr(f"doe_kc.discovery.workers.{task}", lambda *_: pytest.fail("computed twice"))
    with ResultCache(path) as cache:
        again = discover(model("named", LATERAL), few, DiscoveryWorkers(cache=cache))
    assert again.sentences == first.sentences
    assert np.array_equal(again.fitted.z, first.fitted.z)
    assert np.array_equal(again.fitted.jacobian.own, first.fitted.jacobian.own)


def test_a_measured_car_with_all_its_load_cases_and_parameters() -> None:
    """Strut bending hidden beside production scatter of 72 parameters; hub compliance looks much like it."""
    axle = read_axle(AXLE)
    car = reduce_measurement(RIG / "car_c", half_track=axle.half_track)
    tunable = discovery_space(axle, VariableOptions(), "test")
    full = EffectModel(axle, tunable, record_likelihood(axle, car))
    found = discover(full, library("strut_bending", "hub_compliance"))
    assert found.verdict == "named"
    (finding,) = found.findings
    assert finding.hypothesis.effect == "strut_bending"
    stiffness = finding.estimates[0]
    assert abs(stiffness.value - 6500.0) < 3.0 * stiffness.sd < 0.3 * 6500.0
    assert max(h.with_effect.rms for h in found.held_out) < 1.1
    assert all(h.gain > 0.0 for h in found.held_out)


def test_the_gap_of_a_decoy_is_in_the_errors_of_the_others() -> None:
    found = discovery("named")
    fitted = found.fitted
    likelihood = fitted.model.likelihood
    wide = replace(likelihood, curves=tuple(replace(c, root=2.0 * c.root) for c in likelihood.curves))
    decoy = rewhitened_fit(fitted, wide)
    assert np.sqrt(np.mean(decoy.residual**2)) < 0.6 * found.gap.with_effect
    gap, each = gaps(likelihood, found.nominal, found.search.tuned, fitted, decoy)
    assert gap.best_decoy == pytest.approx(gap.with_effect) == pytest.approx(found.gap.with_effect)
    assert all(c.gap.best_decoy == pytest.approx(c.gap.with_effect) for c in each)
