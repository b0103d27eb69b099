"""Production scatter of one car: every default variable off its nominal value, and both sides unequal."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from benchmarks.discovery.chance import cut_normal, sign
from doe_kc.axle import Axle, Parameter, design_parameters
from doe_kc.axle.members import drawn_points
from doe_kc.axle.places import places_of
from doe_kc.variables.build import in_model

MORE_SHARE = 1 / 3
"""Of the cars have worn or badly sorted bushings."""
MORE_SD = 0.45
FACTORS = (0.5, 2.0)
"""No bushing is off by more."""
SD = {
    "HARDPOINTS": 1.0,
    "BUSHINGS": 0.2,
    "static.toe": 0.05,
    "static.camber": 0.1,
    "bump_stop.clearance": 1.0,
    "rebound_stop.clearance": 1.0,
    "spring.rate": 0.02,
    "tyre.rate": 0.02,
    "arb.radius": 0.01,  # 4 % of its rate
}
"""mm and deg; of the logarithm for stiffnesses, rates and radii."""
EFFECTS_THEMSELVES = ("ride_height",)
"""Variables that are a hidden effect in other words: its size is drawn with the effects."""


@dataclass(frozen=True)
class Spread:
    """shift: mean of the scatter in standard deviations, its sign drawn for each variable. width: of the
    standard deviations. sides: share of the side differences, 0 for a symmetric car."""

    shift: float = 0.0
    width: float = 1.0
    sides: float = 1.0


STIFFNESS_SIDES = 0.025
"""Standard deviation of the logarithm of right over left: bushings."""
RATE_SIDES = 0.005
"""Springs and tyres, sorted in pairs."""
POINT_SIDES = 0.2
"""mm."""
ANGLE_SIDES = 0.02
"""deg."""


def scattered(axle: Axle, rng: np.random.Generator, spread: Spread) -> dict[str, float]:
    """Path -> absolute value of what a correlation tunes by default."""
    more = rng.random() < MORE_SHARE
    out = {}
    for parameter in design_parameters(axle):
        if not in_model(parameter) or parameter.path in EFFECTS_THEMSELVES:
            continue
        sd = MORE_SD if more and parameter.group == "BUSHINGS" else _sd(parameter)
        step = spread.width * sd * cut_normal(rng) + spread.shift * sd * sign(rng)
        out[parameter.path] = _moved(parameter, step)
    return out


def _sd(parameter: Parameter) -> float:
    return SD.get(parameter.path) or SD[parameter.group]


def _moved(parameter: Parameter, step: float) -> float:
    if parameter.group == "BUSHINGS":
        return float(np.clip(parameter.nominal * math.exp(step), *FACTORS))
    if parameter.path.endswith((".rate", ".radius")):
        return parameter.nominal * math.exp(step)
    return parameter.nominal + step


def unequal(axle: Axle, rng: np.random.Generator, share: float) -> dict[str, float]:
    """Internal values of both sides of a car that is not its own mirror image."""
    out: dict[str, float] = {}
    for difference in _differences(axle):
        out |= difference(axle, share * cut_normal(rng))
    return out


def unequal_in_one(axle: Axle) -> list[Axle]:
    """The axle with each difference between its sides by itself, of one standard deviation."""
    return [axle.changed(difference(axle, 1.0)) for difference in _differences(axle)]


def _differences(axle: Axle) -> Iterator[Callable[[Axle, float], dict[str, float]]]:
    """Of an axle and standard deviations, the internal values of both sides."""
    for name in drawn_points(axle):
        for coordinate in "xyz":
            yield partial(_apart, f"{name}.{coordinate}", POINT_SIDES)
    for name in places_of(axle).bushings:
        for of in ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz"):
            yield partial(_ratio, f"{name}.{of}", STIFFNESS_SIDES)
    for name in ("spring.rate", "tyre.rate"):
        yield partial(_ratio, name, RATE_SIDES)
    for name in ("static.toe", "static.camber"):
        yield partial(_apart, name, ANGLE_SIDES)


def _apart(name: str, sd: float, axle: Axle, step: float) -> dict[str, float]:
    left, right = f"{name}@L", f"{name}@R"
    return {left: axle.values[left] - sd * step / 2, right: axle.values[right] + sd * step / 2}


def _ratio(name: str, sd: float, axle: Axle, step: float) -> dict[str, float]:
    left, right = f"{name}@L", f"{name}@R"
    root = math.sqrt(math.exp(sd * step))
    return {left: axle.values[left] / root, right: axle.values[right] * root}
