"""The reference axle of the tests: curves solved by an independent multibody code (EXUDYN 1.13.6)."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from doe_kc.axle import Axle, parameter_value, with_values
from doe_kc.axle_file import read_axle
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.effects import EFFECTS, Effect, apply_effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.load_cases.vertical import Vertical

MCPHERSON_EFFECTS: dict[str, Effect] = {
    ident: effect for ident, effect in EFFECTS.items() if effect.possible(DEFAULT_PLACES)
}
"""Effects that the reference axle can have."""
DATA = Path(__file__).parent / "data" / "reference"
EXAMPLE = Path(__file__).parents[1] / "examples" / "front_axle"
POINT_NAMES = {"WC": "WLC", "SAL": "LWD"}
OTHER_PATHS = {
    "spring.k_N_mm": "spring.rate",
    "arb.k_N_mm": "arb.rate",
    "steering.column_N_mm": "steering.column",
    "tyre.k_radial_N_mm": "tyre.rate",
    "wheel.toe_deg": "static.toe",
    "wheel.camber_deg": "static.camber",
}
CASE_NAMES = {
    "heave": "vertical",
    "heave_wheel": "vertical_wheel",
    "roll_pads": "roll_pads",
    "roll_body": "roll",
    "lat_inphase": "lateral",
    "lat_antiphase": "lateral_opposite",
    "lat_inphase_30mm": "lateral_offset",
    "drive": "drive",
    "brake": "brake",
    "steer": "steer",
}


@lru_cache
def nominal() -> Axle:
    return read_axle(EXAMPLE / "axle.toml")


def variant(number: int) -> Axle:
    """The nominal axle with the changes of variant_N.toml."""
    document = tomllib.loads((DATA / f"variant_{number}.toml").read_text())
    axle = nominal()
    values: dict[str, float] = {}
    for point, change in document["points"].items():
        for axis, delta in zip("xyz", change, strict=True):
            path = f"{POINT_NAMES.get(point, point)}.{axis}"
            values[path] = parameter_value(axle, path) + delta
    for bushing, factors in document["bushing"].items():
        for axis, factor in zip(("Fx", "Fy", "Fz", "Tx", "Ty", "Tz"), factors, strict=True):
            values[f"{bushing.lower()}.{axis}"] = factor
    for key, value in document["other"].items():
        path = OTHER_PATHS[key]
        base = parameter_value(axle, path)
        values[path] = base + value if key.startswith("wheel.") else base * value
    return with_values(axle, values)


def with_effect(ident: str) -> Axle:
    """The nominal axle with the effect of effect_ID.toml."""
    (options,) = tomllib.loads((DATA / f"effect_{ident}.toml").read_text()).values()
    return apply_effect(nominal(), ident, options, source="reference")


def reference_cases(axle: Axle) -> dict[str, LoadCase]:
    """The project's load cases plus the reference's two further techniques."""
    return {
        **axle.load_cases,
        "vertical_wheel": Vertical(amplitude=80.0, steps=32, control="wheel"),
        "roll_pads": ROLL_TECHNIQUES["counter_phase"],
    }


def reference_axle(name: str) -> Axle:
    """Axle of a reference file, with all ten load cases."""
    if name == "nominal":
        axle = nominal()
    elif name.startswith("variant_"):
        axle = variant(int(name.removeprefix("variant_")))
    else:
        axle = with_effect(name.removeprefix("effect_"))
    return replace(axle, load_cases=reference_cases(axle))


@lru_cache
def reference_curves(name: str) -> pd.DataFrame:
    return pd.read_csv(DATA / f"{name}.csv")


FILES = sorted(p.stem for p in DATA.glob("*.csv"))


def steps_only(curves: CurveSet, axle: Axle) -> CurveSet:
    """The curves at the inputs of `LoadCase.inputs`, without those that loops have beside them."""
    return replace(curves, cases={i: _at_steps(c, axle.load_cases[i]) for i, c in curves.cases.items()})


def step_rows(inputs: FloatArray, case: LoadCase) -> NDArray[np.bool_]:
    """(n,) which inputs of a branch are among `LoadCase.inputs`."""
    return np.isclose(inputs[:, None], case.inputs(), rtol=0.0, atol=1e-9 * case.amplitude).any(axis=1)


def common_rows(one: FloatArray, other: FloatArray) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(n,) and (m,) which inputs of either branch both have, both ends among them."""
    same = np.isclose(one[:, None], other, rtol=0.0, atol=1e-9 * np.abs(one).max())
    assert same[0, 0] and same[-1, -1] and same.sum() > 2
    return same.any(axis=1), same.any(axis=0)


def _at_steps(curves: CaseCurves, case: LoadCase) -> CaseCurves:
    rows = step_rows(curves.input, case)
    assert rows.sum() == 2 * case.steps + 1

    def picked(lines: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        return {response: line[:, rows] for response, line in lines.items()}

    return replace(
        curves, input=curves.input[rows], mean=picked(curves.mean), half_width=picked(curves.half_width)
    )
