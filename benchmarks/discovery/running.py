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

ROOT = Path(__file__).parents[2]
TIME_LIMIT = 3600.0
"""s a case: an analysis that hangs is one that failed."""


def fingerprint() -> str:
    """Of every source file of the imported package: answers of different code never mix."""
    root = Path(doe_kc.__file__).parent
    found = hashlib.sha256()
    for place in sorted(root.rglob("*.py")):
        found.update(str(place.relative_to(root)).encode() + place.read_bytes())
    return found.hexdigest()[:12]


def answer_place(folder: Path, case: Case) -> Path:
    """The case's answer."""
    return folder / "answers" / f"{case.name}.json"


def analyse_missing(chosen: Sequence[Case], folder: Path, *, workers: int) -> None:
    """One answer for every case that has none yet. exclude is all that an analyser is told of a suite."""
    (folder / "answers").mkdir(exist_ok=True)
    left = [c for c in chosen if not answer_place(folder, c).exists()]
    with ThreadPoolExecutor(max_workers=workers) as pool:
        for done, case in enumerate(pool.map(lambda c: _analyse(c, folder), left), start=1):
            sys.stderr.write(f"{done}/{len(left)} {case}\n")


def _analyse(case: Case, folder: Path) -> str:
    place = answer_place(folder, case)
    command = [
        sys.executable,
        "-m",
        "benchmarks.discovery.analyser",
        str(case_folder(folder, case)),
        str(place),
    ]
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
    place = answer_place(folder, case)
    return dict(json.loads(place.read_text())) if place.exists() else None
