"""The rig's errors: levels drawn for each car, errors for each run. They are not told to the analyser."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from benchmarks.discovery.chance import spread
from doe_kc.curves import TYRE_LOAD, WHEEL_CENTRE
from doe_kc.ground.typing import FloatArray

RESOLUTION = {"angle": 0.003, "displacement": 0.02, "tyre_load": 4.0}
"""deg, mm, N: what the rig's papers say."""
OFFSET = {"angle": 0.0028, "displacement": 0.018, "tyre_load": 3.5}
SMOOTH = {"angle": 0.0018, "displacement": 0.0115, "tyre_load": 2.4}
GAIN = 1.6e-3
INPUT_WHITE = {"pad_z": 0.02, "roll": 0.002, "force_y": 3.0, "force_x": 3.0, "steering_wheel": 0.05}
"""In the input's unit."""
KNOTS = 41
"""Inputs at which a smooth error is drawn; a cubic spline in between."""


def kind(response: str) -> str:
    """Which sort of sensor reads a response."""
    if response == TYRE_LOAD:
        return "tyre_load"
    return "displacement" if response in WHEEL_CENTRE else "angle"


@dataclass(frozen=True)
class Levels:
    """Standard deviations by sensor kind, in its unit. gain: -; length: of the smooth error, over the
    amplitude. input_white: share of `INPUT_WHITE`. hysteresis: half-width of the rig's own loop that all
    runs share, and that comes anew with each, over white. outliers: probability of a bad sample; far: its
    error over white, +-."""

    white: Mapping[str, float]
    offset: Mapping[str, float]
    smooth: Mapping[str, float]
    gain: float
    length: float
    input_white: float
    hysteresis: float
    outliers: float
    far: tuple[float, float] = (5.0, 10.0)


def levels(rng: np.random.Generator, *, faults: bool) -> Levels:
    """Of one test day. faults: whether the rig has loops of its own and bad samples."""
    return Levels(
        white={k: v * float(rng.uniform(0.9, 1.15)) for k, v in RESOLUTION.items()},
        offset={k: spread(rng, v, 0.2) for k, v in OFFSET.items()},
        smooth={k: spread(rng, v, 0.2) for k, v in SMOOTH.items()},
        gain=spread(rng, GAIN, 0.25),
        length=float(rng.uniform(0.45, 0.6)),
        input_white=float(rng.uniform(0.9, 1.1)),
        hysteresis=float(rng.uniform(0.0, 0.08)) if faults else 0.0,
        outliers=float(rng.uniform(0.0, 4e-4)) if faults else 0.0,
    )


def rig_loops(
    levels_of: Levels, rng: np.random.Generator, responses: tuple[str, ...]
) -> dict[str, FloatArray]:
    """Response -> (2,) half-width of the rig's own loop in one load case, the same in all its runs."""
    return {r: levels_of.hysteresis * levels_of.white[kind(r)] * rng.standard_normal(2) for r in responses}


def read(
    clean: Mapping[str, FloatArray],
    change: Mapping[str, FloatArray],
    relative: FloatArray,
    levels_of: Levels,
    loops: Mapping[str, FloatArray],
    rng: np.random.Generator,
) -> dict[str, FloatArray]:
    """Response -> (2, n) as one run records it.

    clean, change: (2, n) true channel and its change from static. relative: (n,) input over amplitude,
    of one period that begins at its turning point.
    """
    way = np.where(np.arange(relative.size) < relative.size // 2, 1.0, -1.0)
    lens = way * (1.0 - relative**2)
    root = np.linalg.cholesky(_correlation(levels_of.length))
    out = {}
    for response, true in clean.items():
        of = kind(response)
        white = levels_of.white[of]
        rows = []
        for side in (0, 1):
            smooth = CubicSpline(np.linspace(-1.05, 1.05, KNOTS), root @ rng.standard_normal(KNOTS))
            own_loop = loops[response][side] + levels_of.hysteresis * white * rng.standard_normal()
            rows.append(
                true[side]
                + levels_of.offset[of] * rng.standard_normal()
                + levels_of.gain * rng.standard_normal() * change[response][side]
                + levels_of.smooth[of] * smooth(relative)
                + own_loop * lens
                + white * rng.standard_normal(relative.size)
                + white * _outliers(relative.size, levels_of, rng)
            )
        out[response] = np.array(rows)
    return out


def _outliers(count: int, levels_of: Levels, rng: np.random.Generator) -> FloatArray:
    hit = rng.random(count) < levels_of.outliers
    far = rng.uniform(*levels_of.far, count) * np.where(rng.random(count) < 0.5, -1.0, 1.0)
    return np.where(hit, far, 0.0)


def _correlation(length: float) -> FloatArray:
    """Matern 5/2 with the curvature at zero of exp(-d^2 / 2 l^2): rougher than what analysers assume."""
    at = np.linspace(-1.05, 1.05, KNOTS)
    d = np.abs(at[:, None] - at[None, :]) / length * np.sqrt(3.0)
    return np.asarray((1.0 + d + d**2 / 3.0) * np.exp(-d)) + 1e-10 * np.eye(KNOTS)
