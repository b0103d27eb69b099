"""`hidden_car`: the synthetic records of a car with something hidden in it, and the sealed key."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from benchmarks.discovery.car import Car, CleanRecords
from benchmarks.discovery.chance import stream
from benchmarks.discovery.clutter import clutter
from benchmarks.discovery.key import key_text, seal
from benchmarks.discovery.records import write_records
from benchmarks.discovery.scatter import scattered, unequal
from benchmarks.discovery.sensors import Levels, levels
from benchmarks.discovery.suites import ALL_SUITES, Content
from benchmarks.discovery.vehicles import nominal_axle, write_nominal
from doe_kc.axle import Axle, with_values
from doe_kc.solver.result import NotConverged

ATTEMPTS = 20
"""Cars drawn until one moves through all load cases: extremes may lock up."""
WARP = 0.5
ERROR_SEEDS = 1_000_003
"""Between the errors of two cars of a series; a prime beyond the seeds of a run."""
RECORDS = "records"


@dataclass(frozen=True)
class HiddenCar:
    """One case of the benchmark. nominal: what the analyser is given. car, content, levels: the answer.

    key: the answer as TOML; its `seal` is published before anyone analyses the records. number: of the car in
    its series.
    """

    name: str
    suite: str
    seed: int
    nominal: Axle
    car: Car
    content: Content
    levels: Levels
    clean: CleanRecords
    key: str
    number: int = 0

    @property
    def error_seed(self) -> int:
        """Of the errors of the records: every car of a series is tested on its own."""
        return self.seed + ERROR_SEEDS * self.number

    @property
    def seal(self) -> str:
        """SHA-256 of the key."""
        return seal(self.key)

    @property
    def exclude(self) -> tuple[str, ...]:
        """Effects that the analyser's library has to do without."""
        return self.content.exclude

    def write(self, folder: Path) -> Path:
        """`axle.toml` and the records, all that the analyser may see."""
        folder.mkdir(parents=True, exist_ok=True)
        write_nominal(self.nominal, folder / "axle.toml")
        write_records(self.clean, self.nominal, self.levels, self.error_seed, self.name, folder / RECORDS)
        return folder


def hidden_car(
    seed: int,
    suite: str,
    *,
    base: str = "example",
    name: str = "car",
    clutter_in: bool = True,
    faults: bool = True,
    sides: float = 1.0,
    number: int = 0,
) -> HiddenCar:
    """The car of a seed and suite, always the same.

    base: see `vehicles.BASES`. clutter_in: small shares of all other effects. faults: loops of the rig's own
    and bad samples. sides: share of the usual difference between left and right. number: of the car in its
    series: the same effects and clutter, but parts and records of its own. KeyError for an unknown suite,
    NotConverged when no car of the seed has an equilibrium everywhere.
    """
    fill = ALL_SUITES[suite]
    nominal = nominal_axle(base, seed)
    for attempt in range(ATTEMPTS):
        words = (suite, base, str(attempt))
        content = fill(seed, stream(seed, "hidden", *words), nominal)
        content = replace(content, spread=replace(content.spread, sides=sides))
        of_car = (*words, *([f"number {number}"] if number else ()))
        rng = stream(seed, "car", *of_car)
        axle = with_values(nominal, scattered(nominal, rng, content.spread))
        axle = axle.changed(unequal(axle, rng, content.spread.sides))
        hidden = {h.id for h in content.hidden}
        small = clutter(nominal, stream(seed, "clutter", *words), hidden) if clutter_in else ()
        warps = stream(seed, "warp", *of_car).uniform(-WARP, WARP, len(axle.load_cases))
        warp = dict(zip(axle.load_cases, (float(w) for w in warps), strict=True))
        car = Car(axle, content.hidden, small, content.outside, warp)
        try:
            clean = car.clean()
        except NotConverged:
            continue
        errors = levels(stream(seed, "levels", *of_car), faults=faults)
        key = key_text(name, seed, suite, base, nominal, car, content, errors)
        return HiddenCar(name, suite, seed, nominal, car, content, errors, clean, key, number)
    raise RuntimeError(f"no car of seed {seed} in suite {suite} has an equilibrium in every load case")
