"""Large arrays of a task and its result by way of shared memory, and all else through the pipe."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import dataclass, replace
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import doe_kc.campaign.processes as processes_module
import doe_kc.campaign.shared_arrays as shared_module
from doe_kc.campaign.processes import Processes
from doe_kc.campaign.shared_arrays import (
    COMMON_KEPT,
    SHARED_FROM,
    SharedArguments,
    SharedResult,
    called_with,
    shared_arguments,
)
from doe_kc.ground.fields_only import CommonArgument
from doe_kc.ground.typing import FloatArray

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere arguments go through the pipe")
LARGE = np.arange(SHARED_FROM // 4, dtype=float).reshape(-1, 4)


def told(large: FloatArray, rest: Mapping[str, Any], *, offset: float = 0.0) -> tuple[FloatArray, Any, int]:
    large += offset  # of its own
    return large[::1000].copy(), {k: np.asarray(v).tolist() for k, v in rest.items()}, os.getpid()


REST = {"small": np.arange(3), "middle": np.ones(2000), "columns": np.asfortranarray(LARGE[:9]), "word": "a"}


def test_a_task_gets_the_arguments_that_it_was_given() -> None:
    shared = shared_arguments((LARGE, REST), {"offset": 2.0})
    assert shared is not None and len(shared.content.rest) < SHARED_FROM // 100
    part, rest, _ = called_with(told, shared.content)
    np.testing.assert_array_equal(part, LARGE[::1000] + 2.0)
    assert rest == told(LARGE.copy(), REST)[1]
    assert LARGE[0, 0] == 0.0
    shared.close()
    assert not Path(shared.content.memory.path).exists()


def test_small_arguments_and_such_as_cannot_be_sent_are_left_to_the_pool() -> None:
    assert shared_arguments((REST,), {}) is None
    assert shared_arguments((LARGE, lambda: 0), {}) is None


@pytest.mark.parametrize("lacks", ["memory", "/proc"])
def test_where_there_is_no_memory_to_share_the_pipe_serves(
    lacks: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    if lacks == "memory":
        monkeypatch.setattr(os, "memfd_create", full)
    else:
        monkeypatch.setattr(shared_module, "OPEN_FILES", str(tmp_path / "{}"))
    assert shared_arguments((LARGE,), {}) is None
    executor = Processes(1)
    assert executor.submit(told, LARGE, REST).result()[2] != os.getpid()
    executor.shutdown()


@pytest.mark.parametrize("fails", [False, True])
def test_the_memory_of_a_task_goes_with_it(fails: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a worker process, whether the task ends well or not."""
    made: list[SharedArguments] = []

    def noted(args: tuple[Any, ...], kwargs: Mapping[str, Any]) -> SharedArguments | None:
        shared = shared_arguments(args, kwargs)
        made.extend([shared] if shared else [])
        return shared

    monkeypatch.setattr(processes_module, "shared_arguments", noted)
    executor = Processes(2)
    futures = [executor.submit(told, LARGE, REST, offset="x" if fails else float(i)) for i in range(5)]
    for i, future in enumerate(futures):
        if fails:
            assert future.exception() is not None
        else:
            np.testing.assert_array_equal(future.result()[0], LARGE[::1000] + i)
    executor.shutdown()
    assert len(made) == 5
    assert not any(Path(shared.content.memory.path).exists() for shared in made)


def doubled(large: FloatArray) -> dict[str, Any]:
    return {"large": 2.0 * large, "columns": np.asfortranarray(3.0 * large), "word": "b"}


def test_a_large_result_comes_back_in_the_memory_of_its_arguments() -> None:
    shared = shared_arguments((LARGE,), {})
    assert shared is not None
    result = called_with(doubled, shared.content)
    assert isinstance(result, SharedResult) and result.content.start >= LARGE.nbytes
    sent = ForkingPickler.dumps(result)
    assert len(sent) < SHARED_FROM // 100
    received = ForkingPickler.loads(sent)
    shared.close()
    assert received["word"] == "b" and received["columns"].flags.f_contiguous
    np.testing.assert_array_equal(received["large"], 2.0 * LARGE)
    np.testing.assert_array_equal(received["columns"], 3.0 * LARGE)
    executor = Processes(2)
    for future in [executor.submit(doubled, LARGE + i) for i in range(4)]:
        assert future.result()["large"].flags.writeable
    executor.shutdown()
    assert not open_files()


