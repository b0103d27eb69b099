"""Workers that are killed: nothing is lost but the design that kills."""

from __future__ import annotations

import os
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest

from doe_kc.campaign.processes import available_cores, start_context
from doe_kc.campaign.runner import Campaign
from doe_kc.ground.errors import RunError
from tests.campaign.toys import Toy, bump_steer, designs, runs_of

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


def test_a_worker_killed_once_costs_nothing(toy: Toy, tmp_path: Path) -> None:
    solver = replace(toy, kills_once=(4.0,), seconds=0.005)
    with Campaign(solver, tmp_path / "s", workers=2) as campaign:
        found = campaign.evaluate(designs(10), "test")
        assert campaign.runs == 10
    with Campaign(replace(toy, log=tmp_path / "calm"), workers=1) as campaign:
        assert bump_steer(found) == bump_steer(campaign.evaluate(designs(10), "test"))
    assert not any(o.failed for o in found)
    assert runs_of(solver).count(4.0) == 2


def test_a_design_that_kills_its_worker_is_a_failure(toy: Toy, tmp_path: Path) -> None:
    solver = replace(toy, kills=(4.0,), seconds=0.005)
    with Campaign(solver, tmp_path / "s", workers=2) as campaign:
        found = campaign.evaluate(designs(10), "test")
        assert [o.failed for o in found] == [d["x"] == 4.0 for d in designs(10)]
        assert "a worker process was ended from outside twice" in found[3].reason
        assert "fewer --workers" in found[3].reason
        assert runs_of(solver).count(4.0) == 2
        assert not any(o.failed for o in campaign.evaluate(designs(3, 20.0), "test"))
    with Campaign(solver, tmp_path / "s", workers=2) as campaign:
        assert campaign.evaluate(designs(10), "test")[3].failed and campaign.runs == 0


def test_two_killers_at_the_end(toy: Toy) -> None:
    with Campaign(replace(toy, kills=(5.0, 6.0)), workers=2) as campaign:
        found = campaign.evaluate(designs(6), "test")
    assert [o.failed for o in found] == [False] * 4 + [True] * 2


def test_when_every_worker_dies_no_design_is_blamed(toy: Toy, tmp_path: Path) -> None:
    solver = replace(toy, kills=tuple(d["x"] for d in designs(8)))
    with (
        pytest.raises(RunError, match=r"ended from outside time and again.*fewer --workers"),
        Campaign(solver, tmp_path / "s", workers=2) as campaign,
    ):
        campaign.evaluate(designs(8), "test")
    with Campaign(toy, tmp_path / "s", workers=1) as campaign:
        assert len(campaign.store) == 0


def test_a_pool_of_someone_elses_is_not_renewed(toy: Toy) -> None:
    pool: Executor = ProcessPoolExecutor(2, mp_context=start_context())
    solver = replace(toy, kills=(1.0,))
    alone = pytest.raises(RunError, match="a worker process was ended from outside, often")
    with pool, Campaign(solver, executor=pool) as campaign, alone:
        campaign.evaluate(designs(4), "test")


def test_there_is_a_core() -> None:
    assert 1 <= available_cores() <= (os.cpu_count() or 1)
