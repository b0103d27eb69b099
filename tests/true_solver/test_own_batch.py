"""Designs side by side behind the protocol: outcomes of each alone, failures and their reasons among them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import Axle
from doe_kc.campaign.record import LEFT_OUT
from doe_kc.campaign.runner import Campaign
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError
from doe_kc.solver.library import find_compiler
from doe_kc.true_solver import own, own_batch
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.own import AxleSolver
from doe_kc.true_solver.protocol import BatchSolver, Values
from tests.reference import nominal

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
IMPOSSIBLE = {"LWB.z": 2000.0}


@pytest.fixture(autouse=True)
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own, "BATCH_FROM", 8)


def axle() -> Axle:
    """Three load cases only."""
    cases = nominal().load_cases
    return replace(nominal(), load_cases={i: cases[i] for i in ("vertical", "roll", "brake")})


def moved(count: int) -> list[dict[str, float]]:
    return [{"LLF.z": 204.0 + 0.5 * i, "spring.rate": 28.0 + 0.1 * i} for i in range(count)]


def assert_same(one: Outcome, other: Outcome) -> None:
    assert one.reason == other.reason
    np.testing.assert_allclose(one.characteristics, other.characteristics, rtol=1e-9, atol=1e-9)
    if one.curves is None or other.curves is None:
        assert one.curves is other.curves
        return
    assert one.curves.half_track == other.curves.half_track
    for name, angles in (other.curves.static or {}).items():
        np.testing.assert_allclose((one.curves.static or {})[name], angles, atol=1e-9)
    for ident, case in other.curves.cases.items():
        for name in case.mean:
            np.testing.assert_allclose(
                one.curves.cases[ident].mean[name], case.mean[name], rtol=1e-9, atol=1e-9
            )


@pytest.mark.parametrize("curves", [True, False])
def test_outcomes_are_those_of_each_alone(curves: bool) -> None:
    designs: list[Values] = [*moved(9), IMPOSSIBLE, *moved(2), {}]
    solver = AxleSolver(axle(), {"vertical": 15.0}, curves=curves).prepare(designs)
    assert isinstance(solver, BatchSolver) and solver.batched == {axle().topology}
    found = solver.evaluate_all(designs, curves=True)
    assert [o.failed for o in found] == [design is IMPOSSIBLE for design in designs]
    for one, design in zip(found, designs, strict=True):
        assert_same(one, solver.evaluate(design))


def test_what_a_rig_reads_of_each_has_its_faults() -> None:
    faulty = apply_effect(axle(), "rig_channel_gain", {"toe": 1.5}, source="test")
    solver = AxleSolver(faulty).prepare(moved(8))
    for one, design in zip(solver.evaluate_all(moved(8), curves=True), moved(8), strict=True):
        assert_same(one, solver.evaluate(design))


def test_a_topology_of_few_designs_and_a_machine_without_compiler_go_one_by_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    few: list[Values] = [*moved(8), {"strut.flexibility": 1.0}]
    solver = AxleSolver(axle()).prepare(few)
    assert solver.batched == {axle().topology}
    assert not solver.evaluate_all(few, curves=False)[-1].failed
    assert not solver.prepare(moved(7)).batched
    monkeypatch.setenv("DOE_KC_COMPILE", "0")
    own_batch.adaptive_batch.cache_clear()
    assert not AxleSolver(axle()).prepare(moved(8)).batched


def test_bad_input_keeps_what_came_before_it(tmp_path: Path) -> None:
    designs: list[Values] = [*moved(10), {"LLF.q": 1.0, "spring.rate": 28.0}]
    with Campaign(AxleSolver(axle()), tmp_path / "s", workers=1, stored_curves="none") as campaign:
        assert campaign.runs == 0
        with pytest.raises(InputError, match=r"LLF\.q"):
            campaign.evaluate(designs, "test", curves=False)
    solver = AxleSolver(axle()).prepare(moved(10))
    with pytest.raises(InputError, match="expected a number > 0"):
        solver.evaluate_all([*moved(3), {"LLF.z": 208.0, "spring.rate": -1.0}], curves=False)
    with Campaign(AxleSolver(axle()), tmp_path / "t", workers=1) as campaign:
        with pytest.raises(InputError, match="expected a number > 0"):
            campaign.evaluate([*moved(10), {"LLF.z": 208.0, "spring.rate": -1.0}], "test", curves=False)
        assert len(campaign.store) == 10


@pytest.mark.parametrize("keep", [True, False])
def test_a_campaign_stores_what_was_asked_for(keep: bool) -> None:
    with Campaign(AxleSolver(axle()), workers=1, stored_curves="all" if keep else "none") as campaign:
        campaign.evaluate([*moved(20), IMPOSSIBLE], "test", curves=False)
        records = list(campaign.store.records())
    assert [r.status for r in records] == ["ok"] * 20 + ["failed"]
    assert all((r.packed.curves != LEFT_OUT) == keep for r in records[:20])
    assert records[20].packed.curves is None
    solver = AxleSolver(axle(), curves=False)
    with Campaign(solver, workers=1) as campaign:
        campaign.evaluate(moved(20), "test", curves=False)
        assert {r.packed.curves for r in campaign.store.records()} == {None}
