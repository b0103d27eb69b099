"""Writes cars with open keys, each of a base vehicle of its own, to develop an analyser on.

python -m benchmarks.discovery.development DIR [--seed S] [--cases N] [--suites a,b]
"""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.discovery.generator import HiddenCar, hidden_car
from benchmarks.discovery.suites import SUITES

DEVELOPMENT_SEED = 900_000_000
"""Far above the seeds of sealed runs."""


def write_cars(folder: Path, seed: int, count: int, suites: list[str]) -> None:
    """A folder for each car: axle.toml, records, key.toml; README lists what is hidden in which."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for suite in suites:
        for i in range(count):
            name = f"{suite}_{i + 1:02d}"
            car = hidden_car(DEVELOPMENT_SEED + 1000 * seed + i, suite, base="shifted", name=name)
            (car.write(folder / name) / "key.toml").write_text(car.key)
            lines.append(f"{name}: {_told(car)}")
    (folder / "README").write_text("\n".join(lines) + "\n")


def _told(car: HiddenCar) -> str:
    if car.car.outside is not None:
        o = car.car.outside
        return f"outside: {o.kind} {o.size:.3g} {o.unit} at " + ", ".join("/".join(p) for p in o.shows)
    told = [f"{h.id} {h.location or ''} {h.size:.2f} of its typical size" for h in car.car.hidden]
    return ", ".join(told) or "nothing"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", type=int, default=4, help="cars of each suite")
    parser.add_argument("--suites", default=",".join(SUITES))
    given = parser.parse_args()
    write_cars(given.folder, given.seed, given.cases, given.suites.split(","))


if __name__ == "__main__":
    main()
