"""How many evaluations of an outside model a correlation takes, with its twin and without.

python benchmarks/outside_twin.py [--out DIR] [--seeds N] [--budget N] [--corrections NAME ...]
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from _common import machine, publish

from benchmarks.twin.cars import TWIN_CASES, TwinCase  # isort: skip  # after the thread limits
from benchmarks.twin.corrections import AS_SHIPPED, CORRECTIONS  # isort: skip
from benchmarks.twin.report import report  # isort: skip
from benchmarks.twin.running import NO_TWIN, TwinRun, run  # isort: skip
from benchmarks.twin.useless import USELESS_SDS, run_useless, useless_rows  # isort: skip

DEFAULT = Path(tempfile.gettempdir()) / "doe_kc_outside_twin"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=DEFAULT, help="folder of finished runs; they are kept")
    parser.add_argument("--seeds", type=int, default=1, help="of noise and search")
    parser.add_argument("--budget", type=int, default=12, help="evaluations of one search")
    parser.add_argument("--corrections", nargs="*", default=[*CORRECTIONS, NO_TWIN])
    parser.add_argument("--useless", type=int, default=5, help="seeds with a twin of little use")
    parser.add_argument("--run-only", action="store_true", help="only run, report nothing")
    given = parser.parse_args()
    searches = [
        (case, how, seed)
        for case in TWIN_CASES
        for seed in range(1, given.seeds + 1)
        for how in given.corrections
        if case.compared or how == AS_SHIPPED
    ]
    runs = list(_runs(searches, given.out, given.budget))
    if not given.run_only:
        useless = [run_useless(sd, seed) for sd in USELESS_SDS for seed in range(1, given.useless + 1)]
        publish(
            "outside_twin",
            report(runs, useless_rows(useless), "python benchmarks/outside_twin.py", machine()),
        )


def _runs(searches: list[tuple[TwinCase, str, int]], out: Path, budget: int) -> Iterator[TwinRun]:
    """Those that are there, and the others now."""
    for case, how, seed in searches:
        place = out / f"{case.name}_{how}_{seed}".replace(" ", "_").replace(",", "")
        kept = place / "run.json"
        if not kept.exists():
            result = run(case, how, seed, budget, place)
            kept.write_text(json.dumps(asdict(result)))
            sys.stderr.write(
                f"{case.name}, {how}, {seed}: feasible {result.feasible}, 98 % {result.reached}, "
                f"{result.improvement[-1]:.1f} % after {len(result.improvement)}, {result.own_cpu:.0f} s\n"
            )
        values = json.loads(kept.read_text())
        yield TwinRun(**{**values, "improvement": tuple(values["improvement"])})


if __name__ == "__main__":
    main()
