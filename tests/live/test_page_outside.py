"""The page of an outside solver in a real browser: dashed and solid, tasks, nothing left behind."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.live.outside import FAILS_ABOVE, outside_study
from tests.live.served import Served, serving
from tests.reports.chromium import BROWSER, Page

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(BROWSER is None, reason="Chromium is not installed, so no page can be opened"),
]
ROW = "live.rows.get('RIB.z')"
CONFIRMED = "document.body.dataset.confirming === 'no' && live.painted >= live.sent"
DASHES = "live.charts.map((c) => Boolean(c.plot.series.at(-1).dash))"


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder = tmp_path_factory.mktemp("outside")
    outside_study(folder, designs=14)
    with serving(folder / "out", "--port", "18470", study=folder) as process:
        yield process


@pytest.fixture(scope="module")
def page(served: Served, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    page = Page(tmp_path_factory.mktemp("profile"), width=1280)
    page.size(1280, 860)
    page.send("Page.navigate", url=served.address)
    page.wait("document.body && document.body.dataset.seq && live.influence")
    yield page
    page.close()


def children(pid: int) -> list[int]:
    """Processes that a process has started."""
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    return [int(child) for task in tasks for child in task.read_text().split()]


def gone(pid: int) -> bool:
    """Whether a process has ended."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return True
    return state == "Z"


def test_what_moves_is_dashed_and_what_was_asked_solid(page: Page) -> None:
    notice = page.run("document.getElementById('approximation').textContent")
    assert "surrogate of 14 stored designs" in notice and "Solid: the outside solver" in notice
    assert not any(page.run(DASHES)) and page.run("live.present.text.true")  # the start is stored
    assert page.run("document.getElementById('effects-box').hidden")
    page.run(f"{ROW}.range.value = {ROW}.slider.start + 0.5; {ROW}.range.dispatchEvent(new Event('input'))")
    page.wait("live.painted >= live.sent && live.present.text.true === false")
    assert all(page.run(DASHES)) and page.run("document.body.classList.contains('approximate')")
    page.run(f"{ROW}.range.dispatchEvent(new Event('change'))")
    page.wait("document.body.dataset.confirming === 'yes'")
    page.wait(CONFIRMED + " && live.present.text.true")
    page.wait(f"!({DASHES}).some(Boolean)")
    page.wait("document.getElementById('approximation').textContent.includes('of 15 stored designs')")


def test_a_design_that_the_solver_fails_on_keeps_the_last_good_one(page: Page) -> None:
    good = page.run("Array.from(live.present.drawn.subarray(0, 50))")
    value = f"{ROW}.slider.start + {FAILS_ABOVE + 0.5}"
    page.run(f"{ROW}.number.value = {value}; {ROW}.number.dispatchEvent(new Event('change'))")
    page.wait("live.present.text.failure")
    page.wait("!document.getElementById('failure').hidden")
    assert "the bridge fell down" in page.run("document.getElementById('failure').textContent")
    assert page.run("Array.from(live.present.drawn.subarray(0, 50))") == good
    page.run("document.getElementById('undo').click()")
    page.wait("document.getElementById('failure').hidden && live.present.text.true")


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="processes are read from /proc")
def test_a_task_is_shown_cancelled_and_ends_with_the_server(page: Page, served: Served) -> None:
    """Last: it kills the server."""
    page.run("document.getElementById('correlate').click()")
    page.wait("['correlate waiting', 'correlate running'].includes(document.body.dataset.task)")
    assert not page.run("document.getElementById('work').hidden")
    assert page.run("document.getElementById('discover').disabled")
    page.run("document.getElementById('work-cancel').focus()")
    page.key("Enter")
    page.wait("document.body.dataset.task === 'correlate failed'")
    assert "cancelled" in page.run("document.getElementById('work-words').textContent")
    page.run("document.getElementById('work-forget').click()")
    page.wait("document.getElementById('work').hidden")
    page.run("document.getElementById('correlate').click()")
    page.wait("['correlate waiting', 'correlate running'].includes(document.body.dataset.task)")
    (task,) = children(served.process.pid)
    assert page.errors == []
    served.process.kill()
    page.wait("document.body.dataset.connected === 'no'")
    end = time.monotonic() + 60.0
    while not gone(task):
        assert time.monotonic() < end
        time.sleep(0.1)
