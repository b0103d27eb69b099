"""Correlation problems on the virtual cars whose answer is known."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.axle import with_values
from doe_kc.axle.model import Axle
from doe_kc.axle_file import read_axle
from doe_kc.characteristics import CHARACTERISTICS, reduce_all
from doe_kc.correlation.likelihood import build_likelihood
from doe_kc.correlation.loop import Evaluate
from doe_kc.correlation.problem import Problem
from doe_kc.measurement import Measurement, reduce_measurement
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.targets import build_targets
from doe_kc.targets.options import CharacteristicOptions
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import VariableOptions, build_space

RIG = Path(__file__).parents[1] / "data" / "rig"
AXLE = Path(__file__).parents[2] / "examples" / "front_axle" / "axle.toml"
BUSHING_AXES = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")
POINTS = {"WC": "WLC", "SAL": "LWD"}


@lru_cache(maxsize=4)
def measured(car: str) -> Measurement:
    """The reduced records of a car."""
    return reduce_measurement(RIG / car)


def problem(
    car: str = "car_b",
    options: VariableOptions | None = None,
    axle: Axle | None = None,
    *,
    characteristics: Sequence[CharacteristicOptions] = (),
) -> Problem:
    """All variables of the nominal axle against a car's records."""
    model = axle if axle is not None else read_axle(AXLE)
    targets = build_targets(model, measured(car), characteristics, [], source="test")
    return Problem(
        axle=model,
        space=build_space(model, options or VariableOptions(), "test"),
        targets=targets,
        likelihood=build_likelihood(model, measured(car), targets),
        windows={},
        exact=True,
    )


def solver(axle: Axle) -> Evaluate:
    """True-solver evaluations in this process."""

    def evaluate(designs: Sequence[Mapping[str, float]]) -> list[Outcome]:
        return [outcome(axle, values) for values in designs]

    return evaluate


def outcome(axle: Axle, values: Mapping[str, float]) -> Outcome:
    """One design's answer."""
    solution = solve(with_values(axle, values), throw=False)
    if solution.failure is not None:
        return Outcome(None, np.full(len(CHARACTERISTICS), np.nan), str(solution.failure), 0.0)
    curves = curve_set(solution)
    return Outcome(curves, np.array(list(reduce_all(curves).values())), "", 0.0)


def truth(car: str, axle: Axle) -> dict[str, float]:
    """Path -> absolute value of every parameter that the car's key states."""
    key: dict[str, Any] = tomllib.loads((RIG / f"{car}.key.toml").read_text())
    at = axle.values
    out = {
        f"{POINTS.get(point, point)}.{axis}": at[f"{POINTS.get(point, point)}.{axis}@L"] + shift
        for point, shifts in key["points"].items()
        for axis, shift in zip("xyz", shifts, strict=True)
    }
    for name, factors in key["bushing"].items():
        out |= {f"{name.lower()}.{a}": f for a, f in zip(BUSHING_AXES, factors, strict=True)}
    other = key["other"]
    return out | {
        "spring.rate": at["spring.rate@L"] * other["spring.k_N_mm"],
        "tyre.rate": at["tyre.rate@L"] * other["tyre.k_radial_N_mm"],
        "arb.radius": at["arb.radius"] * other["arb.k_N_mm"] ** 0.25,
        "scb.Tz": other["steering.column_N_mm"],
        "static.toe": at["static.toe@L"] + other["wheel.toe_deg"],
        "static.camber": at["static.camber@L"] + other["wheel.camber_deg"],
        "ride_height": 0.0,
    }
