"""Runs one outside command with a time limit and leaves nothing of it behind."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

OUTPUT_TAIL = 4096
LONGEST_LINE = 300


@dataclass(frozen=True)
class Ended:
    """failure: "ended with exit code 3", empty when it went well. last_line: of its standard error."""

    failure: str
    last_line: str


def run_command(words: Sequence[str], *, cwd: Path, place: Path, timeout: float) -> Ended:
    """Runs without a shell, both streams to files in `place`; OSError when it cannot be started.

    A command that takes longer than `timeout` seconds ends with everything it started.
    """
    with (place / "stdout.txt").open("wb") as out, (place / "stderr.txt").open("wb") as err:
        process = subprocess.Popen(
            words, cwd=cwd, stdin=subprocess.DEVNULL, stdout=out, stderr=err, start_new_session=True
        )
        try:
            code = process.wait(timeout)
            failure = _in_words(code)
        except subprocess.TimeoutExpired:
            failure = f"was ended: it took longer than {timeout:g} s"
        finally:
            _end(process)
    return Ended(failure, last_line(place / "stderr.txt"))


def _in_words(code: int) -> str:
    if code == 0:
        return ""
    return f"was killed by signal {-code}" if code < 0 else f"ended with exit code {code}"


def _end(process: subprocess.Popen[bytes]) -> None:
    """Kill the whole process group of a command that still runs."""
    if process.returncode is not None:
        return
    if os.name == "nt":
        process.kill()
    else:
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def last_line(file: Path) -> str:
    """Last line of a text file that is not blank, of at most 300 characters; empty when there is none."""
    with file.open("rb") as stream:
        stream.seek(max(0, file.stat().st_size - OUTPUT_TAIL))
        text = stream.read().decode("utf-8", "replace")
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return "".join(c if c.isprintable() else "?" for c in lines[-1][:LONGEST_LINE]) if lines else ""
