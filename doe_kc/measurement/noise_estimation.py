"""Noise models of all load cases from the reduced runs: their errors by restricted maximum likelihood."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.curves import ANGLES, RIG_RESPONSES, TYRE_LOAD, WHEEL_CENTRE
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.branches import RunCurves, static_index
from doe_kc.measurement.noise import CaseNoise, ErrorComponents, NoiseModel, pooled_white_sd

LIKELIHOOD_POINTS = 21
"""Inputs per curve in the likelihood: enough for the shortest correlation length, cheap to factor."""
_BOUNDS = ((-7.0, 4.0), (-12.0, -2.0), (-7.0, 4.0), (np.log(0.1), np.log(1.0)))
_START = np.log([1.0, 2e-3, 0.5, 0.3])

TYPICAL_GAIN = 2e-3
"""Run-to-run gain error assumed of a rig whose repeats are not at hand, -."""
TYPICAL_LENGTH = 0.3
"""The same of the correlation length, share of the amplitude; also where the likelihood starts from."""


@dataclass(frozen=True)
class Repeats:
    """One curve of one side, R runs on n inputs; n is the same for all curves that are pooled.

    relative: (n,) input / amplitude. white: (n, n) known white-noise covariance of a run.
    signal: (n,) change from static. runs: (R, n) values as recorded, R >= 2.
    """

    relative: FloatArray
    white: FloatArray
    signal: FloatArray
    runs: FloatArray


def thinned(relative: FloatArray, white: FloatArray, signal: FloatArray, runs: FloatArray) -> Repeats:
    """`Repeats` on POINTS of the grid's inputs."""
    at = np.linspace(0, relative.size - 1, LIKELIHOOD_POINTS).round().astype(int)
    return Repeats(relative[at], white[np.ix_(at, at)], signal[at], runs[:, at])


def error_components(curves: Sequence[Repeats], resolution: float) -> ErrorComponents:
    """Most likely offset, gain, smooth sd and correlation length behind the runs' differences.

    Each run of curve c is y_c + e with one unknown y_c and e ~ N(0, W_c + o² 11' + g² s s' + a² K_l);
    the runs' deviations from their mean carry R - 1 degrees of freedom each (REML). Curves of one
    sensor kind are pooled, since three runs of one curve determine a standard deviation to ±50 % only.
    resolution: of the sensor, sets the scale of the search (components from 1e-3 of it).
    """
    scatter = [_scatter(c) for c in curves]
    stack = _Stack(
        white=np.stack([c.white for c in curves]),
        ones=np.ones((LIKELIHOOD_POINTS, LIKELIHOOD_POINTS)),
        signal=np.stack([np.outer(c.signal, c.signal) for c in curves]),
        relative=np.stack([c.relative for c in curves]),
        scatter=np.stack(scatter),
        weight=np.array([c.runs.shape[0] - 1.0 for c in curves]),
        resolution=resolution,
    )
    from scipy.optimize import minimize

    best = minimize(stack.deviance, _START, method="L-BFGS-B", bounds=_BOUNDS)
    offset, gain, smooth, length = np.exp(best.x)
    return ErrorComponents(
        offset=float(offset * resolution),
        gain=float(gain),
        smooth=float(smooth * resolution),
        length=float(length),
        dof=int(stack.weight.sum()),
        source="repeats",
    )


def components_from_resolution(resolution: float) -> ErrorComponents:
    """Stand-in when there is one run only: offset = smooth = resolution, gain 0.2 %, dof 0."""
    return ErrorComponents(resolution, TYPICAL_GAIN, resolution, TYPICAL_LENGTH, 0, "resolution")


def _scatter(curve: Repeats) -> FloatArray:
    deviations = curve.runs - curve.runs.mean(axis=0)
    out: FloatArray = deviations.T @ deviations
    return out


