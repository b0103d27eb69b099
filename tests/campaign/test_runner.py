"""Campaigns: each design once, in order, failures as values, the same over any executor."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.campaign.runner import Campaign
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import InputError
from doe_kc.true_solver.outcome import Outcome
from tests.campaign.test_curves_codec import assert_same
from tests.campaign.toys import Toy, bump_steer, designs, pids_of, runs_of, toy_curves


def evaluated(toy: Toy, wanted: list[dict[str, float]], **options: object) -> list[Outcome]:
    with Campaign(toy, **options) as campaign:  # type: ignore[arg-type]
        return campaign.evaluate(wanted, "test")


def test_outcomes_are_in_the_order_asked(toy: Toy) -> None:
    wanted = [{"x": x} for x in (3.0, 1.0, 2.0)]
    found = evaluated(toy, wanted, workers=1)
    small = [1000.0 * x for x in (3.0, 1.0, 2.0)]
    assert np.array(bump_steer(found)) / small == pytest.approx([1.0] * 3, rel=0.1)
    for design, outcome in zip(wanted, found, strict=True):
        assert outcome.curves is not None and not outcome.failed
        assert_same(outcome.curves, toy_curves(design["x"]))
        assert len(outcome.characteristics) == len(CHARACTERISTICS)


def test_each_design_is_run_once(toy: Toy, tmp_path: Path) -> None:
    told: list[int] = []
    wanted = [*designs(3), {"x": 0.1 + 0.2}, {"x": 0.3}, *designs(3)]
    with Campaign(toy, tmp_path / "s", workers=1) as campaign:
        first = campaign.evaluate(wanted, "one", told.append)
        assert sorted(runs_of(toy)) == [0.1 + 0.2, 1.0, 2.0, 3.0]
        assert (campaign.runs, campaign.asked, sum(told)) == (4, 8, 8)
        campaign.evaluate(wanted[:2], "two", told.append)
        assert (campaign.runs, campaign.asked, sum(told)) == (4, 10, 10)
        assert {r.origin for r in campaign.store.records()} == {"one"}
    again = evaluated(toy, wanted, store=tmp_path / "s")
    assert len(runs_of(toy)) == 4
    np.testing.assert_array_equal(bump_steer(first), bump_steer(again))
    assert evaluated(toy, [], store=tmp_path / "s") == []


def test_the_number_of_workers_changes_nothing(toy: Toy) -> None:
    solver = replace(toy, fails=(2.0, 5.0), poisons=(3.0,))
    alone, shared = (evaluated(solver, designs(9), workers=w) for w in (1, 2))
    with ThreadPoolExecutor(3) as threads:
        threaded = evaluated(solver, designs(9), executor=threads)
        threads.submit(int).result()
    for other in (shared, threaded):
        np.testing.assert_array_equal(bump_steer(alone), bump_steer(other))
        assert [o.reason for o in alone] == [o.reason for o in other]
        for one, two in zip(alone, other, strict=True):
            assert (one.curves is None) == (two.curves is None)
            if one.curves is not None and two.curves is not None:
                assert_same(one.curves, two.curves)


def test_a_third_of_the_designs_fails(toy: Toy, tmp_path: Path) -> None:
    bad = tuple(float(x) for x in range(3, 31, 3))
    solver = replace(toy, fails=bad)
    found = evaluated(solver, designs(30), store=tmp_path / "s", workers=2)
    assert [i + 1.0 for i, o in enumerate(found) if o.failed] == list(bad)
    assert all(np.isnan(o.characteristics).all() and o.curves is None for o in found if o.failed)
    assert found[2].reason == "no equilibrium at x = 3"
    evaluated(solver, designs(30), store=tmp_path / "s", workers=2)
    assert len(runs_of(solver)) == 30


def test_stored_failures_run_again_only_when_asked(toy: Toy, tmp_path: Path) -> None:
    evaluated(replace(toy, fails=(2.0,)), designs(3), store=tmp_path / "s", workers=1)
    with Campaign(toy, tmp_path / "s", workers=1, retry_failed=True) as campaign:
        assert not any(o.failed for o in campaign.evaluate(designs(3), "again"))
        assert campaign.runs == 1
    still = replace(toy, fails=(9.0,))
    with Campaign(still, tmp_path / "s", workers=1, retry_failed=True) as campaign:
        for _ in range(3):
            assert campaign.evaluate([{"x": 9.0}], "again")[0].failed
        assert campaign.runs == 1


def test_numbers_that_are_none_are_a_failure_with_a_name(toy: Toy, tmp_path: Path) -> None:
    solver = replace(toy, poisons=(2.0,))
    found = evaluated(solver, designs(3), store=tmp_path / "s", workers=1)[1]
    assert found.reason == "response not finite: load case vertical, toe at input -80 mm"
    assert found.curves is None


def test_a_solver_that_raises_fails_at_that_design(toy: Toy) -> None:
    found = evaluated(replace(toy, breaks=(2.0,)), designs(3), workers=1)
    assert [o.reason for o in found] == ["", "toy raised ZeroDivisionError: by x", ""]


@pytest.mark.parametrize("workers", [1, 2])
def test_bad_input_ends_the_campaign_and_keeps_what_is_done(toy: Toy, tmp_path: Path, workers: int) -> None:
    with Campaign(toy, tmp_path / "s", workers=workers) as campaign:
        with pytest.raises(InputError, match="unknown parameter 'y'"):
            campaign.evaluate([*designs(4), {"y": 1.0}, *designs(1, 50.0)], "test")
        assert len(campaign.store) >= 1
        assert not any(o.failed for o in campaign.evaluate(designs(6), "test"))
        with pytest.raises(InputError, match="x = nan"):
            campaign.evaluate([{"x": math.nan}], "test")


def test_other_windows_are_read_off_the_stored_curves(toy: Toy, tmp_path: Path) -> None:
    evaluated(toy, designs(2), store=tmp_path / "s", workers=1)
    for width in (10.0, 60.0):
        wide = replace(toy, windows={"vertical": width}, log=tmp_path / "other")
        again = evaluated(wide, designs(2), store=tmp_path / "s", workers=1)
        fresh = evaluated(replace(wide, log=tmp_path / "third"), designs(2), workers=1)
        assert not runs_of(wide)
        np.testing.assert_array_equal(bump_steer(again), bump_steer(fresh))
        assert bump_steer(again)[0] == pytest.approx(1000.0 * (1.0 + 0.6e-4 * width**2), rel=0.06)


def test_without_curves_characteristics_stay_as_given(toy: Toy, tmp_path: Path) -> None:
    plain = replace(toy, with_curves=False)
    first = evaluated(plain, designs(2), store=tmp_path / "s", workers=1)
    other = replace(plain, windows={"vertical": 60.0})
    again = evaluated(other, designs(2), store=tmp_path / "s", workers=1)
    assert len(runs_of(plain)) == 2 and again[0].curves is None
    np.testing.assert_array_equal(bump_steer(first), bump_steer(again))


def test_curves_can_stay_in_the_store(toy: Toy) -> None:
    with Campaign(toy, workers=1) as campaign:
        slim, full = (campaign.evaluate(designs(1), "test", curves=c)[0] for c in (False, True))
    assert slim.curves is None and full.curves is not None
    np.testing.assert_array_equal(slim.characteristics, full.characteristics)


def test_the_workers_stay_for_many_small_calls(toy: Toy) -> None:
    with Campaign(toy, workers=2) as campaign:
        for i in range(10):
            campaign.evaluate(designs(3, 10.0 * i), "test")
    assert len(pids_of(toy)) <= 2 and os.getpid() not in pids_of(toy)


def test_one_or_two_quick_designs_stay_in_this_process(toy: Toy) -> None:
    quick = replace(toy, quick=True)
    with Campaign(quick, workers=2) as campaign:
        campaign.evaluate(designs(2), "test")
        assert pids_of(quick) == {os.getpid()}
        campaign.evaluate(designs(3, 10.0), "test")
    assert len(pids_of(quick)) in (2, 3)
