"""From a rig's `test.toml` to curves, noise, trends, gradients and characteristics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from doe_kc.curves import CurveSet
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES
from doe_kc.measurement.branches import RunCurves, case_curves, changes, reduce_case
from doe_kc.measurement.channel_map import ChannelMap
from doe_kc.measurement.gradients import (
    Gradient,
    GradientEstimate,
    Windows,
    case_gradients,
    characteristic_estimates,
)
from doe_kc.measurement.manifest import Alignment, Manifest, load_manifest, manifest_channels
from doe_kc.measurement.noise import CaseNoise
from doe_kc.measurement.noise_estimation import estimate_noise
from doe_kc.measurement.records import RigRecord, read_record
from doe_kc.measurement.trend import PolynomialTrend, fit_trends

HALF_TRACK = 790.0
"""|y| of the design wheel centre, mm."""
MIN_WINDOW_POINTS = 3
"""A line through two points has no scatter to tell an error by."""
_ALIGNMENT_KEYS = {"toe": "toe_deg", "camber": "camber_deg", "spin": "caster_deg"}


@dataclass(frozen=True)
class Measurement:
    """A reduced rig measurement.

    curves: mean and half-width curves; they, not the trends, feed the characteristics, because a
        polynomial over the whole travel rings around the bump-stop kink, which shifts the gradient at
        static.
    runs: load case -> runs, main run first, with the raw record and its branches for pictures.
    trends: load case -> response -> (left, right) one-valued polynomial of all runs; empty where there are
        several cars.
    noise: load case -> response -> noise model of the mean curve.
    gradients: over the load-case input, every response and side.
    characteristics: id -> value and standard error; nan where load case or alignment is missing.
    cars: the single cars where this is the mean of several, on the same inputs; empty for one car.
    curve_scatter: load case -> response -> (2, n) standard deviation between cars, of one car; empty for
        one car. noise is without it, standard errors of characteristics are with it.
    """

    manifest: Manifest
    curves: CurveSet
    runs: Mapping[str, tuple[RunCurves, ...]]
    trends: Mapping[str, Mapping[str, tuple[PolynomialTrend, ...]]]
    noise: Mapping[str, CaseNoise]
    gradients: tuple[Gradient, ...]
    characteristics: Mapping[str, GradientEstimate]
    cars: tuple[Measurement, ...] = ()
    curve_scatter: Mapping[str, Mapping[str, FloatArray]] = field(default_factory=dict)

    def curve_sd(self, load_case: str) -> dict[str, FloatArray]:
        """Response -> (2, n) standard deviations of its mean curves, left and right, in its unit."""
        return {
            name: np.sqrt(
                np.maximum(np.array([self.curve_variance(load_case, name, s) for s in (0, 1)]), 0.0)
            )
            for name in self.noise.get(load_case, {})
        }

    def curve_variance(self, load_case: str, response: str, side: int) -> FloatArray:
        """(n,) variance of a mean curve as an estimate of the design's: noise, and scatter of the cars."""
        noise = np.diag(self.noise[load_case][response].covariance(side=side))
        if not self.cars:
            return noise
        return np.asarray(noise + self.curve_scatter[load_case][response][side] ** 2 / len(self.cars))


@one_thread()
def reduce_measurement(
    manifest_path: Path, *, windows: Windows | None = None, half_track: float = HALF_TRACK
) -> Measurement:
    """Reduce all records that `test.toml` (or the folder it lies in) names.

    windows: load case -> half-width of the fit window in the input's unit, default `LoadCase.window`.
    half_track: |y| of the design wheel centre, mm. Raises InputError for any fault of the user's files.
    """
    path = manifest_path / "test.toml" if manifest_path.is_dir() else manifest_path
    manifest = load_manifest(path)
    check_windows(windows or {})
    runs = {case: reduce_case(case_records(path, manifest, case)) for case in measured_cases(manifest)}
    noise = estimate_noise(runs, sensor_resolution(manifest))
    reduced = assembled(manifest, measured_curves(manifest, runs, half_track), runs, noise, windows or {})
    return replace(reduced, trends={case: _trends(members) for case, members in runs.items()})


def measured_curves(
    manifest: Manifest, runs: Mapping[str, tuple[RunCurves, ...]], half_track: float
) -> CurveSet:
    """Mean curves and half widths of the reduced runs of each load case."""
    return CurveSet(
        source=manifest.name,
        cases={case: case_curves(case, members) for case, members in runs.items()},
        static=static_angles(manifest.alignment),
        half_track=half_track,
    )


def assembled(
    manifest: Manifest,
    curves: CurveSet,
    runs: Mapping[str, tuple[RunCurves, ...]],
    noise: Mapping[str, CaseNoise],
    windows: Windows,
) -> Measurement:
    """The measurement of reduced curves with their noise, without trends; InputError for a window with too
    few points."""
    check_window_points(curves, windows)
    angle_sd = static_sd(manifest.alignment)
    gradients = [case_gradients(curves.cases[case], noise[case], windows) for case in runs]
    return Measurement(
        manifest=manifest,
        curves=curves,
        runs=runs,
        trends={},
        noise=noise,
        gradients=tuple(g for group in gradients for g in group),
        characteristics=characteristic_estimates(curves, noise, windows, static_sd=angle_sd),
    )


