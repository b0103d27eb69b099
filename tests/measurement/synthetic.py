"""Rig records made from solved reference curves, with loops and noise of known size."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.interpolate import PchipInterpolator

from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES, CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LOAD_CASES
from doe_kc.measurement.channels import RIG_NAMES

DATA = Path(__file__).parents[1] / "data" / "reference"
EXAMPLE = Path(__file__).parents[2] / "examples" / "front_axle" / "rig"
COLUMNS = {
    "toe": "d_toe_deg",
    "camber": "d_camber_deg",
    "spin": "d_caster_knuckle_deg",
    "wc_x": "wc_dx_mm",
    "wc_y": "wc_dy_mm",
    "wc_z": "wc_dz_mm",
    "tyre_load": "fz_N",
}
CASES = {"vertical": "heave", "roll": "roll_body", "lateral": "lat_inphase", "brake": "brake"}


@lru_cache
def reference(name: str) -> CurveSet:
    """Solved curves of an axle of the reference data on their own grid."""
    table = pd.read_csv(DATA / f"{name}.csv")
    cases = {ours: _case(table[table.case == theirs], ours) for ours, theirs in CASES.items()}
    return CurveSet(name, cases, None, 790.0)


def _case(rows: pd.DataFrame, ident: str) -> CaseCurves:
    rows = rows[~((rows.branch == "neg") & (rows.step == 0))].sort_values("input")
    sides = [rows[rows.side == side] for side in "LR"]
    mean = {r: np.stack([s[c].to_numpy() for s in sides]) for r, c in COLUMNS.items()}
    inputs = sides[0].input.to_numpy()
    zero = {r: np.zeros_like(c) for r, c in mean.items()}
    return CaseCurves(ident, LOAD_CASES[ident].unit, inputs, mean, zero)


@dataclass(frozen=True)
class Errors:
    """Size of the errors in multiples of 0.003 deg, 0.02 mm, 4 N; gain as it is."""

    white: float = 0.0
    offset: float = 0.0
    gain: float = 0.0
    smooth: float = 0.0


RESOLUTION = {r: {"deg": 0.003, "mm": 0.02, "N": 4.0}[RESPONSE_UNITS[r]] for r in RIG_RESPONSES}


def triangle(samples: int = 512) -> FloatArray:
    """+1 -> -1 -> +1, the last sample one step short of +1."""
    phase = np.arange(samples) / samples
    return np.abs(4.0 * phase - 2.0) - 1.0


def record_columns(
    load_case: str,
    *,
    rng: np.random.Generator | None = None,
    errors: Errors = Errors(),
    half_width: float = 0.0,
    samples: int = 512,
) -> dict[str, FloatArray]:
    """Column heading -> samples of one run; half_width in multiples of the resolution."""
    case = LOAD_CASES[load_case]
    curves = reference("nominal").cases[load_case]
    relative = triangle(samples)
    falling = np.where(np.arange(samples) < samples // 2, 1.0, -1.0)
    out = {
        "time [s]": np.arange(samples) * 0.1,
        f"{case.channel} [{case.unit}]": case.amplitude * relative,
    }
    rng = rng or np.random.default_rng(0)
    for side, name in enumerate("LR"):
        for response in RIG_RESPONSES:
            truth = PchipInterpolator(curves.input, curves.mean[response][side])
            y = truth(case.amplitude * relative)
            change = y - truth(0.0)
            scale = RESOLUTION[response]
            wave = np.sqrt(2.0) * np.cos(2.5 * relative + rng.uniform(0.0, 2.0 * np.pi))
            y = y + half_width * scale * falling * (1.0 - relative**4)
            y = y + errors.gain * rng.normal() * change
            y = y + scale * (
                errors.white * rng.normal(size=samples) + errors.offset * rng.normal() + errors.smooth * wave
            )
            out[f"{RIG_NAMES[response]}_{name} [{RESPONSE_UNITS[response]}]"] = y
    return out


def truth(load_case: str, response: str) -> FloatArray:
    """(2, n) noise-free curve on the load case's own grid."""
    curves = reference("nominal").cases[load_case]
    grid = LOAD_CASES[load_case].inputs()
    return np.stack([PchipInterpolator(curves.input, c)(grid) for c in curves.mean[response]])


def csv_text(columns: Mapping[str, FloatArray]) -> str:
    rows = np.stack(list(columns.values()), axis=1)
    lines = [",".join(columns), *(",".join(f"{v:.12g}" for v in row) for row in rows)]
    return "\n".join(lines) + "\n"


def write_rig(
    folder: Path,
    *,
    cases: tuple[str, ...] = tuple(CASES),
    runs: int = 3,
    errors: Errors = Errors(1.0, 1.0, 0.002, 0.5),
    seed: int = 0,
    alignment: bool = True,
    half_width: float = 0.0,
) -> Path:
    """A whole test folder; returns the path of its test.toml."""
    rng = np.random.default_rng(seed)
    lines = ['name = "synthetic"']
    if alignment:
        side = "{ toe_deg = 0.02, camber_deg = -0.5, caster_deg = 4.2 }"
        lines += ["[alignment]", f"left = {side}", f"right = {side}"]
    lines.append("[records]")
    for case in cases:
        files = [f"{case}_{run}.csv" for run in range(runs)]
        lines.append(f"{case} = {files}")
        for file in files:
            columns = record_columns(case, rng=rng, errors=errors, half_width=half_width)
            (folder / file).write_text(csv_text(columns), encoding="utf-8")
    path = folder / "test.toml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path