def test_a_result_that_comes_too_late_spoils_no_other_file(tmp_path: Path) -> None:
    """After the loss of a worker the memory's number may be that of another file; the pipe serves."""
    shared, other = shared_arguments((LARGE,), {}), tmp_path / "other"
    assert shared is not None
    number = shared.number

    def late(_: FloatArray) -> FloatArray:
        with other.open("wb") as file:
            os.dup2(file.fileno(), number)
        return LARGE

    assert called_with(late, shared.content) is LARGE
    shared.close()
    assert other.read_bytes() == b""


def leave(_: FloatArray) -> None:
    os._exit(1)


def test_the_memory_goes_where_a_worker_was_lost() -> None:
    """Of the task that it did, and of the one that the broken pool refuses."""
    before, executor = open_files(), Processes(1)
    with pytest.raises(BrokenProcessPool):
        executor.submit(leave, LARGE).result()
    with pytest.raises(BrokenProcessPool):
        executor.submit(told, LARGE, REST)
    executor.shutdown()
    assert open_files() <= before


@dataclass(frozen=True)
class Records(CommonArgument):
    values: FloatArray
    word: str = "a"


def place_of(records: Records, _: Any = None) -> tuple[int, int, float, str]:
    """Of the array in the process that has it, and what it holds."""
    return os.getpid(), records.values.ctypes.data, float(records.values.sum()), records.word


def test_a_common_argument_is_kept_by_the_process_that_had_it() -> None:
    records, executor = Records(LARGE), Processes(1)
    first = executor.submit(place_of, records).result()
    sent = shared_arguments((records, LARGE), {})
    assert sent is not None and sum(sent.content.sizes) == LARGE.nbytes and len(sent.copies) == 1
    sent.close()
    assert executor.submit(place_of, records, LARGE).result() == first
    other = replace(records, values=LARGE + 1.0, word="b")
    assert executor.submit(place_of, other).result()[2:] == (float((LARGE + 1.0).sum()), "b")
    assert executor.submit(place_of, records).result() == first
    for i in range(COMMON_KEPT):
        executor.submit(place_of, Records(LARGE + i)).result()
    assert executor.submit(place_of, records).result()[2:] == first[2:]
    executor.shutdown()


def test_the_copy_of_a_common_argument_goes_with_it_and_not_before_its_tasks() -> None:
    before, records = open_files("copy"), Records(LARGE)
    sent = shared_arguments((records,), {})
    assert sent is not None and len(open_files("copy") - before) == 1
    del records
    assert called_with(place_of, sent.content)[2] == float(LARGE.sum())
    sent.close()
    del sent
    assert open_files("copy") <= before


def test_a_small_one_goes_with_every_task_and_so_does_one_that_finds_no_room(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    small = shared_arguments((Records(LARGE[:1]), LARGE), {})
    assert small is not None and not small.copies
    small.close()
    create = os.memfd_create
    monkeypatch.setattr(os, "memfd_create", lambda name: full(name) if name == "copy" else create(name))
    large = shared_arguments((Records(LARGE),), {})
    assert large is not None and not large.copies and sum(large.content.sizes) == LARGE.nbytes
    assert called_with(place_of, large.content)[2] == float(LARGE.sum())
    large.close()


def full(_name: str) -> int:
    raise OSError(28, "no space")


def open_files(name: str = "arguments") -> set[str]:
    """Of this process, those that are shared under a name."""
    links = set()
    for path in Path("/proc/self/fd").iterdir():
        with suppress(OSError):  # of the folder itself
            links.add(f"{path.name} {path.readlink()}")
    return {link for link in links if name in link}
