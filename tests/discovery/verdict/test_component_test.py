"""Parts to measure: what they bring against the same sums with the priors really narrowed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.screening.screen import Screened, screen
from doe_kc.discovery.thresholds import DETECTION_LEVEL, PARTS_MOST
from doe_kc.discovery.verdict.component_test import accuracy, component_tests
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.variables import VariableOptions, build_space
from tests.discovery.cases import library, nominal, records

TUNABLE = ["scb.Tz", "LLF.z", "ROB.?", "l?r.F?", "static.*"]


@pytest.fixture(scope="module")
def tuned() -> Fit:
    """Of a car without an effect; the steering column's stiffness is free."""
    space = build_space(nominal(), VariableOptions.model_validate({"use": TUNABLE}), "test")
    model = EffectModel(nominal(), space, record_likelihood(nominal(), records("none")))
    return fit(model, model.centre)


@pytest.fixture(scope="module")
def rack(tuned: Fit) -> Screened:
    (mount,) = library("rack_mount_compliance")
    return screen(tuned, mount)


def shown(tuned: Fit, prior_sd: FloatArray, change: FloatArray) -> float:
    """Standard deviations of a change once the parameters are re-tuned within their priors."""
    rows = np.vstack([tuned.jacobian.dense * prior_sd, np.eye(prior_sd.size)])
    wanted = np.concatenate([change, np.zeros(prior_sd.size)])
    retuned = np.linalg.lstsq(rows, wanted)[0]
    return float(np.linalg.norm(wanted - rows @ retuned))


def test_the_column_hides_the_rack_s_mount_until_it_is_measured(tuned: Fit, rack: Screened) -> None:
    assert rack.detectability < 2.0
    (found,) = component_tests(tuned, [rack], 5.0)
    assert found is not None
    assert found.parts == ("scb.Tz",)
    assert found.separation >= DETECTION_LEVEL


def test_it_brings_what_the_narrowed_prior_does(tuned: Fit, rack: Screened) -> None:
    (found,) = component_tests(tuned, [rack], 5.0)
    assert found is not None
    space = tuned.model.space
    at = space.paths.index("scb.Tz")
    variable = space.variables[at]
    value = variable.value(float(tuned.z[at]))
    narrowed = tuned.model.prior_sd.copy()
    narrowed[at] = accuracy(variable, value) / variable.slope(float(tuned.z[at]))
    assert shown(tuned, tuned.model.prior_sd, rack.change) == pytest.approx(rack.detectability, rel=1e-6)
    assert found.separation == pytest.approx(shown(tuned, narrowed, rack.change), rel=1e-6)


def test_what_no_part_shows_is_left(tuned: Fit, rack: Screened) -> None:
    unseen = replace(rack, change=1e-3 * rack.change)
    seen = replace(rack, change=np.r_[100.0, np.zeros(rack.change.size - 1)])
    nothing = replace(rack, change=np.zeros(rack.change.size))
    rig = replace(rack, hypothesis=Hypothesis("rig_channel_gain", "toe", rack.hypothesis.sizes))
    assert component_tests(tuned, [unseen, seen, nothing, rig], 5.0) == [None] * 4


def test_no_more_parts_than_a_bench_gets_through(tuned: Fit, rack: Screened) -> None:
    (found,) = component_tests(tuned, [replace(rack, change=0.3 * rack.change)], 0.1)
    assert found is not None
    assert found.separation < DETECTION_LEVEL
    assert len(found.parts) == len(set(found.parts)) == PARTS_MOST


def test_accuracies_are_a_bench_s(tuned: Fit) -> None:
    by_path = {v.path: v for v in build_space(nominal(), VariableOptions(), "test").variables}
    assert accuracy(by_path["llr.Fx"], 1.5) == pytest.approx(0.03)
    assert accuracy(by_path["arb.radius"], 12.0) == pytest.approx(0.06)
    assert accuracy(by_path["LLF.y"], -350.0) == pytest.approx(0.1)
    assert accuracy(by_path["static.toe"], 0.1) == pytest.approx(0.02)
