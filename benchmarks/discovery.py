"""Which effects hidden in synthetic rig records the analyser names, misses or takes for another.

Draws cars, publishes the SHA-256 of their keys, analyses each car once, then opens the keys and scores.
A run that was killed goes on where it was; answers of different code never mix.

    python benchmarks/discovery.py [--cases N] [--suites a,b] [--seed S] [--out DIR] [--workers N]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from _common import RESULTS, machine

from benchmarks.discovery.cases import HASHES, cases, publish  # isort: skip  # after the thread limits
from benchmarks.discovery.report import Run, write  # isort: skip
from benchmarks.discovery.running import analyse_missing, answer_place, fingerprint, follow_up  # isort: skip
from benchmarks.discovery.suites import SUITES, TYPE_SUITES  # isort: skip
from benchmarks.discovery.unsealing import followups, scores  # isort: skip
from benchmarks.discovery.vehicles import BASES, TYPE_BASES  # isort: skip

DEFAULT = Path(tempfile.gettempdir()) / "doe_kc_discovery"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--cases", type=int, default=13, help="cars of each suite")
    parser.add_argument("--suites", help="of " + ", ".join([*SUITES, "type (of another axle type)"]))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--base",
        choices=BASES,
        default="example",
        help="base vehicle; shifted: to develop on; another axle type",
    )
    parser.add_argument("--out", type=Path, default=DEFAULT, help="folder of cars, answers and keys; kept")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--results", type=Path, default=RESULTS, help="folder of the report")
    parser.add_argument(
        "--score", action="store_true", help="analyse nothing more, score the cases answered so far"
    )
    given = parser.parse_args()
    known = TYPE_SUITES if given.base in TYPE_BASES else SUITES
    suites = given.suites.split(",") if given.suites else list(known)
    unknown = [s for s in suites if s not in known]
    if unknown:
        parser.error(f"unknown suite {unknown[0]} of {given.base}; known are {', '.join(known)}")
    code = fingerprint()
    folder = given.out / f"{given.base}_{given.seed}_{given.cases}_{'-'.join(suites)}" / code
    chosen = cases(given.cases, suites, given.seed, given.base)
    publish(chosen, folder)
    sys.stderr.write(f"{len(chosen)} keys are sealed in {folder / HASHES}\n")
    if given.score:  # the order of the cases tells nothing of their suites, so that any first part is fair
        chosen = [c for c in chosen if answer_place(folder, c).exists()]
    else:
        analyse_missing(chosen, folder, workers=given.workers)
        follow_up(chosen, folder, workers=given.workers)
    run = Run(" ".join(["python", *sys.argv]), given.base, given.seed, code, machine())
    found, followed = scores(chosen, folder, workers=given.workers), followups(chosen, folder)
    print("\n".join(write(found, run, given.results, followed)))


if __name__ == "__main__":
    main()
