"""Base vehicles: the nominal axle that the analyser is given."""

from __future__ import annotations

import math
from pathlib import Path

from benchmarks.discovery.chance import cut_normal, spread, stream
from doe_kc.axle import Axle, design_parameters, with_values
from doe_kc.axle.model import BUSHING_AXES, BUSHINGS
from doe_kc.axle_file import read_axle
from doe_kc.axle_file.write import write_axle
from doe_kc.axle_types import BUILT_IN, DEFAULT_TYPE
from doe_kc.examples import example_folder

EXAMPLE = Path(__file__).parents[2] / "examples" / "front_axle" / "axle.toml"
TYPE_BASES = tuple(t for t in BUILT_IN if t != DEFAULT_TYPE)
"""Examples of other axle types, for the suites `null` and `type`."""
BASES = ("example", "shifted", *TYPE_BASES)
"""The shipped axle, or another car of its kind, one for each seed, to set thresholds on; other types."""
SHIFT_SD = 3.0
"""mm, of every coordinate."""
STIFFNESS_SD = 0.25
"""Of the logarithm, bushings."""
RATE_SD = 0.08
"""Of the logarithm, springs, tyres, anti-roll bar, column."""


def nominal_axle(base: str, seed: int) -> Axle:
    """The analyser's model; ValueError for an unknown base."""
    if base not in BASES:
        raise ValueError(f"base {base!r}, expected one of {', '.join(BASES)}")
    if base in TYPE_BASES:
        return read_axle(example_folder(base) / EXAMPLE.name)
    axle = read_axle(EXAMPLE)
    return axle if base == "example" else _shifted(axle, seed)


def write_nominal(axle: Axle, path: Path) -> Path:
    """The model as its own file; `read_axle(path)` gives the same values."""
    structure = axle.topology.structure
    known = structure is not None and structure.type in TYPE_BASES
    return write_axle(axle, example_folder(structure.type) / EXAMPLE.name if known else EXAMPLE, path)


def _shifted(axle: Axle, seed: int) -> Axle:
    rng = stream(seed, "vehicle")
    values = {
        p.path: round(p.nominal + SHIFT_SD * cut_normal(rng), 1)
        for p in design_parameters(axle)
        if p.group == "HARDPOINTS" and p.active
    }
    for name in BUSHINGS:
        for of in BUSHING_AXES:
            path = f"{name}.stiffness.{of}"
            values[path] = _readable(spread(rng, axle.values[f"{path}@L"], STIFFNESS_SD))
    for path in ("spring.rate", "tyre.rate", "tyre.static_load", "arb.rate", "steering.column"):
        own = axle.values.get(f"{path}@L", axle.values.get(path, 0.0))
        values[path] = _readable(spread(rng, own, RATE_SD))
    values["static.toe"] = round(0.05 + 0.05 * cut_normal(rng), 3)
    values["static.camber"] = round(-0.5 + 0.2 * cut_normal(rng), 3)
    return with_values(axle, values)


def _readable(value: float, digits: int = 3) -> float:
    return round(value, digits - 1 - math.floor(math.log10(abs(value))))
