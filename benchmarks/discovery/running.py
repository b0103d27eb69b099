"""Analyses every case once, each in a process of its own; a killed run goes on where it was."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import doe_kc
from benchmarks.discovery.cases import Case, case_folder
from benchmarks.discovery.followup import advised, carry_out

ROOT = Path(__file__).parents[2]
FOLLOWED = "confounded"
"""The suite whose advised tests are carried out."""
TIME_LIMIT = 3600.0
"""s a case: an analysis that hangs is one that failed."""


def fingerprint() -> str:
    """Of every source file of the imported package: answers of different code never mix."""
    root = Path(doe_kc.__file__).parent
    found = hashlib.sha256()
    for place in sorted(p for p in root.rglob("*") if p.suffix in (".py", ".c")):
        found.update(str(place.relative_to(root)).encode() + place.read_bytes())
    return found.hexdigest()[:12]


def answer_place(folder: Path, case: Case) -> Path:
    """The case's answer."""
    return folder / "answers" / f"{case.name}.json"


def followup_folder(folder: Path, case: Case) -> Path:
    """What the analyser sees of a case once the tests that it advised are done."""
    return folder / "followups" / case.name


def followup_place(folder: Path, case: Case) -> Path:
    """The answer to that."""
    return folder / "followups" / f"{case.name}.json"


def analyse_missing(chosen: Sequence[Case], folder: Path, *, workers: int) -> None:
    """One answer for every case that has none yet. exclude is all that an analyser is told of a suite."""
    (folder / "answers").mkdir(exist_ok=True)
    left = [c for c in chosen if not answer_place(folder, c).exists()]
    _analyse_all([(c, case_folder(folder, c), answer_place(folder, c)) for c in left], workers)


def follow_up(chosen: Sequence[Case], folder: Path, *, workers: int) -> None:
    """Carry out the tests advised for confounded cars that are not named, and analyse these cars again."""
    left = []
    for case in chosen:
        answer = stored(folder, case)
        if case.suite != FOLLOWED or answer is None or followup_place(folder, case).exists():
            continue
        advice = advised(answer)
        if answer["verdict"] != "named" and advice:
            carry_out(case.car(), advice, followup_folder(folder, case))
            left.append((case, followup_folder(folder, case), followup_place(folder, case)))
    _analyse_all(left, workers)


def _analyse_all(left: Sequence[tuple[Case, Path, Path]], workers: int) -> None:
    with ThreadPoolExecutor(max_workers=workers) as pool:
        for done, case in enumerate(pool.map(lambda given: _analyse(*given), left), start=1):
            sys.stderr.write(f"{done}/{len(left)} {case}\n")


def _analyse(case: Case, seen: Path, place: Path) -> str:
    """seen: the folder that the analyser sees. place: of its answer."""
    command = [sys.executable, "-m", "benchmarks.discovery.analyser", str(seen), str(place)]
    exclude = case.car().exclude
    if exclude:
        command += ["--exclude", *exclude]
    try:
        ended = subprocess.run(
            command, cwd=ROOT, env=os.environ, capture_output=True, text=True, timeout=TIME_LIMIT, check=False
        )
        trouble = ended.stderr if ended.returncode else ""
    except subprocess.TimeoutExpired:
        trouble = f"took more than {TIME_LIMIT:g} s"
    if trouble or not place.exists():
        place.with_suffix(".log").write_text(trouble)
        return f"{case.name}: failed, see {place.with_suffix('.log')}"
    return f"{case.name}: {json.loads(place.read_text()).get('seconds', 0.0):.0f} s"


def stored(folder: Path, case: Case) -> dict[str, Any] | None:
    """The answer, or None when the analysis broke off."""
    return _read(answer_place(folder, case))


def stored_followup(folder: Path, case: Case) -> dict[str, Any] | None:
    """The answer after the tests advised, or None where none were."""
    return _read(followup_place(folder, case))


def _read(place: Path) -> dict[str, Any] | None:
    return dict(json.loads(place.read_text())) if place.exists() else None
