"""Curves from the results that ADAMS/Car writes itself: so far those of a parallel travel analysis.

No sample of the other analyses' requests is public, so that their signs are not known here: their curves come
by curves.csv.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.interpolate import PchipInterpolator

from doe_kc.adams.results import AdamsResult, read_result
from doe_kc.axle.model import Axle
from doe_kc.curves import SIDE_WORDS
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

PARALLEL_TRAVEL = "*_parallel_travel.res"
"""Names of the file that holds the load case `vertical`."""
PARALLEL_REQUESTS: Mapping[str, tuple[str, str]] = {
    "toe_deg": ("toe_angle.{side}", "deg"),
    "camber_deg": ("camber_angle.{side}", "deg"),
    "caster_deg": ("caster_angle.{side}", "deg"),
    "wc_z_mm": ("wheel_travel.vertical_{side}", "mm"),
    "tyre_load_N": ("{side}_tire_forces.normal", "N"),
}
"""Column of curves.csv -> request and component, and unit. Toe-in and top outwards positive, as in ADAMS."""


def vertical_frame(folder: Path, axle: Axle) -> pd.DataFrame | None:
    """Rows of `vertical` as curves.csv has them, None where there is no file of that name.

    The pad's travel, the input, is the wheel's and what the tyre has given way: z + (F - F at rest) / k.
    Curves are put on the load case's own inputs by a monotone cubic. InputError for what is wrong.
    """
    files = sorted(folder.glob(PARALLEL_TRAVEL))
    if not files:
        return None
    if len(files) > 1:
        raise InputError(f"{files[0].name} and {files[1].name} are both there; expected one.")
    result = read_result(files[0])
    sides = {s: _side(result, word, axle.values[f"tyre.rate@{s}"]) for s, word in SIDE_WORDS.items()}
    inputs = axle.load_cases["vertical"].inputs()
    low = max(pads[0] for pads, _ in sides.values())
    high = min(pads[-1] for pads, _ in sides.values())
    grid = np.unique(inputs[(inputs >= low) & (inputs <= high)])
    frames = []
    for side, (pads, columns) in sides.items():
        values = {name: PchipInterpolator(pads, column)(grid) for name, column in columns.items()}
        keys = {"load_case": "vertical", "branch": "travel", "input": grid, "input_unit": "mm", "side": side}
        frames.append(pd.DataFrame(keys | values))
    return pd.concat(frames, ignore_index=True)


def _side(result: AdamsResult, word: str, rate: float) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Pad travel, rising, and the columns of one wheel."""
    columns = {
        name: result.column(request.format(side=word), unit)
        for name, (request, unit) in PARALLEL_REQUESTS.items()
        if request.format(side=word) in result.values or name in ("wc_z_mm", "tyre_load_N")
    }
    travel, load = columns["wc_z_mm"], columns["tyre_load_N"]
    rest = int(np.argmin(np.abs(travel)))
    pads = travel - travel[rest] + (load - load[rest]) / rate
    pads, order = np.unique(pads, return_index=True)
    if pads.size < 4:
        raise InputError(f"{result.path}: the {word} wheel has {pads.size} positions; expected a sweep.")
    return pads, {name: column[order] for name, column in columns.items()}
