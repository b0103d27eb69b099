"""Sound cars of every axle type whose models lack effects, which is no error of their records."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from benchmarks.discovery.generator import hidden_car
from benchmarks.discovery.vehicles import TYPE_BASES

SEED = 7000
MCPHERSON_SUITES = ("two", "many", "single")


def hidden_cars(folder: Path, count: int) -> Iterator[Path]:
    """Folders with `axle.toml` and `records`: `count` cars of each axle type, the same in every run."""
    for i in range(count):
        for base in (*TYPE_BASES, "shifted"):
            suite = "type" if base in TYPE_BASES else MCPHERSON_SUITES[i % len(MCPHERSON_SUITES)]
            name = f"{base}_{i}"
            yield hidden_car(SEED + 3 * i + i % 2, suite, base=base, name=name).write(folder / name)
