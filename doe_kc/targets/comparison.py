"""Model against measurement: characteristics with constraint intervals, curves with RMS deviations."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_all
from doe_kc.curves import RIG_RESPONSES, SIDES, CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import CarFigures, Measurement, car_figures

INTERVAL_SHARE = 0.15
"""Of the target: the half width of its constraint interval (equation 5.1 of the thesis)."""
FLOOR = 0.005
"""Added to the target's square, so that the interval of a target near 0 has a width (equation 5.2)."""


def constraint_interval(target: float) -> tuple[float, float]:
    """(low, high) = target -+ 0.15 sqrt(target^2 + 0.005), in the target's unit.

    Widens the relative interval of targets close to zero.
    """
    half = INTERVAL_SHARE * math.sqrt(target**2 + FLOOR)
    return target - half, target + half


def rms_deviation(curve: FloatArray, target: FloatArray) -> float:
    """sqrt(1/N sum (y_i - y'_i)^2), in the unit of y.

    curve, target: (n,) on the same inputs. The thesis prints the input's increment under the root too, which
    gives the result the unit of y times the root of the input's; here it is 1.
    """
    return float(np.sqrt(np.mean((curve - target) ** 2)))


@dataclass(frozen=True)
class CharacteristicComparison:
    """One characteristic of the left wheel, in `entry.unit`; target_sd: nan when it is not known."""

    entry: Characteristic
    value: float
    target: float
    target_sd: float
    low: float
    high: float

    @property
    def difference(self) -> float:
        """Model minus target."""
        return self.value - self.target

    @property
    def inside(self) -> bool:
        """Whether the model lies in the constraint interval."""
        return self.low <= self.value <= self.high


@dataclass(frozen=True)
class CurveComparison:
    """RMS deviation of one mean curve and one half-width curve, in the response's unit."""

    load_case: str
    response: str
    side: str
    rms: float
    rms_half_width: float
    span: float
    """Range of the measured curve, to judge the RMS by."""


@dataclass(frozen=True)
class CarComparison:
    """One characteristic of the model beside several measured cars; value: the model's, in `entry.unit`."""

    figures: CarFigures
    value: float

    @property
    def entry(self) -> Characteristic:
        """Which one."""
        return self.figures.entry

    @property
    def difference(self) -> float:
        """Model minus mean of the cars."""
        return self.value - self.figures.mean

    @property
    def standard_errors(self) -> float:
        """The difference in standard errors of the mean."""
        return self.figures.standard_errors(self.value)

    @property
    def chance(self) -> float:
        """See `CarFigures.chance`."""
        return self.figures.chance(self.value)


def compare_cars(measurement: Measurement, model: Mapping[str, float]) -> tuple[CarComparison, ...]:
    """Every characteristic that all cars show; none of a single car. model: id -> value."""
    return tuple(CarComparison(f, model.get(f.entry.id, math.nan)) for f in car_figures(measurement))


@dataclass(frozen=True)
class Comparison:
    """Model and measurement; static angles are compared only where the measurement has them.

    curve_sd: load case -> response -> (2, n) standard deviations of the measured mean curves, where known.
    cars: the model beside the single cars, where several were measured.
    """

    model: CurveSet
    measured: CurveSet
    characteristics: tuple[CharacteristicComparison, ...]
    curves: tuple[CurveComparison, ...]
    curve_sd: Mapping[str, Mapping[str, FloatArray]] = field(default_factory=dict)
    cars: tuple[CarComparison, ...] = ()


def compare(
    model: CurveSet,
    measured: CurveSet,
    *,
    target_sd: Mapping[str, float] | None = None,
    windows: Mapping[str, float] | None = None,
    curve_sd: Mapping[str, Mapping[str, FloatArray]] | None = None,
) -> Comparison:
    """Every characteristic that the measurement has, and every curve that both have.

    target_sd: characteristic id -> standard deviation of its target. windows: as in `reduce_all`.
    curve_sd: see `Comparison`.
    """
    ours, targets = reduce_all(model, windows), reduce_all(measured, windows)
    spread = target_sd or {}
    rows = [
        CharacteristicComparison(
            entry, ours[i], targets[i], spread.get(i, math.nan), *constraint_interval(targets[i])
        )
        for i, entry in CHARACTERISTICS.items()
        if math.isfinite(targets[i])
    ]
    curves = [
        _curve(model.cases[case], measured.cases[case], response, side)
        for case in measured.cases
        if case in model.cases and same_input(model.cases[case], measured.cases[case])
        for response in RIG_RESPONSES
        if response in measured.cases[case].mean
        for side in range(2)
    ]
    return Comparison(model, measured, tuple(rows), tuple(curves), dict(curve_sd or {}))


def same_input(model: CaseCurves, measured: CaseCurves) -> bool:
    """False when the two rolled by different techniques: mm of pad travel against deg of body roll."""
    return model.input_unit == measured.input_unit


def resample(case: CaseCurves, curve: FloatArray, inputs: FloatArray) -> FloatArray:
    """(n,) curve at other inputs, linear between the solved points."""
    return np.interp(inputs, case.input, curve)


def _curve(model: CaseCurves, measured: CaseCurves, response: str, side: int) -> CurveComparison:
    inside = (measured.input >= model.input[0]) & (measured.input <= model.input[-1])
    at = measured.input[inside]
    means = resample(model, model.mean[response][side], at), measured.mean[response][side][inside]
    halves = (
        resample(model, model.half_width[response][side], at),
        measured.half_width[response][side][inside],
    )
    return CurveComparison(
        measured.load_case,
        response,
        SIDES[side],
        rms_deviation(*means),
        rms_deviation(*halves),
        float(np.ptp(means[1])),
    )
