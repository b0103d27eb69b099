"""Several measured cars of one design as one measurement: the mean car, and how far the cars scatter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.branches import RunCurves, reduce_case
from doe_kc.measurement.car_scatter import car_figures, scatter_sd
from doe_kc.measurement.gradients import GradientEstimate, Windows
from doe_kc.measurement.manifest import Alignment, AlignmentSd, Manifest, SideAlignment, load_manifest
from doe_kc.measurement.noise import CaseNoise
from doe_kc.measurement.noise_estimation import estimate_common_noise, mean_noise
from doe_kc.measurement.reduction import (
    HALF_TRACK,
    Measurement,
    assembled,
    case_records,
    check_windows,
    measured_cases,
    measured_curves,
    reduce_measurement,
    sensor_resolution,
)
from doe_kc.measurement.same_test import TestedCar, refuse_unlike

NAMED_CARS = 4
"""Cars that the name of their mean lists."""


@one_thread()
def reduce_cars(
    manifest_paths: Sequence[Path], *, windows: Windows | None = None, half_track: float = HALF_TRACK
) -> Measurement:
    """The measurement of one car, or the mean of several; arguments as of `reduce_measurement`.

    Mean and half-width curves are the means of those of the cars, on the inputs that every car reaches;
    `noise` is that of these means, its components pooled over the repeats of all cars. The scatter of the
    cars is not in it: it moves all curves together, as parameters do, and is kept in `curve_scatter` and in
    the standard errors of the characteristics. InputError also for cars that went through different tests.
    """
    if len(manifest_paths) == 1:
        return reduce_measurement(manifest_paths[0], windows=windows, half_track=half_track)
    check_windows(windows or {})
    tested = [_tested(path) for path in manifest_paths]
    refuse_unlike(tested)
    runs = _on_common_grids(tested)
    noises = estimate_common_noise(runs, sensor_resolution(tested[0].manifest))
    cars = tuple(
        assembled(car.manifest, measured_curves(car.manifest, own, half_track), own, noise, windows or {})
        for car, own, noise in zip(tested, runs, noises, strict=True)
    )
    return _mean(cars, windows or {})


def _tested(manifest_path: Path) -> TestedCar:
    path = manifest_path / "test.toml" if manifest_path.is_dir() else manifest_path
    manifest = load_manifest(path)
    runs = {case: reduce_case(case_records(path, manifest, case)) for case in measured_cases(manifest)}
    return TestedCar(path, manifest, runs)


def _on_common_grids(cars: Sequence[TestedCar]) -> list[dict[str, tuple[RunCurves, ...]]]:
    """The runs of each car at the inputs that all cars reach: all grids are parts of the load case's own."""
    out: list[dict[str, tuple[RunCurves, ...]]] = [{} for _ in cars]
    for case in cars[0].runs:
        grids = [car.runs[case][0].input for car in cars]
        low, high = max(g[0] for g in grids), min(g[-1] for g in grids)
        for own, car in zip(out, cars, strict=True):
            own[case] = tuple(_cut(run, low, high) for run in car.runs[case])
    return out


def _cut(run: RunCurves, low: float, high: float) -> RunCurves:
    kept = (run.input >= low - 1e-9 * abs(low)) & (run.input <= high + 1e-9 * abs(high))
    return replace(
        run,
        input=run.input[kept],
        unload={r: c[:, kept] for r, c in run.unload.items()},
        load={r: c[:, kept] for r, c in run.load.items()},
        gram=run.gram[np.ix_(kept, kept)],
    )


def _mean(cars: tuple[Measurement, ...], windows: Windows) -> Measurement:
    manifest = _common_manifest([car.manifest for car in cars])
    curves = _mean_curves(manifest.name, [car.curves for car in cars])
    runs = {case: tuple(run for car in cars for run in car.runs[case]) for case in curves.cases}
    noise = {
        case: {r: mean_noise([car.noise[case][r] for car in cars]) for r in cars[0].noise[case]}
        for case in curves.cases
    }
    mean = assembled(manifest, curves, runs, noise, windows)
    scatter = {case: _curve_scatter(case, cars, noise[case]) for case in curves.cases}
    mean = replace(mean, cars=cars, curve_scatter=scatter)
    errors = {f.entry.id: GradientEstimate(f.mean, f.mean_sd) for f in car_figures(mean)}
    return replace(mean, characteristics={**mean.characteristics, **errors})


def _curve_scatter(case: str, cars: Sequence[Measurement], noise: CaseNoise) -> Mapping[str, FloatArray]:
    """Response -> (2, n) standard deviation between cars beyond the noise of one."""
    out = {}
    for response in cars[0].curves.cases[case].mean:
        values = np.array([car.curves.cases[case].mean[response] for car in cars])
        own = [np.diag(noise[response].covariance(side=side)) * len(cars) for side in (0, 1)]
        out[response] = scatter_sd(values, np.array(own))
    return out


def _mean_curves(source: str, cars: Sequence[CurveSet]) -> CurveSet:
    first = cars[0]
    cases = {
        name: CaseCurves(
            load_case=name,
            input_unit=case.input_unit,
            input=case.input,
            mean={r: np.mean([c.cases[name].mean[r] for c in cars], axis=0) for r in case.mean},
            half_width={
                r: np.mean([c.cases[name].half_width[r] for c in cars], axis=0) for r in case.half_width
            },
        )
        for name, case in first.cases.items()
    }
    statics = [c.static for c in cars if c.static is not None]
    static = {r: np.mean([s[r] for s in statics], axis=0) for r in first.static} if first.static else None
    return CurveSet(source, cases, static, first.half_track)


def _common_manifest(manifests: Sequence[Manifest]) -> Manifest:
    """That of the first car with the name of all and the mean alignment."""
    names = [m.name for m in manifests]
    listed = f" ({', '.join(names)})" if len(names) <= NAMED_CARS and len(set(names)) == len(names) else ""
    alignments = [m.alignment for m in manifests if m.alignment is not None]
    alignment = _mean_alignment(alignments) if len(alignments) == len(manifests) else None
    return manifests[0].model_copy(
        update={"name": f"mean of {len(names)} cars{listed}", "alignment": alignment}
    )


def _mean_alignment(cars: Sequence[Alignment]) -> Alignment:
    def side(angles: Sequence[SideAlignment | None]) -> SideAlignment | None:
        known = [a for a in angles if a is not None]
        if not known:
            return None
        keys = [k for k in SideAlignment.model_fields if getattr(known[0], k) is not None]
        return SideAlignment(**{k: float(np.mean([getattr(a, k) for a in known])) for k in keys})

    sd = {
        k: float(np.sqrt(sum(getattr(a.sd, k) ** 2 for a in cars))) / len(cars)
        for k in AlignmentSd.model_fields
    }
    return Alignment(
        left=side([a.left for a in cars]), right=side([a.right for a in cars]), sd=AlignmentSd(**sd)
    )
