"""The package's own solver behind the protocol."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.campaign.runner import Campaign
from doe_kc.characteristics import CHARACTERISTICS, reduce_all
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.true_solver import own
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.options import SolverOptions
from doe_kc.true_solver.own import AxleSolver
from doe_kc.true_solver.protocol import TrueSolver
from tests.reference import nominal

IMPOSSIBLE = {"LWB.z": 2000.0}


@pytest.fixture(autouse=True)
def interpreted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DOE_KC_COMPILE", "0")


def axle() -> Axle:
    """Two load cases only."""
    cases = nominal().load_cases
    return replace(nominal(), load_cases={i: cases[i] for i in ("vertical", "brake")})


def moved(count: int) -> list[dict[str, float]]:
    return [{"LLF.z": 208.0 + i} for i in range(count)]


def test_it_is_what_a_study_gets_without_a_command() -> None:
    solver: TrueSolver = solver_for(axle(), SolverOptions(), {"vertical": 5.0})
    assert isinstance(solver, AxleSolver) and solver.exact and solver.quick
    assert solver.windows == {"vertical": 5.0}


def test_one_design_is_the_solver_and_the_reduction() -> None:
    found = AxleSolver(axle()).evaluate({})
    direct = reduce_all(curve_set(solve(axle(), compiled=False)))
    assert found.reason == "" and found.curves is not None and found.seconds > 0
    np.testing.assert_array_equal(found.characteristics, list(direct.values()))
    assert list(direct) == list(CHARACTERISTICS)
    assert found.value("vertical.ride_rate") == direct["vertical.ride_rate"]
    assert np.isnan(found.value("steer.steering_ratio"))


def test_two_workers_change_nothing() -> None:
    with Campaign(AxleSolver(axle()), workers=1) as one, Campaign(AxleSolver(axle()), workers=2) as two:
        alone, shared = (c.evaluate(moved(5), "test") for c in (one, two))
    values = np.array([o.characteristics for o in alone])
    np.testing.assert_array_equal(values, [o.characteristics for o in shared])
    assert (np.diff(values[:, list(CHARACTERISTICS).index("vertical.bump_steer")]) < 0).all()


@pytest.mark.parametrize("workers", [1, 2])
def test_a_failure_is_a_value_with_its_reason(workers: int) -> None:
    with Campaign(AxleSolver(axle()), workers=workers) as campaign:
        good, bad, after = campaign.evaluate([{}, IMPOSSIBLE, {"LLF.z": 208.0}], "test")
    assert np.isnan(bad.characteristics).all() and len(bad.characteristics) == len(CHARACTERISTICS)
    assert "load case" in bad.reason and "last equilibrium at" in bad.reason and "over-centre" in bad.reason
    assert good.reason == after.reason == ""


@pytest.mark.parametrize("workers", [1, 2])
def test_a_path_that_is_not_there_is_bad_input(workers: int) -> None:
    with (
        Campaign(AxleSolver(axle()), workers=workers) as campaign,
        pytest.raises(InputError, match="unknown parameter"),
    ):
        campaign.evaluate([{}, {"LLF.z": 209.0}, {"LLF.q": 1.0}], "test")


def test_windows_reach_the_reduction() -> None:
    narrow, wide = (
        AxleSolver(axle(), {"vertical": w}).evaluate({}).value("vertical.ride_rate") for w in (5.0, 80.0)
    )
    assert abs(wide / narrow - 1.0) > 0.01


def test_the_fingerprint_knows_everything_but_windows() -> None:
    base = AxleSolver(nominal())
    same = AxleSolver(nominal(), {"vertical": 5.0}).prepare(moved(3))
    assert base.fingerprint() == same.fingerprint() == pickle.loads(pickle.dumps(base)).fingerprint()
    others = [
        with_values(nominal(), {"spring.rate": 26.0}),
        with_values(nominal(), {"right.LLR.y": 300.0}),
        with_values(nominal(), {"strut.flexibility": 0.1}),
        apply_effect(nominal(), "hub_compliance", {}, source="test"),
        replace(nominal(), follow={}),
        replace(nominal(), load_cases={**nominal().load_cases, "roll": ROLL_TECHNIQUES["counter_phase"]}),
        axle(),
    ]
    prints = {AxleSolver(a).fingerprint() for a in others}
    assert len(prints) == len(others) and base.fingerprint() not in prints


def test_a_topology_gets_programs_once_enough_designs_switch_to_it(monkeypatch: pytest.MonkeyPatch) -> None:
    built: list[bool] = []
    monkeypatch.setattr(own, "library_for", lambda topology, _: built.append(topology.strut_bending))
    solver = AxleSolver(axle()).prepare([{"strut.flexibility": 0.1}] * 3)
    assert built == [False] and len(solver.compiled) == 1
    solver = solver.prepare([{"strut.flexibility": 0.2}] * 3)
    assert built == [False, True] and len(solver.compiled) == 2
    assert solver.prepare([{}]).compiled == solver.compiled and len(built) == 2
