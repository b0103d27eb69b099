"""The one door to the analyser: a model and records in, a verdict out. It sees nothing else of a case.

python -m benchmarks.discovery.analyser CASE_FOLDER ANSWER [--exclude ID ...]
"""

from __future__ import annotations

import argparse
import json
import math
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.discovery.generator import RECORDS


def analyse(axle_path: Path, measurement_dir: Path, *, exclude: Sequence[str], out: Path) -> dict[str, Any]:
    """The answer of `doe-kc discover` as data. exclude: effects that its library has to do without."""
    from doe_kc.workflow.discover import discover_folder

    return dict(discover_folder(axle_path, measurement_dir, exclude=exclude, out=out))


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
        answer = analyse(
            given.case / "axle.toml", given.case / RECORDS, exclude=given.exclude, out=Path(scratch)
        )
    keep({**answer, "seconds": time.perf_counter() - started}, given.answer)


if __name__ == "__main__":
    main()
