"""The cases of one run: drawn, sealed in public, written for the analyser, and opened afterwards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.discovery.chance import stream
from benchmarks.discovery.generator import HiddenCar, hidden_car

HASHES = "hashes.txt"
SEEDS_PER_RUN = 100_000


@dataclass(frozen=True)
class Case:
    """One car of a run. name: tells nothing of the suite. seed: of the car."""

    name: str
    suite: str
    seed: int
    base: str

    def car(self) -> HiddenCar:
        """Drawn anew each time; the same each time."""
        return hidden_car(self.seed, self.suite, base=self.base, name=self.name)


def cases(count: int, suites: Sequence[str], seed: int, base: str) -> list[Case]:
    """`count` cases of each suite, in an order that tells nothing."""
    drawn = [(suite, SEEDS_PER_RUN * seed + i) for suite in suites for i in range(count)]
    order = stream(seed, "order of cases").permutation(len(drawn))
    return [Case(f"case_{n:04d}", *drawn[int(at)], base) for n, at in enumerate(order, start=1)]


def publish(chosen: Sequence[Case], folder: Path) -> None:
    """Write the SHA-256 of every key, and what the analyser gets; kept when it is there already.

    RuntimeError when a key that was published is no longer what the seeds give: the generator changed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    known = published(folder)
    for case in chosen:
        if case.name in known and (case_folder(folder, case) / "axle.toml").exists():
            continue
        car = case.car()
        if known.setdefault(case.name, car.seal) != car.seal:
            raise RuntimeError(
                f"{folder}: the key of {case.name} is not the published one; use another folder"
            )
        place = folder / HASHES
        place.write_text("".join(f"{seal}  {name}.toml\n" for name, seal in sorted(known.items())))
        car.write(case_folder(folder, case))


def published(folder: Path) -> dict[str, str]:
    """Case -> SHA-256, from the list."""
    place = folder / HASHES
    if not place.exists():
        return {}
    pairs = (line.split() for line in place.read_text().splitlines())
    return {name.removesuffix(".toml"): seal for seal, name in pairs}


def case_folder(folder: Path, case: Case) -> Path:
    """What the analyser sees of a case."""
    return folder / "cases" / case.name


def unseal(case: Case, folder: Path) -> HiddenCar:
    """The car with its key, checked against the published hash and laid beside it."""
    car = case.car()
    if published(folder)[case.name] != car.seal:
        raise RuntimeError(f"{folder}: the key of {case.name} is not the published one")
    place = folder / "keys" / f"{case.name}.toml"
    place.parent.mkdir(exist_ok=True)
    place.write_text(car.key)
    return car
