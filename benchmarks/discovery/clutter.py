"""What every real car also has: all other effects, each far below its typical size."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.discovery.catalogue import CATALOGUE, PROGRESSION
from benchmarks.discovery.chance import sign
from benchmarks.discovery.hidden import Hidden
from doe_kc.axle import Axle
from doe_kc.axle.places import places_of
from doe_kc.effects import EFFECTS
from doe_kc.effects._friction import TRAVEL

SHARE = (0.02, 0.05)
"""Of the typical size."""
MEAN = sum(SHARE) / 2
SIZE_SD = (SHARE[1] - SHARE[0]) / math.sqrt(12.0) / MEAN
"""Relative standard deviation of their sizes, from car to car."""
TRAVEL_SD = 0.45
"""Of the logarithm of a friction's presliding travel, drawn evenly over a factor of 4 to 4.8."""
TYPICAL = 0.02
"""1/mm^2, progression of the bushings of other axle types."""
PRESENT = (
    "hub_compliance",
    "strut_bending",
    "rack_mount_compliance",
    "subframe_flexibility",
    "tyre_horizontal_compliance",
    "ride_height_offset",
    "steering_friction",
    "strut_friction",
    "damper_friction",
)
"""Free play is none or felt, and the sides are unequal anyway. Friction shows in the loops even so: 4 % of
its typical size is fifty standard deviations, a trace that is worth a line but no name."""


def clutter(axle: Axle, rng: np.random.Generator, but: Collection[str]) -> tuple[Hidden, ...]:
    """Small effects of one car, without those of the ids in `but`."""
    present = [ident for ident in PRESENT if EFFECTS[ident].possible(places_of(axle))]
    drawn = [CATALOGUE[ident](rng, float(rng.uniform(*SHARE)), axle) for ident in present]
    drawn += [_preload(rng, axle), _progression(rng, axle)]
    return tuple(h for h in drawn if h.id not in but)


def unlike(small: Hidden) -> list[Hidden]:
    """The small effect as it is in a car like this one: larger by one standard deviation, and a friction of a
    longer travel. Nobody knows either of a car."""
    larger = replace(small, options={k: _larger(small, k, v) for k, v in small.options.items()})
    if TRAVEL not in small.options:
        return [larger]
    longer = {**small.options, TRAVEL: small.options[TRAVEL] * math.exp(TRAVEL_SD)}
    return [larger, replace(small, options=longer)]


def _larger(small: Hidden, option: str, value: Any) -> Any:
    if isinstance(value, list):  # of a progression beyond that of the axle, of which there is some
        added = [small.parameters[f"{option}[{i}]"] for i in range(len(value))]
        return [v + SIZE_SD * more for v, more in zip(value, added, strict=True)]
    if option in small.stiff:
        return value / (1.0 + SIZE_SD)
    return value * (1.0 + SIZE_SD) if option in small.parameters else value


def _preload(rng: np.random.Generator, axle: Axle) -> Hidden:
    """Every bushing a little, about every axis."""
    options = {
        name: [600.0 * float(rng.uniform(*SHARE)) * sign(rng) for _ in range(3)]
        for name in (n.upper() for n in places_of(axle).bushings)
    }
    return Hidden("bushing_preload", MEAN, None, options, _numbers(options))


def _progression(rng: np.random.Generator, axle: Axle) -> Hidden:
    mcpherson = set(PROGRESSION) <= {n.upper() for n in places_of(axle).bushings}
    typical = PROGRESSION if mcpherson else {n.upper(): TYPICAL for n in places_of(axle).bushings}
    added = {n: [b * float(rng.uniform(*SHARE)) for _ in range(3)] for n, b in typical.items()}
    options = {}
    for name, values in added.items():
        nominal = [axle.values[f"{name.lower()}.cubic.{of}@L"] for of in ("Fx", "Fy", "Fz")]
        options[name] = [b + more for b, more in zip(nominal, values, strict=True)]
    return Hidden("bushing_progression", MEAN, None, options, _numbers(added))


def _numbers(lists: Mapping[str, Sequence[float]]) -> dict[str, float]:
    return {f"{name}[{i}]": value for name, values in lists.items() for i, value in enumerate(values)}
