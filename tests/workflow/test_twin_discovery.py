"""What an outside model lacks, looked for through its twin: the pair of effects, one of which it has."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.curves import CurveSet
from doe_kc.discovery.discover import discover
from doe_kc.discovery.model import EffectModel
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.true_solver.options import SolverOptions
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.own import AxleSolver
from doe_kc.workflow.twin_discovery import discovery_ground, less_disagreement, twin_ground
from tests.discovery.cases import HIDDEN, known_to, nominal, records, space
from tests.workflow.chain_cases import study

OUTSIDE = SolverOptions.model_validate({"command": ["solve"]})


def outside_answer() -> Outcome:
    """Of the nominal axle with the friction that its twin lacks."""
    axle = apply_effect(nominal(), "steering_friction", HIDDEN["pair"]["steering_friction"], source="test")
    return AxleSolver(axle).evaluate({})


def test_an_effect_that_the_outside_model_has_is_not_named_and_one_that_it_lacks_is(tmp_path: Path) -> None:
    outside = replace(study(tmp_path), solver=OUTSIDE, twin=nominal())
    ground = twin_ground(outside, records("pair"), outside_answer(), {}, "the start")
    assert ground.study.solver.command == [] and ground.study.axle is outside.twin
    assert (
        "in its own terms" in ground.study.discovery_remark
        and "at the start" in ground.study.discovery_remark
    )
    data = record_likelihood(nominal(), ground.records)
    discovery = discover(EffectModel(nominal(), space(), data), known_to("pair"))
    assert [f.hypothesis.effect for f in discovery.findings if f.verdict != "lead"] == ["hub_compliance"]


def test_records_less_a_known_difference() -> None:
    like, twin = records("pair"), curve_set(solve(nominal()))
    outside = outside_answer().curves
    assert outside is not None and outside.static is not None and twin.static is not None
    less = less_disagreement(like, outside, twin)
    case = like.curves.cases["steer"]
    for response in ("toe", "wc_y"):
        ours, other = (
            np.interp(case.input, c.cases["steer"].input, c.cases["steer"].half_width[response][1])
            for c in (outside, twin)
        )
        np.testing.assert_allclose(
            less.curves.cases["steer"].half_width[response][1],
            case.half_width[response][1] - (ours - other),
            atol=1e-12,
        )
    np.testing.assert_allclose(
        (less.curves.static or {})["toe"],
        (like.curves.static or {})["toe"] - (outside.static["toe"] - twin.static["toe"]),
    )
    few = CurveSet("few", {"steer": outside.cases["steer"]}, None, outside.half_track)
    assert list(less_disagreement(like, few, twin).curves.cases) == ["steer"]
    equal = less_disagreement(like, twin, twin)
    np.testing.assert_allclose(equal.curves.cases["steer"].mean["toe"], case.mean["toe"], atol=1e-12)


def test_what_stands_in_the_way_is_said(tmp_path: Path) -> None:
    plain = study(tmp_path)
    assert discovery_ground(plain, records("pair")).study is plain
    with pytest.raises(InputError, match="name its twin with"):
        discovery_ground(replace(plain, solver=OUTSIDE), records("pair"))
    dumb = replace(outside_answer(), curves=None)
    with pytest.raises(InputError, match="gave no curves"):
        twin_ground(replace(plain, solver=OUTSIDE, twin=nominal()), records("pair"), dumb, {}, "the start")
