"""The live page in headless Chromium: slider event to painted frame, updates in a drag, memory, two tabs.

Eight curves and the axle are painted, all load cases are solved. The time of an update runs from the slider's
input event to the first task after the animation frame in which its answer is painted; its first part, until
the answer has arrived, is told beside it.

    python benchmarks/live_page.py [--example NAME] [--events N] [--seconds S] [--updates N]
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
from _common import ROOT, machine, publish

from tests.live.served import Served, serving
from tests.reports.chromium import Page

ONE_BY_ONE = """(async () => {
  const row = live.rows.get(live.order[0]), s = row.slider, out = [];
  const frame = () => new Promise(requestAnimationFrame);
  for (let k = 0; k < %d; k += 1) {
    await frame();
    row.range.value = s.start + (k %% 2 ? 0.3 : -0.3) * (s.upper - s.start) * (1 + k / 1e3);
    const begin = performance.now();
    row.range.dispatchEvent(new Event("input"));
    while (live.shown < live.sent) await new Promise((r) => setTimeout(r, 1));
    out.push([live.shownAt - begin, live.arrivedAt - begin]);
  }
  return out;
})()"""
DRAG = """(async () => {
  const row = live.rows.get(live.order[0]), s = row.slider, before = live.paints, begin = performance.now();
  let k = 0, seen = new Set();
  while (performance.now() - begin < %d) {
    row.range.value = s.start + 0.5 * (s.upper - s.start) * Math.sin(k / 30);
    row.range.dispatchEvent(new Event("input"));
    k += 1;
    await new Promise(requestAnimationFrame);
    seen.add(live.painted);
  }
  return [seen.size, k, performance.now() - begin];
})()"""
MANY = """(async () => {
  const row = live.rows.get(live.order[0]), s = row.slider;
  for (let k = 0; k < %d; k += 1) {
    row.range.value = s.start + 0.5 * (s.upper - s.start) * Math.sin(k / 30);
    row.range.dispatchEvent(new Event("input"));
    while (live.painted < live.sent) await new Promise(requestAnimationFrame);
  }
  return live.paints;
})()"""


def evaluated(page: Page, script: str, patience: float = 3600.0) -> object:
    """Value of a promise in the page; polled, so that no answer is waited for longer than a moment."""
    page.run(f"window.done = undefined; {script}.then((v) => {{ window.done = v; }}); 0")
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if (value := page.run("window.done === undefined ? null : window.done")) is not None:
            return value
        time.sleep(0.2)
    raise TimeoutError(script[:40])


def opened(served: Served, folder: Path) -> Page:
    """The page in a fresh browser, at rest."""
    page = Page(folder, width=1280)
    page.size(1280, 860)
    page.send("Page.navigate", url=served.address)
    page.wait("document.body && document.body.dataset.seq && live.influence")
    time.sleep(1.0)
    return page


def resident(pid: int) -> float:
    """MB of a process."""
    status = Path(f"/proc/{pid}/status").read_text()
    return int(next(line for line in status.splitlines() if line.startswith("VmRSS")).split()[1]) / 1024.0


def heap(page: Page) -> float:
    """MB that the page's scripts hold, garbage collected first."""
    page.send("HeapProfiler.collectGarbage")
    return float(page.send("Runtime.getHeapUsage")["usedSize"]) / 2**20


def _row(what: str, times: np.ndarray) -> str:
    return f"| {what} | {np.median(times):.0f} ms | {np.quantile(times, 0.95):.0f} ms |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--example", default="front_axle")
    parser.add_argument("--events", type=int, default=300, help="moves one by one")
    parser.add_argument("--seconds", type=float, default=10.0, help="of dragging")
    parser.add_argument("--updates", type=int, default=2000, help="for the growth of memory")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        with serving(folder, "--port", "18550", study=ROOT / "examples" / given.example) as served:
            page = opened(served, folder / "one")
            evaluated(page, ONE_BY_ONE % 20)
            times = np.array(evaluated(page, ONE_BY_ONE % given.events))
            seen, events, milliseconds = np.array(evaluated(page, DRAG % int(1000 * given.seconds)))
            evaluated(page, MANY % (given.updates // 5))  # caches and pools have their size by then
            before = resident(served.process.pid), heap(page)
            evaluated(page, MANY % given.updates)
            after = resident(served.process.pid), heap(page)
            other = opened(served, folder / "two")
            both = np.array(evaluated(page, ONE_BY_ONE % (given.events // 3)))
            other.wait(f"live.painted >= {page.run('live.painted')}")
            errors = page.errors + other.errors
            other.close()
            page.close()
    lines = [
        f"# Live page, {given.example}",
        "",
        f"{machine()}; load {' '.join(Path('/proc/loadavg').read_text().split()[:2])}; headless Chromium.",
        "",
        "| what | median | 95 % |",
        "|---|---|---|",
        _row(f"slider event to painted frame, {len(times)} moves", times[:, 0]),
        _row("slider event to arrival of the answer", times[:, 1]),
        _row("painted frame, with a second tab in another browser", both[:, 0]),
        "",
        f"Drag of {milliseconds / 1000:.0f} s: {events:.0f} events, "
        f"{seen / milliseconds * 1000:.0f} full updates a second.",
        "",
        f"Memory over {given.updates} updates: server {before[0]:.1f} to {after[0]:.1f} MB, "
        f"page {before[1]:.1f} to {after[1]:.1f} MB. Errors in the pages: {len(errors)}.",
    ]
    publish(f"live_page_{given.example}", lines)


if __name__ == "__main__":
    main()
