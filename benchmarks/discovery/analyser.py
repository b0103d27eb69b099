"""The one door to the analyser: a model and records in, a verdict out. It sees nothing else of a case.

python -m benchmarks.discovery.analyser CASE_FOLDER ANSWER [--exclude ID ...]
"""

from __future__ import annotations

import argparse
import json
import math
import tempfile
import time
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.discovery.followup import VARIABLES
from benchmarks.discovery.generator import RECORDS


def analyse(case: Path, *, exclude: Sequence[str], out: Path) -> dict[str, Any]:
    """The answer of `doe-kc discover` as data, on a folder with a model, records and maybe measured parts.

    exclude: effects that its library has to do without.
    """
    from doe_kc.variables import VariableOptions
    from doe_kc.workflow.discover import discover_folder

    told = case / VARIABLES
    variables = VariableOptions.model_validate(tomllib.loads(told.read_text())) if told.exists() else None
    found = discover_folder(case / "axle.toml", case / RECORDS, variables=variables, exclude=exclude, out=out)
    return dict(found)


def keep(answer: dict[str, Any], path: Path) -> None:
    """Write an answer whole or not at all, so that a killed run leaves no half one."""
    part = path.with_suffix(".part")
    part.write_text(json.dumps(finite(answer), indent=1))
    part.replace(path)


def finite(value: Any) -> Any:
    """JSON knows no infinity and no nan: null."""
    if isinstance(value, dict):
        return {str(k): finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [finite(v) for v in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("case", type=Path)
    parser.add_argument("answer", type=Path)
    parser.add_argument("--exclude", nargs="*", default=[])
    given = parser.parse_args()
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as scratch:
        answer = analyse(given.case, exclude=given.exclude, out=Path(scratch))
    keep({**answer, "seconds": time.perf_counter() - started}, given.answer)


if __name__ == "__main__":
    main()
