"""Correlate and discover beside a page: the commands' own code, cancelled, adopted as a step."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

from doe_kc.axle.model import Axle
from doe_kc.campaign.store import read_store
from doe_kc.ground.errors import InputError
from doe_kc.live import background
from doe_kc.live.background_queue import BackgroundQueue, TaskStatus
from doe_kc.live.background_work import BackgroundWork
from doe_kc.live.documents import work_document
from doe_kc.live.model import live_model
from doe_kc.live.session import Session
from doe_kc.live.tasks import News, TaskFailure, TaskProgress, TaskRequest, TaskResult, task_request
from doe_kc.study import Study, read_study
from doe_kc.workflow.adopt import AdoptedEffect, Adoption
from doe_kc.workflow.correlate import correlate
from doe_kc.workflow.measure import study_records
from tests.live.cases import EXAMPLES, RIG, say

STUDY = """
schema = "doe_kc.study/1"
axle = "{axle}"
measurement = "{records}"
variables = {{ use = ["*"] }}
correlation = {{ method = "gauss_newton", budget = 4 }}
"""
PATIENCE = 120.0
HUB = {"camber_Nm_deg": 5000.0, "toe_Nm_deg": 9000.0}
PRELOAD = {"LLR[0]": 0.0, "LLR[1]": 200.0, "LLR[2]": 0.0}
FRICTION = {"force_N": 80.0, "presliding_mm": 0.2}


def adoption_of(axle: Axle) -> Adoption:
    """Two effects, one by another law than its own, and a fault of the measurement."""
    effects = (
        AdoptedEffect("hub_compliance", None, HUB, uncertain=False),
        AdoptedEffect("strut_friction", None, {**FRICTION, "law": "iwan"}, uncertain=False),
        AdoptedEffect("rig_channel_gain", "toe", {"toe": 1.05}, uncertain=False),
    )
    return Adoption(axle, effects, {"LLF.z": 212.5}, frozenset())


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("background")
    words = {"axle": EXAMPLES / "front_axle" / "axle.toml", "records": RIG / "car_b"}
    (folder / "study.toml").write_text(STUDY.format(**words), encoding="utf-8")
    return read_study(folder)


@pytest.fixture(scope="module")
def shared(study: Study) -> Session:
    return Session(live_model(study, study_records(study)))


@pytest.fixture
def live(shared: Session) -> Session:
    """The session at its start, as a page finds it that was just opened."""
    while shared.can_undo:
        say(shared, kind="undo")
    shared.result = None
    return shared


def until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not true():
        assert time.monotonic() < end
        time.sleep(0.02)


def work_on(live: Session) -> BackgroundWork:
    return BackgroundWork(live, lambda job: job(), lambda: None, lambda: None)


def test_a_correlation_is_the_commands_and_adopted_as_a_step(live: Session, study: Study) -> None:
    """In a process of its own; the same study correlated here then has all its designs stored."""
    work = work_on(live)
    work.begin("correlate")
    with pytest.raises(InputError, match="still at work"):
        work.begin("discover")
    until(lambda: work.status is not None and work.status.ended)
    work.close()
    document = work_document(work)["task"]
    assert document["state"] == "done" and document["adoptable"], document
    with read_store(study.store) as store:
        stored = len(store)
    own = correlate(study, study_records(study), workers=1)
    with read_store(study.store) as store:
        assert len(store) == stored
    before = live.values()
    assert say(live, kind="adopt", seq=7).solve
    live.solve_now()
    after = live.values()
    assert {p: after[p] for p in own.values} == pytest.approx(own.values, rel=1e-12)
    assert live.present.gap < live.nominal.gap
    say(live, kind="undo")
    assert live.values() == before
    work.forget()
    assert work.status is None and live.result is None


def test_locked_sliders_bounds_and_effects_hold(live: Session, study: Study) -> None:
    start = live.values()
    say(live, kind="move", seq=1, path="ROB.z", value=start["ROB.z"] + 1.0)
    say(live, kind="lock", paths=["ROB.z", "LLF.z"], on=True)
    edge = start["RIB.z"] + 0.25
    say(live, kind="bounds", path="RIB.z", lower=start["RIB.z"] - 0.25, upper=edge)
    say(live, kind="effect", name="bushing_preload LLR", sizes=PRELOAD)
    request = _request_of(live)
    told: list[tuple[str, int, int]] = []
    result = background.correlated_result(study, request, lambda *news: told.append(news))
    assert result.values["ROB.z"] == start["ROB.z"] + 1.0 and result.values["LLF.z"] == start["LLF.z"]
    assert abs(result.values["RIB.z"] - start["RIB.z"]) <= 0.25 + 1e-9
    assert told and told[-1][2] == 4
    live.result = result
    say(live, kind="adopt")
    assert live.state.effects == {"bushing_preload LLR": PRELOAD}
    live.compilation.wait()


def _request_of(live: Session) -> TaskRequest:
    """What the page would hand to a process."""
    requests: list[TaskRequest] = []
    work = work_on(live)
    work.queue.put = requests.append  # type: ignore[method-assign]
    work.begin("correlate")
    return requests[0]


def test_a_discovery_is_adopted_with_its_effects(
    live: Session, study: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: dict[str, Any] = {}

    def canned(asked: Study, _records: object, **options: Any) -> object:
        seen.update(options, axle=asked.axle)
        return None

    monkeypatch.setattr(background, "discover_study", canned)
    monkeypatch.setattr(background, "discovery_lines", lambda _: ["Two effects."])
    monkeypatch.setattr(background, "adopt", lambda *_: adoption_of(study.axle))
    request = task_request(study, "discover", exclude=("strut_friction",))
    result = background.discovered_result(study, request, lambda *_: None)
    assert seen["exclude"] == ["strut_friction"] and seen["axle"] is study.axle
    assert result.adoptable and "measuring channel" in result.lines[-1]  # a fault of the measurement
    assert result.effects == {"hub_compliance": HUB, "strut_friction, iwan": FRICTION}
    live.result = result
    before = live.state
    assert say(live, kind="adopt").sliders
    assert live.model.axle.effects == {"hub_compliance": HUB, "strut_friction": {**FRICTION, "law": "iwan"}}
    assert live.values()["LLF.z"] == 212.5
    say(live, kind="undo")
    assert live.state is before
    live.compilation.wait()


def test_a_task_is_cancelled_and_the_next_one_begins(study: Study) -> None:
    told: list[tuple[str, News]] = []
    ended = threading.Event()

    def listen(request: TaskRequest, news: News) -> None:
        told.append((request.task, news))
        if not isinstance(news, TaskProgress):
            ended.set()

    queue = BackgroundQueue(listen)
    assert not queue.cancel_task()
    queue.put(task_request(study, "discover"))
    assert queue.running is not None and queue.cancel_task()
    assert ended.wait(PATIENCE)
    task, news = told[-1]
    assert task == "discover" and isinstance(news, TaskFailure)
    assert news.reason.startswith("cancelled"), news.reason
    until(lambda: queue.running is None)
    queue.close()


def test_a_study_that_cannot_be_read_is_said(study: Study) -> None:
    told: list[News] = []
    queue = BackgroundQueue(lambda _, news: told.append(news))
    request = task_request(study, "correlate").model_copy(update={"study": "/nowhere/study.toml"})
    queue.put(request)
    until(lambda: bool(told))
    assert isinstance(told[0], TaskFailure) and "/nowhere/study.toml" in told[0].reason
    queue.close()


def test_the_status_tells_rate_and_time_left() -> None:
    status = TaskStatus("correlate", "waiting", "begins", time.monotonic() - 10.0)
    running = status.after(TaskProgress(words="correlating", done=20, total=50))
    assert running.state == "running" and running.rate == pytest.approx(2.0, rel=0.05)
    assert running.left == pytest.approx(15.0, rel=0.05)
    done = running.after(TaskResult(lines=["Sound."]))
    assert done.ended and done.words == "Sound." and done.seconds >= 10.0
    assert running.after(TaskFailure(reason="no store")).words == "no store"


def test_without_a_result_nothing_is_adopted(live: Session) -> None:
    with pytest.raises(InputError, match="no result to adopt"):
        say(live, kind="adopt")
    live.result = TaskResult(lines=[], adoptable=True, values={"LLF.q": 1.0})
    with pytest.raises(InputError, match=r"LLF\.q: is set by the result and no slider"):
        say(live, kind="adopt")