def static_angles(alignment: Alignment | None) -> dict[str, FloatArray] | None:
    """Response -> (2,) static angles in deg, nan for a side that was not measured; None without any."""
    if alignment is None:
        return None
    out = {}
    for response, key in _ALIGNMENT_KEYS.items():
        values = [getattr(side, key, None) for side in (alignment.left, alignment.right)]
        if any(v is not None for v in values):
            out[response] = np.array([np.nan if v is None else v for v in values])
    return out or None


def static_sd(alignment: Alignment | None) -> dict[str, float]:
    """Response -> standard deviation of its static angle, deg."""
    sd = (alignment or Alignment()).sd
    return {response: getattr(sd, key) for response, key in _ALIGNMENT_KEYS.items()}


def measured_cases(manifest: Manifest) -> list[str]:
    """Load cases that have records, in the order of the package."""
    return [case for case in CASE_ORDER if case in manifest.records]


def case_records(path: Path, manifest: Manifest, load_case: str) -> list[RigRecord]:
    """Main run and repeats of a load case. path: of the manifest. InputError for a bad one, or a copy."""
    channels = manifest_channels(path, manifest)
    records = [_read(path.parent, entry, load_case, channels) for entry in manifest.records[load_case]]
    main = records[0]
    for record in records[1:]:
        if record.channels.keys() != main.channels.keys():
            raise InputError(
                f"{record.label}: does not have the same channels as {main.label}; expected repeats of one "
                "test with the same sensors, list them apart or export the missing ones."
            )
        if type(record.case) is not type(main.case):
            raise InputError(
                f"{record.label}: its input is {record.case.channel}, that of {main.label} "
                f"{main.case.channel}; expected repeats of one test, list them apart."
            )
        _refuse_copy(main, record)
    return records


def _refuse_copy(main: RigRecord, record: RigRecord) -> None:
    """A copy would pass for perfect repeatability."""
    same = main.input.shape == record.input.shape and np.array_equal(main.input, record.input)
    if same and all(np.array_equal(c, record.channels[r]) for r, c in main.channels.items()):
        raise InputError(
            f"{record.label}: holds the same samples as {main.label}; expected a repeat run, "
            "list the right file or drop it."
        )


def _read(folder: Path, entry: str, load_case: str, channels: ChannelMap) -> RigRecord:
    name, mark, sheet = entry.partition("#")
    return read_record(folder / name, load_case, sheet=sheet if mark else None, channels=channels)


def sensor_resolution(manifest: Manifest) -> dict[str, float]:
    """Sensor kind -> resolution in deg, mm or N."""
    r = manifest.sensor_resolution
    return {"angle": r.angle_deg, "displacement": r.displacement_mm, "tyre_load": r.tyre_load_N}


def _trends(runs: tuple[RunCurves, ...]) -> dict[str, tuple[PolynomialTrend, ...]]:
    """Trends of all responses in one go, from the samples of every run's loop, changes from static."""
    grid = runs[0].input
    inputs, values = [], []
    for run in runs:
        at = np.concatenate([run.loop.unload, run.loop.load])
        inputs.append(run.record.input[at])
        values.append(np.concatenate([_referred(run, r, grid)[:, at] for r in run.record.channels]))
    fits = fit_trends(np.concatenate(inputs), np.concatenate(values, axis=1))
    return {r: fits[2 * k : 2 * k + 2] for k, r in enumerate(runs[0].record.channels)}


def _referred(run: RunCurves, response: str, grid: FloatArray) -> FloatArray:
    """(2, samples) channel as change from the run's own static value; tyre load absolute."""
    mean = run.mean(response)
    shift = changes(response, mean, grid) - mean
    out: FloatArray = run.record.channels[response] + shift[:, :1]
    return out


def check_windows(windows: Windows) -> None:
    """InputError for a window of no load case, or no width."""
    for case, half_width in windows.items():
        if case not in LOAD_CASES:
            raise InputError(
                f'fit window of "{case}": is no load case, expected one of {", ".join(LOAD_CASES)};'
                f"{nearest(case, LOAD_CASES)} Rename it."
            )
        if not (np.isfinite(half_width) and half_width > 0.0):
            raise InputError(
                f"fit window of {case}: {half_width:g} is no half-width, expected a positive number "
                f"of {LOAD_CASES[case].unit}; correct it."
            )


def check_window_points(curves: CurveSet, windows: Windows) -> None:
    """InputError when a fit window holds too few points of a measured curve."""
    for name, case in curves.cases.items():
        limit = windows.get(name)
        inside = case.input.size if limit is None else int(np.sum(np.abs(case.input) <= limit * (1 + 1e-9)))
        if inside < MIN_WINDOW_POINTS:
            step = float(np.diff(case.input).max())
            raise InputError(
                f"fit window of {name}: ±{limit:g} {case.input_unit} holds {inside} point of the curve, "
                f"expected at least {MIN_WINDOW_POINTS}; widen it to ±{step:g} or more."
            )
