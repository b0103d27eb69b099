"""Batches of a quick solver: what one by one gives, and no more lost than a batch."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.campaign.record import LEFT_OUT
from doe_kc.campaign.runner import BATCH, Campaign
from doe_kc.campaign.store import open_store, read_store
from doe_kc.ground.errors import InputError, RunError
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.protocol import Values
from tests.campaign.test_curves_codec import assert_same
from tests.campaign.toys import Toy, bump_steer, designs, pids_of, runs_of

COUNT = 100
LONG_RUN = """
import sys
from pathlib import Path
from doe_kc.campaign.runner import Campaign
from tests.campaign.toys import Toy, designs
folder, workers = Path(sys.argv[1]), int(sys.argv[2])
with Campaign(Toy(folder / "log", quick=True, seconds=0.002), folder / "s", workers=workers) as campaign:
    campaign.evaluate(designs(2000), "test")
"""


@pytest.fixture
def quick(toy: Toy) -> Toy:
    return replace(toy, quick=True)


def evaluated(solver: Toy, workers: int, store: Path | None = None) -> list[Outcome]:
    with Campaign(solver, store, workers=workers) as campaign:
        return campaign.evaluate(designs(COUNT), "test")


@pytest.mark.parametrize("workers", [1, 2])
def test_failures_inside_a_batch_leave_their_neighbours_alone(quick: Toy, workers: int) -> None:
    solver = replace(quick, fails=(2.0, 40.0), breaks=(3.0,), poisons=(4.0, 90.0))
    batched = evaluated(solver, workers)
    one_by_one = evaluated(replace(solver, quick=False), 1)
    assert [i + 1 for i, o in enumerate(batched) if o.failed] == [2, 3, 4, 40, 90]
    assert [o.reason for o in batched] == [o.reason for o in one_by_one]
    for one, other in zip(batched, one_by_one, strict=True):
        np.testing.assert_array_equal(one.characteristics, other.characteristics)
        if one.curves is not None and other.curves is not None:
            assert_same(one.curves, other.curves)


@pytest.mark.parametrize(("workers", "size"), [(1, 25), (2, 12), (3, 8)])
def test_workers_share_the_designs_evenly(quick: Toy, workers: int, size: int) -> None:
    with Campaign(quick, workers=workers) as campaign:
        told: list[int] = []
        campaign.evaluate(designs(COUNT), "test", told.append)
        assert campaign._batch_size(COUNT) == size and campaign._batch_size(10**4) == BATCH
        assert (campaign.runs, sum(told)) == (COUNT, COUNT)
    assert len(pids_of(quick)) <= workers


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_a_design_that_kills_its_worker_takes_no_neighbour_with_it(quick: Toy) -> None:
    solver = replace(quick, kills=(7.0,))
    outcomes = evaluated(solver, 2)
    assert [i + 1 for i, o in enumerate(outcomes) if o.failed] == [7]
    assert "ended from outside" in outcomes[6].reason
    assert bump_steer(outcomes)[:6] == bump_steer(evaluated(quick, 1))[:6]


def test_bad_input_inside_a_batch_keeps_what_came_before(quick: Toy, tmp_path: Path) -> None:
    wanted = [*designs(COUNT), {"y": 1.0}, *designs(COUNT, 500.0)]
    with Campaign(quick, tmp_path / "s", workers=1) as campaign:
        with pytest.raises(InputError, match="unknown parameter 'y'"):
            campaign.evaluate(wanted, "test")
        assert len(campaign.store) == COUNT


@dataclass(frozen=True)
class SideBySide(Toy):
    """Solves many designs at once, or trips over it."""

    curves: bool = True
    fault: type[Exception] | None = None

    def evaluate_all(self, designs: Sequence[Values], *, curves: bool) -> list[Outcome]:
        if self.fault is not None:
            raise self.fault("lanes out of step")
        return [self.evaluate(values) for values in designs]


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize(("fault", "told"), [(ValueError, 1), (InputError, 0), (None, 0)])
def test_a_fault_of_solving_at_once_is_told_once_and_costs_time_alone(
    tmp_path: Path,
    caplog: pytest.LogCaptureFixture,
    workers: int,
    fault: type[Exception] | None,
    told: int,
) -> None:
    outcomes = evaluated(SideBySide(tmp_path / "log", quick=True, fault=fault), workers)
    assert bump_steer(outcomes) == bump_steer(evaluated(Toy(tmp_path / "other"), 1))
    warnings = [r.getMessage() for r in caplog.records]
    assert len(warnings) == told
    assert all("ValueError: lanes out of step" in w and "one by one" in w for w in warnings)


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize("workers", [1, 2])
def test_a_killed_campaign_loses_at_most_the_batches_under_way(tmp_path: Path, workers: int) -> None:
    process = subprocess.Popen([sys.executable, "-c", LONG_RUN, str(tmp_path), str(workers)])
    solver = Toy(tmp_path / "log", quick=True)
    while len(runs_of(solver)) < 5 * BATCH:
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    time.sleep(0.3 if workers > 1 else 0.0)  # workers see their parent's end
    made = len(runs_of(solver))
    with read_store(tmp_path / "s") as store:
        stored = [r.parameters["x"] for r in store.records()]
    under_way = 2 * workers if workers > 1 else 1
    assert stored and made - len(stored) <= under_way * BATCH
    with Campaign(solver, tmp_path / "s", workers=1) as campaign:
        campaign.evaluate(designs(2000), "test")
        assert campaign.runs == 2000 - len(stored)


def test_a_transaction_stores_all_or_nothing(toy: Toy, tmp_path: Path) -> None:
    evaluated(replace(toy, quick=True), 1, tmp_path / "s")
    with read_store(tmp_path / "s") as store:
        first, second, *_ = store.records()
    with open_store(tmp_path / "t", toy) as store:
        faulty = replace(second, origin=None)  # type: ignore[arg-type]  # against the table's NOT NULL
        with pytest.raises(RunError, match="cannot be read or written"):
            store.put_all([first, faulty])
        assert len(store) == 0
        store.put_all([first, second])
        assert len(store) == 2


def test_curves_that_are_not_kept_are_run_again_when_asked_for(quick: Toy, tmp_path: Path) -> None:
    def campaign(solver: Toy, *, keep: bool) -> Campaign:
        return Campaign(solver, tmp_path / "s", workers=1, stored_curves="all" if keep else "none")

    with campaign(quick, keep=False) as running:
        slim = running.evaluate(designs(COUNT), "test", curves=False)
        assert {r.packed.curves for r in running.store.records()} == {LEFT_OUT}
        assert running.evaluate(designs(3), "test")[0].curves is None and running.runs == COUNT
    assert bump_steer(slim) == bump_steer(evaluated(quick, 1))
    with campaign(quick, keep=True) as running:
        assert bump_steer(running.evaluate(designs(COUNT), "test", curves=False)) == bump_steer(slim)
        assert running.runs == 0
        assert running.evaluate(designs(3), "test")[2].curves is not None and running.runs == 3
    wide = replace(quick, windows={"vertical": 60.0})
    with campaign(wide, keep=True) as running:
        again = running.evaluate(designs(5), "test", curves=False)
        assert running.runs == 2  # the first three have their curves
        record = list(running.store.records())[-1]
        with pytest.raises(InputError, match="sample again with --curves all"):
            running.store.read(replace(record, packed=replace(record.packed, curves=LEFT_OUT)), {})
    assert bump_steer(again) == bump_steer(evaluated(wide, 1))[:5]
