"""Runs a command as `main` does, in this process, and says how it ended; makes small studies."""

from __future__ import annotations

import io
import re
import shutil
import signal
import sys
from collections.abc import Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

from doe_kc.cli import main
from tests.reference import EXAMPLE

AXLE = EXAMPLE / "axle.toml"
FEW = ("LLF.z", "llr.Fx", "strut.flexibility", "steer_arm.radius")
"""A hardpoint, a bushing, a parameter that can only be raised, and one that the rigid axle does not have."""


SHORT = """
[variables]
use = ["LLF.z", "llr.Fx", "spring.rate"]
[correlation]
method = "gauss_newton"
"""


@dataclass(frozen=True)
class Outcome:
    code: int
    out: str
    err: str


def invoke(*arguments: object) -> Outcome:
    """`doe-kc ARGUMENTS`; any exception but the exit escapes, as the traceback it would be."""
    out, err = io.StringIO(), io.StringIO()
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    before, sys.argv = sys.argv, ["doe-kc", *map(str, arguments)]
    try:
        with redirect_stdout(out), redirect_stderr(err):
            main()
    except SystemExit as end:
        return Outcome(end.code if isinstance(end.code, int) else 1, out.getvalue(), err.getvalue())
    finally:
        sys.argv = before
        for number, handler in handlers.items():
            signal.signal(number, handler)
    raise AssertionError("main returned")


def succeeds(*arguments: object) -> Outcome:
    """The outcome of a command that has to end well."""
    outcome = invoke(*arguments)
    assert outcome.code == 0, outcome.err
    return outcome


def fails(code: int, pattern: str, *arguments: object) -> Outcome:
    """The outcome of a command that has to end with one message like the pattern."""
    outcome = invoke(*arguments)
    assert_one_message(outcome, code, pattern)
    return outcome


def assert_one_message(outcome: Outcome, code: int, pattern: str) -> None:
    assert outcome.code == code, (outcome.code, outcome.out, outcome.err)
    assert outcome.err.count("doe-kc:") == 1, outcome.err
    assert "Traceback" not in outcome.err
    assert re.search(pattern, outcome.err), outcome.err


def write_study(
    folder: Path,
    *,
    records: Mapping[str, Sequence[str]] | None = None,
    parameters: Sequence[str] = FEW,
    extra: str = "",
    tables: str = "",
) -> Path:
    """A copy of the example with few parameters and the records named (none: no measurement).

    extra: further keys of the study; tables: further tables, such as `SHORT`, a correlation of a second.
    """
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(AXLE, folder / "axle.toml")
    lines = ['axle = "axle.toml"', extra]
    if records is not None:
        write_rig(folder / "rig", records)
        lines.insert(1, 'measurement = "rig"')
    lines += ["[influence]", f"parameters = {list(parameters)}", tables]
    (folder / "study.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder


def write_rig(folder: Path, records: Mapping[str, Sequence[str]]) -> None:
    """Records of the example and their test.toml."""
    folder.mkdir(exist_ok=True)
    side = "{ toe_deg = 0.006, camber_deg = -0.495, caster_deg = 4.34 }"
    lines = ['name = "small"', "[alignment]", f"left = {side}", f"right = {side}", "[records]"]
    for case, files in records.items():
        lines.append(f"{case} = {list(files)}")
        for file in files:
            shutil.copy(EXAMPLE / "rig" / file, folder / file)
    (folder / "test.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def leftovers(folder: Path) -> list[str]:
    """Temporary files that a writer forgot."""
    return sorted(p.name for p in folder.rglob("*") if p.name.endswith(".tmp"))
