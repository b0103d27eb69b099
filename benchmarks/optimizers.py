"""Evaluations that correlation methods and other optimizers need on car_b, all 72 variables.

Same start, bounds, targets and counting for everyone. Deviation: sum over the active characteristics of
((value - target) / Norm)^2, its measure for all methods alike; the curves and their noise are not in it.

    python benchmarks/optimizers.py [--out DIR] [--methods NAME ...] [--seeds N] [--report | --run-only]
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from _common import publish

from optimizers.overhead import line, wide  # isort: skip
from optimizers.report import report  # isort: skip  # after the thread limits
from optimizers.picture import draw  # isort: skip
from optimizers.running import PEERS, results, run_missing  # isort: skip

DEFAULT = Path(tempfile.gettempdir()) / "doe_kc_optimizers"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=DEFAULT, help="folder of finished runs; they are kept")
    parser.add_argument("--methods", nargs="*", default=[p.id for p in PEERS])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--report", action="store_true", help="only report the runs that are there")
    parser.add_argument("--run-only", action="store_true", help="only run, report nothing")
    given = parser.parse_args()
    if not given.report:
        run_missing(given.out, given.methods, given.seeds)
        if "ego" in given.methods:
            wide(given.out)
    if given.run_only:
        return
    found = list(results(given.out))
    draw(found)
    publish(
        "optimizers",
        report(found, line(given.out), "python benchmarks/optimizers.py"),
    )


if __name__ == "__main__":
    main()
