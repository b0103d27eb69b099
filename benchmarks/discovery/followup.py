"""Carries out the tests that an answer advises on the hidden car: load cases are driven, parts measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import tomlkit

from benchmarks.discovery.car import CleanRecords
from benchmarks.discovery.chance import stream
from benchmarks.discovery.generator import HiddenCar
from doe_kc.axle import Axle, parameter_value
from doe_kc.discovery.verdict.component_test import accuracy
from doe_kc.load_cases import LoadCase
from doe_kc.solver.result import NotConverged
from doe_kc.variables import VariableOptions, build_space

VARIABLES = "variables.toml"
"""What the analyser is told of measured parts, as a study's table `[variables]`."""
INSIDE = 3.0
"""Standard deviations of a measured part either way of its value: the bounds of a Gaussian variable."""


@dataclass(frozen=True)
class Advice:
    """load_cases: id -> amplitude and, where the answer gives one, offset in mm. parts: paths to measure."""

    load_cases: Mapping[str, tuple[float, float | None]]
    parts: tuple[str, ...]

    def __bool__(self) -> bool:
        return bool(self.load_cases or self.parts)


def advised(answer: Mapping[str, Any]) -> Advice:
    """The best load case for each pair that is not told apart, and all parts of all component tests."""
    tests = answer.get("further_tests") or []
    cases: dict[str, tuple[float, float | None]] = {}
    pairs = set()
    for test in (t for t in tests if t["kind"] == "load_case"):
        pair = tuple(test["effects"])
        if pair not in pairs and test["load_case"] not in cases:
            cases[test["load_case"]] = test["amplitude"], test["offset_mm"]
            pairs.add(pair)
    parts = [p for t in tests if t["kind"] == "component" for p in t["parts"]]
    return Advice(cases, tuple(dict.fromkeys(parts)))


def carry_out(car: HiddenCar, advice: Advice, folder: Path) -> None:
    """The car's folder once more, with the advised load cases in place of the usual ones of their kind, and
    what a bench says of the parts. A load case in which the car has no equilibrium is not driven."""
    try:
        again = _driven(car, advice.load_cases)
    except NotConverged:
        advice = replace(advice, load_cases={})
        again = car
    again.write(folder)
    if advice.load_cases:
        _write_load_cases(folder / "axle.toml", advice.load_cases)
    (folder / VARIABLES).write_text(tomlkit.dumps({"change": _measured(car, advice.parts)}))


def _driven(car: HiddenCar, load_cases: Mapping[str, tuple[float, float | None]]) -> HiddenCar:
    if not load_cases:
        return car
    cases = dict(car.car.axle.load_cases)
    cases |= {ident: _changed(cases[ident], *how) for ident, how in load_cases.items()}
    moved = replace(car.car, axle=replace(car.car.axle, load_cases=cases))
    clean: CleanRecords = moved.clean()
    return replace(car, car=moved, clean=clean)


def _changed(case: LoadCase, amplitude: float, offset: float | None) -> LoadCase:
    larger = replace(case, amplitude=amplitude)
    return larger if offset is None else replace(larger, **{"offset": offset})


def _write_load_cases(path: Path, load_cases: Mapping[str, tuple[float, float | None]]) -> None:
    document: Any = tomlkit.parse(path.read_text())
    for ident, (amplitude, offset) in load_cases.items():
        document["load_cases"][ident]["amplitude"] = amplitude
        if offset is not None:
            document["load_cases"][ident]["offset"] = offset
    path.write_text(tomlkit.dumps(document))


def _measured(car: HiddenCar, parts: Sequence[str]) -> list[dict[str, Any]]:
    """A change of the study's variables for each part: its value, and bounds by the bench's accuracy."""
    known = {v.path: v for v in build_space(car.nominal, VariableOptions(), "bench test").variables}
    out = []
    for path in parts:
        true = _of_both_sides(car.car.axle, path)
        sd = accuracy(known[path], true)
        value = true + sd * float(stream(car.seed, "bench test", path).standard_normal())
        bounds = [value - INSIDE * sd, value + INSIDE * sd]
        out.append({"match": path, "range": bounds, "start": value, "distribution": "gaussian"})
    return out


def _of_both_sides(axle: Axle, path: str) -> float:
    """The value of a path in an axle whose sides are equal, each the mean of this one's."""
    left, right = f"{path}@L", f"{path}@R"
    if left not in axle.values or right not in axle.values:
        return parameter_value(axle, path)
    mean = (axle.values[left] + axle.values[right]) / 2.0
    return parameter_value(axle.changed({left: mean, right: mean}), path)
