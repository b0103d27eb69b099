"""Lines of progress where there is no terminal."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from doe_kc.cli.progress import ProgressLines
from tests.cli.runner import write_study


def test_a_line_at_the_start_every_ten_seconds_and_at_the_end() -> None:
    now = [0.0]
    stream = io.StringIO()
    lines = ProgressLines("correlating", 100, stream, lambda: now[0])
    for second in range(1, 26):
        now[0] = float(second)
        lines.tell(f"rating {second}", 2 * second, 100)
    lines.close()
    assert stream.getvalue().splitlines() == [
        "correlating: 100 steps",
        "correlating: rating 10, 20 of 100 in 10 s",
        "correlating: rating 20, 40 of 100 in 20 s",
        "correlating: rating 25, 50 of 100 in 25 s",
    ]


def test_a_pipe_gets_lines(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study", parameters=["LLF.z"])
    command = [sys.executable, "-m", "doe_kc", "influence", str(study), "--pictures", "none"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
    first, *_, last, _files = done.stderr.splitlines()
    assert first == "one at a time: 3 steps" and last.startswith("one at a time: 3 of 3 in ")
    assert "\x1b" not in done.stderr


@pytest.mark.skipif(os.name == "nt", reason="pseudo-terminals are POSIX")
def test_a_terminal_gets_a_bar(tmp_path: Path) -> None:
    import pty

    study = write_study(tmp_path / "study", parameters=["LLF.z"])
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "doe_kc", "influence", str(study), "--pictures", "none"]
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=theirs, env={**os.environ, "TERM": "xterm"}
    )
    os.close(theirs)
    shown = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:
            break
        if not part:
            break
        shown += part
    os.close(ours)
    assert process.wait(60) == 0
    assert b"3/3" in shown and b"steps" not in shown
