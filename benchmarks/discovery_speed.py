"""How long `doe-kc discover` takes and how much memory: cars with one and with five effects, searched twice.

Cars are drawn as those of discovery.py and searched one after the other with a cache of compiled equations
that is empty before the first of them, so that a first search finds there what other cars left. Run it on an
idle machine.

    python benchmarks/discovery_speed.py [--cars N] [--seed S]
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import count, islice
from pathlib import Path
from statistics import median

from _common import machine, publish

from benchmarks.discovery.cases import SEEDS_PER_RUN  # isort: skip  # after the thread limits
from benchmarks.discovery.generator import RECORDS, HiddenCar, hidden_car  # isort: skip

GROUPS: Mapping[str, tuple[str, int]] = {
    "one effect": ("single", 1),
    "one friction, compliance or progression by a law that is not listed": ("other_law", 1),
    "five effects": ("many", 5),
    "five effects and rubber": ("many_rubber", 5),
}
"""What a group of cars is called -> its suite, and how many effects its cars have."""
TARGETS = {1: 15.0, 5: 60.0}
"""Effects of a car -> s that its search should take on two idle cores."""


@dataclass(frozen=True)
class Search:
    """One run of the command. seconds: wall time; cpu: core-seconds of all its processes; megabytes: resident
    set of the largest of them; named: effects that it names, None where it does not answer."""

    seconds: float
    cpu: float
    megabytes: float
    named: int | None


def cars(suite: str, effects: int, seed: int) -> Iterator[HiddenCar]:
    """Cars of a suite that have so many effects."""
    for i in count():
        car = hidden_car(SEEDS_PER_RUN * seed + i, suite, base="example", name=f"{suite}_{i:03d}")
        if len(car.car.hidden) == effects:
            yield car


def search(folder: Path, scratch: Path) -> Search:
    """Of a car's folder, with a cache of results of its own."""
    with tempfile.TemporaryDirectory(dir=scratch) as place:
        study, answer = Path(place) / "study.toml", Path(place) / "answer.json"
        study.write_text(f'axle = "{folder / "axle.toml"}"\nmeasurement = "{folder / RECORDS}"\n')
        command = [sys.executable, "-m", "doe_kc", "discover", str(study), "--out", str(Path(place) / "out")]
        environment = {**os.environ, "DOE_KC_CACHE": str(scratch / "compiled")}
        started = time.perf_counter()
        with subprocess.Popen(
            [*command, "--json", str(answer)],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        ) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.perf_counter() - started
        told = json.loads(answer.read_text()) if answer.exists() else None
        named = None if told is None else len(told["effects"])
        return Search(seconds, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0, named)


def lines(found: Mapping[str, list[tuple[str, Search, Search]]], seed: int) -> list[str]:
    """The report. found: by group a car's name, its first and its second search."""
    out = [
        "# How long a discovery takes",
        "",
        f"`{' '.join(['python', *sys.argv])}`; seed {seed}; {machine()}.",
        "",
        "Cars are searched one after the other with one cache of compiled equations, empty before the first;",
        "the second search of a car has a new cache of results, and the equations of the first.",
        "",
        "| cars | effects | first search, s | second, s | core-seconds of both | memory, MB | target, s |",
        "|---|---|---|---|---|---|---|",
    ]
    for group, searches in found.items():
        effects = GROUPS[group][1]
        for name, first, second in searches:
            both = f"{first.seconds:.0f} | {second.seconds:.0f} | {first.cpu:.0f}, {second.cpu:.0f}"
            most = max(first.megabytes, second.megabytes)
            named = "no answer" if first.named is None else f"{first.named} named of {effects}"
            out.append(f"| {name} | {named} | {both} | {most:.0f} | |")
        middle = [
            f"{median(one.seconds for one in each):.0f}"
            for each in zip(*(s[1:] for s in searches), strict=True)
        ]
        target = f"{TARGETS[effects]:.0f}"
        out.append(f"| **{group}, median** | | **{middle[0]}** | **{middle[1]}** | | | {target} |")
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--cars", type=int, default=3, help="cars of each group")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    found: dict[str, list[tuple[str, Search, Search]]] = {}
    with tempfile.TemporaryDirectory() as place:
        scratch = Path(place)
        for group, (suite, effects) in GROUPS.items():
            for car in islice(cars(suite, effects, given.seed), given.cars):
                folder = car.write(scratch / f"{suite}_{len(found.get(group, []))}")
                one, other = search(folder, scratch), search(folder, scratch)
                found.setdefault(group, []).append((folder.name, one, other))
                sys.stderr.write(f"{folder.name}: {one.seconds:.0f} s, {other.seconds:.0f} s\n")
    publish("discovery_speed", lines(found, given.seed))


if __name__ == "__main__":
    main()
