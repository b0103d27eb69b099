"""Memory of the live page's server over tens of thousands of updates: eight hours of dragging, compressed.

A tab without a browser drags slider after slider over its socket, fifty moves a drag, and waits for the
answer to each; every twentieth drag it takes a snapshot, looks at another load case, undoes. The server's
resident memory is read beside it.

    python benchmarks/live_memory.py [--example NAME] [--updates N]
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from _common import ROOT, machine, publish
from live_page import resident
from websockets import Origin
from websockets.sync.client import ClientConnection, connect

from doe_kc.live.frames import PRESENT, PageFrame
from tests.live.served import Served, serving

DRAG_MOVES = 50
DRAGS_BETWEEN = 20
"""Drags from one snapshot to the next."""
SAMPLES = 20
"""Rows of the table."""


class SocketTab:
    """A tab that counts its answers."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self.model = next(m for m in self._news() if isinstance(m, dict) and m["kind"] == "model")
        self.seq = 0
        self.updates = 0

    def _news(self) -> Iterator[dict[str, Any] | PageFrame]:
        while True:
            data = self._socket.recv(timeout=120)
            yield json.loads(data) if isinstance(data, str) else PageFrame.decode(data)

    def ask(self, **message: object) -> None:
        """Send a message that is answered, and wait for that."""
        self.seq += 1
        self._socket.send(json.dumps({**message, "seq": self.seq}))
        for news in self._news():
            if isinstance(news, PageFrame) and news.kind == PRESENT and news.seq >= self.seq:
                self.updates += 1
                return

    def say(self, **message: object) -> None:
        """Send a message that is not waited for."""
        self._socket.send(json.dumps(message))

    def drag(self, number: int) -> None:
        """One slider to and fro within its bounds."""
        slider = self.model["sliders"][number % len(self.model["sliders"])]
        reach = 0.5 * (slider["upper"] - slider["start"])
        for k in range(DRAG_MOVES):
            value = slider["start"] + reach * np.sin(2.0 * np.pi * k / (DRAG_MOVES - 1))
            self.ask(kind="move", path=slider["path"], value=value, last=k == DRAG_MOVES - 1)


def connection(served: Served) -> ClientConnection:
    """As the page opens it."""
    return connect(
        f"ws://127.0.0.1:{served.port}/socket",
        additional_headers={"Cookie": served.cookie},
        origin=Origin(f"http://127.0.0.1:{served.port}"),
        max_size=None,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--example", default="front_axle")
    parser.add_argument("--updates", type=int, default=50_000)
    options = parser.parse_args()
    rows: list[tuple[int, float, float]] = []
    with tempfile.TemporaryDirectory() as scratch:
        study = ROOT / "examples" / options.example
        with (
            serving(Path(scratch), "--port", "18570", study=study) as served,
            connection(served) as socket,
        ):
            tab, began, drag = SocketTab(socket), time.monotonic(), 0
            while tab.updates < options.updates:
                tab.drag(drag)
                drag += 1
                if drag % DRAGS_BETWEEN == 0:
                    tab.say(kind="snapshot")
                    tab.say(kind="look", load_case=tab.model["cases"][drag % 3]["id"], row=drag % 9)
                    tab.ask(kind="undo")
                if tab.updates >= options.updates * (len(rows) + 1) / SAMPLES:
                    rows.append((tab.updates, resident(served.process.pid), time.monotonic() - began))
                    print(*rows[-1], flush=True)
    slope = float(np.polyfit(*np.array(rows)[len(rows) // 2 :, :2].T, 1)[0]) * 1e4
    lines = [
        f"# Memory of the live page's server, {options.example}",
        "",
        f"{machine()}; `python benchmarks/live_memory.py --example {options.example} --updates "
        f"{options.updates}`. {DRAG_MOVES} moves a drag, a snapshot every {DRAGS_BETWEEN} drags.",
        "",
        "| updates | resident, MB | after, s |",
        "|---|---|---|",
        *(f"| {n} | {mb:.1f} | {s:.0f} |" for n, mb, s in rows),
        "",
        f"Second half: {slope:+.2f} MB for 10,000 updates by a straight line.",
    ]
    publish(f"live_memory_{options.example}", lines)


if __name__ == "__main__":
    main()
