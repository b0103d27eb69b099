"""Production scatter of one car: every default variable off its nominal value, and both sides unequal."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmarks.discovery.chance import cut_normal, sign
from doe_kc.axle import Axle, Parameter, design_parameters
from doe_kc.axle.model import BUSHINGS, HARDPOINTS
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
    for name in HARDPOINTS:
        for coordinate in "xyz":
            out |= _apart(axle.values, f"{name}.{coordinate}", share * POINT_SIDES * cut_normal(rng))
    for name in BUSHINGS:
        for of in ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz"):
            ratio = math.exp(share * STIFFNESS_SIDES * cut_normal(rng))
            out |= _ratio(axle.values, f"{name}.{of}", ratio)
    for name in ("spring.rate", "tyre.rate"):
        out |= _ratio(axle.values, name, math.exp(share * RATE_SIDES * cut_normal(rng)))
    for name in ("static.toe", "static.camber"):
        out |= _apart(axle.values, name, share * ANGLE_SIDES * cut_normal(rng))
    return out


def _apart(values: Mapping[str, float], name: str, difference: float) -> dict[str, float]:
    left, right = f"{name}@L", f"{name}@R"
    return {left: values[left] - difference / 2, right: values[right] + difference / 2}


def _ratio(values: Mapping[str, float], name: str, ratio: float) -> dict[str, float]:
    left, right = f"{name}@L", f"{name}@R"
    return {left: values[left] / math.sqrt(ratio), right: values[right] * math.sqrt(ratio)}
