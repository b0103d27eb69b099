"""An outside solver: any command that reads parameters.json and writes curves or characteristics."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import subprocess
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import kind_of
from doe_kc.axle.parameters import with_values
from doe_kc.ground.errors import InputError, RunError
from doe_kc.true_solver.answer import Unreadable, read_characteristics, read_curves
from doe_kc.true_solver.outcome import Outcome, checked, failure, reduced
from doe_kc.true_solver.own import describe_axle
from doe_kc.true_solver.protocol import Values, digest

OUTPUT_TAIL = 4096
"""Bytes at the end of a failed solver's output in which its last words are looked for."""
LONGEST_LINE = 300
"""Characters of them that a message quotes."""


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


PARAMETERS = "parameters.json"


@dataclass(frozen=True)
class CommandSolver:
    """command: words; `{folder}` and `{parameters}` stand for the run's folder and its parameters.json.

    axle: the model whose parameters the designs set; it gives units, load cases and the half track.
    timeout: seconds. folder: where the command runs. load_cases: those expected in curves.csv, all of the
    axle's when empty.
    """

    command: tuple[str, ...]
    axle: Axle
    windows: Mapping[str, float] = field(default_factory=dict)
    timeout: float = 3600.0
    folder: Path = Path()
    load_cases: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        return Path(self.command[0]).name

    @property
    def quick(self) -> bool:
        return False

    @property
    def exact(self) -> bool:
        return False

    def describe(self) -> dict[str, str]:
        """Files of the study's folder that the command names count by their content."""
        words = {f"command word {i + 1}": self._said(word) for i, word in enumerate(self.command)}
        cases = ", ".join(self.load_cases) or "all"
        return {"solver": "command", **words, "load cases of the command": cases, **describe_axle(self.axle)}

    def _said(self, word: str) -> str:
        file = self.folder / word
        try:
            return f"{word} {hashlib.sha256(file.read_bytes()).hexdigest()[:16]}" if file.is_file() else word
        except OSError:
            return word

    def fingerprint(self) -> str:
        return digest(self.describe())

    def prepare(self, designs: Sequence[Values]) -> CommandSolver:
        """InputError for a parameter that the axle does not have."""
        for values in designs:
            with_values(self.axle, values)
        return self

    def evaluate(self, values: Values) -> Outcome:
        """One run in a temporary folder of its own; whatever it does wrong is a reason.

        InputError when the command cannot be started, RunError when there is no room for its files.
        """
        started = time.perf_counter()
        try:
            with tempfile.TemporaryDirectory(prefix="doe_kc_", ignore_cleanup_errors=True) as place:
                outcome = self._run(Path(place), values)
        except OSError as error:
            raise RunError(
                f"{error.filename or tempfile.gettempdir()}: files for {self.name} cannot be written "
                f"({error.strerror or error}); free disk space, or set TMPDIR to another folder."
            ) from None
        return replace(outcome, seconds=time.perf_counter() - started)

    def _run(self, place: Path, values: Values) -> Outcome:
        (place / PARAMETERS).write_text(parameters_document(values), encoding="utf-8")
        ended = self._ended(place)
        if ended.failure:
            return failure(f"{self.name} {ended.failure}{_said_last(ended)}")
        try:
            outcome = self._answer(place, values)
        except Unreadable as problem:
            outcome = failure(str(problem))
        return failure(f"{self.name}: {outcome.reason}{_said_last(ended)}") if outcome.failed else outcome

    def _ended(self, place: Path) -> Ended:
        marks = {"{folder}": str(place), "{parameters}": str(place / PARAMETERS)}
        words = [_replaced(word, marks) for word in self.command]
        try:
            return run_command(words, cwd=self.folder, place=place, timeout=self.timeout)
        except (FileNotFoundError, NotADirectoryError, PermissionError) as error:
            raise InputError(
                f"[solver] command: {self.command[0]!r} cannot be run in {self.folder} ({error.strerror}); "
                "name a program that is on the path, or a file with its folder."
            ) from None

    def _answer(self, place: Path, values: Values) -> Outcome:
        """Characteristics of the curves; where these say nothing, those that the command gives itself."""
        given = read_characteristics(place)
        model = with_values(self.axle, values)
        curves = read_curves(place / "curves.csv", model, self.load_cases, self.windows)
        if curves is None and given is None:
            raise Unreadable("wrote neither curves.csv nor characteristics.csv nor characteristics.json")
        characteristics = np.full_like(given, np.nan) if curves is None and given is not None else None
        if curves is not None:
            characteristics = reduced(curves, self.windows)
        assert characteristics is not None
        if given is not None:
            characteristics = np.where(np.isnan(characteristics), given, characteristics)
        return checked(Outcome(curves, characteristics, "", 0.0))


def parameters_document(values: Values) -> str:
    """`{"parameters": {path: value}, "units": {path: unit}}`, every digit of the values."""
    return json.dumps(
        {"parameters": dict(values), "units": {path: unit_of(path) for path in values}}, indent=1
    )


def unit_of(path: str) -> str:
    """Unit of a parameter; "-" for a factor, empty when it is none of the design parameters."""
    kind = kind_of(path)
    return kind.unit if kind is not None else ""


def _replaced(word: str, marks: Mapping[str, str]) -> str:
    for mark, text in marks.items():
        word = word.replace(mark, text)
    return word


def _said_last(ended: Ended) -> str:
    return f"; it said last: {ended.last_line}" if ended.last_line else ""
