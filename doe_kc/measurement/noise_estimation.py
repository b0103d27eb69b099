"""Noise models of all load cases from the reduced runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from doe_kc.curves import ANGLES, RIG_RESPONSES, TYRE_LOAD, WHEEL_CENTRE
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.branches import RunCurves, static_index
from doe_kc.measurement.noise import CaseNoise, ErrorComponents, NoiseModel
from doe_kc.measurement.repeatability import (
    Repeats,
    components_from_resolution,
    error_components,
    thinned,
)
from doe_kc.measurement.white_noise import pooled_white_sd

SENSOR_KINDS: Mapping[str, tuple[str, ...]] = {
    "angle": tuple(r for r in RIG_RESPONSES if r in ANGLES),
    "displacement": WHEEL_CENTRE,
    "tyre_load": (TYRE_LOAD,),
}
"""Responses measured by the same kind of sensor share their run-to-run error components."""

Runs = Mapping[str, Sequence[RunCurves]]


def estimate_noise(runs: Runs, resolution: Mapping[str, float]) -> dict[str, CaseNoise]:
    """Load case -> response -> noise model.

    runs: load case -> reduced runs, main run first. resolution: sensor kind -> deg, mm or N.
    White noise comes from each channel itself; offset, gain and smooth error from the repeats, pooled
    per sensor kind. A kind without any repeats gets them from the resolution, marked so in `source`.
    """
    out: dict[str, dict[str, NoiseModel]] = {case: {} for case in runs}
    for kind, responses in SENSOR_KINDS.items():
        partial = {
            case: {r: _uninformed(case, r, members, resolution[kind]) for r in responses if _has(members, r)}
            for case, members in runs.items()
        }
        pooled = [c for case in runs for r in partial[case] for c in _repeats(partial[case][r], runs[case])]
        components = error_components(pooled, resolution[kind]) if pooled else None
        for case, members in runs.items():
            for r in partial[case]:
                out[case][r] = _informed(partial[case][r], members, components)
    return dict(out)


def _has(runs: Sequence[RunCurves], response: str) -> bool:
    return response in runs[0].record.channels


def _uninformed(case: str, response: str, runs: Sequence[RunCurves], resolution: float) -> NoiseModel:
    """White noise and shape; run-to-run components still those of the resolution."""
    grid = runs[0].input
    curve = np.mean([run.mean(response) for run in runs], axis=0)
    at = static_index(grid)
    slope = np.gradient(curve, grid, axis=1)
    return NoiseModel(
        load_case=case,
        response=response,
        white=pooled_white_sd([run.record.channels[response] for run in runs]),
        input_white=pooled_white_sd([run.record.input for run in runs]),
        loop=0.0,
        components=components_from_resolution(resolution),
        input=grid,
        gram=np.mean([run.gram for run in runs], axis=0),
        slope=slope,
        signal=curve - curve[:, at : at + 1],
        runs=len(runs),
    )


def _repeats(model: NoiseModel, runs: Sequence[RunCurves]) -> list[Repeats]:
    if len(runs) < 2:
        return []
    relative = model.input / np.abs(model.input).max()
    values = np.stack([run.mean(model.response) for run in runs])
    return [
        thinned(relative, _white_covariance(model, side), model.signal[side], values[:, side])
        for side in (0, 1)
    ]


def _white_covariance(model: NoiseModel, side: int) -> FloatArray:
    level = np.sqrt(model.white**2 + (model.slope[side] * model.input_white) ** 2)
    out: FloatArray = model.gram * np.outer(level, level)
    return out


def _informed(model: NoiseModel, runs: Sequence[RunCurves], components: ErrorComponents | None) -> NoiseModel:
    if components is None:
        return model
    values = {f: getattr(model, f) for f in NoiseModel.__dataclass_fields__}
    return NoiseModel(**values | {"components": components, "loop": _loop_scatter(model, runs)})


def _loop_scatter(model: NoiseModel, runs: Sequence[RunCurves]) -> float:
    """sd of the half-width from run to run beyond white noise, by moments; 0 with one run."""
    if len(runs) < 2 or any(run.one_branch for run in runs):
        return 0.0
    half = np.stack([run.half_width(model.response) for run in runs])
    observed = float(np.mean(np.var(half, axis=0, ddof=1)))
    white = float(np.mean([np.diag(_white_covariance(model, side)).mean() for side in (0, 1)]))
    return float(np.sqrt(max(0.0, observed - white)))
