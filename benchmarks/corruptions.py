"""Corrupted rig records: which of them the checks tell, and whether sound cars stay without a finding.

    python benchmarks/corruptions.py AXLE CARS [CARS ...] [--other AXLE CARS ...] [--hidden N] [--out FILE]

AXLE: axle file that the cars are of. CARS: folders whose sub-folders hold a `test.toml`; every corruption is
made of each in turn. --other: sound cars of another axle. --hidden: sound cars drawn for each axle type, with
one effect or several that its model lacks.
"""

from __future__ import annotations

import argparse
import logging
import tempfile
from pathlib import Path

from corruptions.catalogue import catalogue
from corruptions.checking import cars_of, read_car, right, told
from corruptions.hidden import hidden_cars
from corruptions.report import page, sound_lines
from corruptions.sizes import size_rows

from doe_kc.axle_file import read_axle
from doe_kc.curves import CurveSet
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("axle", type=Path)
    parser.add_argument("cars", type=Path, nargs="+")
    parser.add_argument("--other", type=Path, nargs="+", action="append", default=[])
    parser.add_argument("--hidden", type=int, default=0)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--no-model", action="store_true")
    options = parser.parse_args()
    logging.disable(logging.WARNING)
    model = None if options.no_model else curves_of(options.axle)
    cars = [read_car(folder) for folder in cars_of(options.cars)]
    lines = sound_lines(cars, model)
    for axle, *folders in options.other:
        lines += sound_lines([read_car(f) for f in cars_of(folders)], curves_of(axle))
    with tempfile.TemporaryDirectory() as folder:
        for car in hidden_cars(Path(folder), options.hidden):
            lines += sound_lines([read_car(car / "records")], curves_of(car / "axle.toml"))
    rows = []
    for number, corruption in enumerate(catalogue()):
        if options.only not in corruption.name:
            continue
        car = cars[number % len(cars)]
        outcome = told(car, corruption, model)
        ok = right(corruption, outcome)
        words = "; ".join(f"{s} {k}.{c}.{n}" for s, k, c, n in outcome.findings[:3]) or "-"
        words = "refused: " + outcome.refusal.split(": ", 1)[-1][:90] if outcome.refusal else words
        rows.append((corruption, car.folder.name, ok, words))
        print("ok " if ok else "NO ", corruption.name, "|", car.folder.name, "|", words, flush=True)
    hit = sum(ok for *_, ok, _ in rows)
    print(f"{hit} of {len(rows)} told ({100 * hit / max(len(rows), 1):.1f} %)")
    print("\n".join(lines))
    if options.out is not None:
        sizes = size_rows(cars[:2], model)
        options.out.write_text(page(rows, lines, sizes, with_model=model is not None), encoding="utf-8")


def curves_of(axle: Path) -> CurveSet:
    return curve_set(solve(read_axle(axle)))


if __name__ == "__main__":
    main()