@dataclass(frozen=True)
class _Stack:
    """The curves as arrays over the leading axis, for one batched factorisation."""

    white: FloatArray
    ones: FloatArray
    signal: FloatArray
    relative: FloatArray
    scatter: FloatArray
    weight: FloatArray
    resolution: float

    def covariance(self, log_parameters: FloatArray) -> FloatArray:
        offset, gain, smooth, length = np.exp(log_parameters)
        distance = (self.relative[:, :, None] - self.relative[:, None, :]) / length
        total: FloatArray = (
            self.white
            + (offset * self.resolution) ** 2 * self.ones
            + gain**2 * self.signal
            + (smooth * self.resolution) ** 2 * np.exp(-0.5 * distance**2)
        )
        # Noise-free records leave nothing to factor; a thousandth of the resolution is no noise.
        jitter = (1e-3 * self.resolution) ** 2 * np.eye(LIKELIHOOD_POINTS)
        out: FloatArray = total + jitter
        return out

    def deviance(self, log_parameters: FloatArray) -> float:
        """-2 log restricted likelihood + constant: sum (R-1) ln|C| + tr(C^-1 D'D), per curve."""
        covariance = self.covariance(log_parameters)
        _, log_det = np.linalg.slogdet(covariance)
        quadratic = np.trace(np.linalg.solve(covariance, self.scatter), axis1=1, axis2=2)
        return float(np.sum(self.weight * log_det + quadratic)) / float(self.weight.sum())


SENSOR_KINDS: Mapping[str, tuple[str, ...]] = {
    "angle": tuple(r for r in RIG_RESPONSES if r in ANGLES),
    "displacement": WHEEL_CENTRE,
    "tyre_load": (TYRE_LOAD,),
}
"""Responses measured by the same kind of sensor share their run-to-run error components."""

Runs = Mapping[str, Sequence[RunCurves]]


def estimate_noise(runs: Runs, resolution: Mapping[str, float]) -> dict[str, CaseNoise]:
    """Load case -> response -> noise model of one car.

    runs: load case -> reduced runs, main run first. resolution: sensor kind -> deg, mm or N.
    White noise comes from each channel itself; offset, gain and smooth error from the repeats, pooled
    per sensor kind. A kind without any repeats gets them from the resolution, marked so in `source`.
    """
    return estimate_common_noise([runs], resolution)[0]


def estimate_common_noise(
    cars: Sequence[Runs], resolution: Mapping[str, float]
) -> tuple[dict[str, CaseNoise], ...]:
    """As `estimate_noise` for every car, the repeats of all pooled: they are errors of one rig, which more
    repeats tell better."""
    out: tuple[dict[str, dict[str, NoiseModel]], ...] = tuple({case: {} for case in runs} for runs in cars)
    for kind, responses in SENSOR_KINDS.items():
        partial = [
            {
                case: {
                    r: _uninformed(case, r, members, resolution[kind]) for r in responses if _has(members, r)
                }
                for case, members in runs.items()
            }
            for runs in cars
        ]
        pooled = [
            c
            for runs, models in zip(cars, partial, strict=True)
            for case in runs
            for r in models[case]
            for c in _repeats(models[case][r], runs[case])
        ]
        components = error_components(pooled, resolution[kind]) if pooled else None
        for own, runs, models in zip(out, cars, partial, strict=True):
            for case, members in runs.items():
                for r in models[case]:
                    own[case][r] = _informed(models[case][r], members, components)
    return tuple(dict(own) for own in out)


def mean_noise(models: Sequence[NoiseModel]) -> NoiseModel:
    """Noise model of the mean of several cars' mean curves on one grid.

    Its covariance is 1/n^2 times the sum of theirs: `runs` counts n^2 / sum(1 / R_i), and the white noise,
    that of loops, slopes and signals are the means that make it so. The components are common to all.
    """
    shares = np.array([1.0 / m.runs for m in models])
    weights = shares / shares.sum()

    def mean(of: Callable[[NoiseModel], FloatArray | float]) -> FloatArray:
        return np.asarray(sum(w * np.asarray(of(m)) for w, m in zip(weights, models, strict=True)))

    return replace(
        models[0],
        white=float(np.sqrt(mean(lambda m: m.white**2))),
        input_white=float(np.sqrt(mean(lambda m: m.input_white**2))),
        loop=float(np.sqrt(mean(lambda m: m.loop**2))),
        gram=mean(lambda m: m.gram),
        slope=mean(lambda m: m.slope),
        signal=mean(lambda m: m.signal),
        runs=len(models) ** 2 / float(shares.sum()),
    )


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
