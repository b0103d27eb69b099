"""The records of the mean car, which are not quite the mean of the cars' records.

Where a curve bends, as where a stop touches, the mean of cars that touch at different travels is rounder than
the curve of any car. The difference is what a model of each car says of it: with the parameters z_i that fit
each car's records, f((z_1 + ... + z_n) / n) less the mean of f(z_i), to be added to the mean of the records.

What the model lacks may bend too, as free play that is taken up at another force in every car. That is seen
by what the re-tuned models leave of one car and not of another, and counts as an error of the mean there: the
expected rounding is about as large as its scatter from car to car, and more cars do not take it away.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood, record_likelihood
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.baseline import tune
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement

ROUNDING_WINDOW = 5
"""Neighbouring data of a curve whose scatter between the cars is judged together."""
ROUNDING_LEVEL = 3.0
"""Standard deviations of a mean square of noise, from which it is more than noise."""


def mean_car_likelihood(model: EffectModel, measurement: Measurement) -> Likelihood:
    """The records of the mean car as data with their errors.

    model: without effects, of the measured axle. NotConverged when the nominal axle has no equilibrium.
    """
    fitted = [tune(replace(model, likelihood=record_likelihood(model.axle, car))) for car in measurement.cars]
    records = mean_car_records(model, measurement, [f.z for f in fitted])
    left = np.array([f.residual for f in fitted])
    return with_rounding(record_likelihood(model.axle, records), left)


def with_rounding(likelihood: Likelihood, left: FloatArray) -> Likelihood:
    """The data with the error of a mean whose cars differ by what parameters do not explain.

    left: (n, M) what the re-tuned model leaves of each car, in standard deviations of its records.
    """
    cars = len(left)
    apart = np.sum((left - left.mean(axis=0)) ** 2, axis=0) / (cars - 1)
    curves = []
    for curve, place in likelihood.slices():
        window = min(ROUNDING_WINDOW, curve.size)
        mean_square = np.convolve(apart[place], np.ones(window), "same")
        mean_square /= np.convolve(np.ones(curve.size), np.ones(window), "same")
        noise = ROUNDING_LEVEL * np.sqrt(2.0 / (window * (cars - 1)))
        excess = np.where(mean_square > 1.0 + noise, mean_square - 1.0, 0.0)
        # by whitened data: L (1 + n e) L' of the mean's noise L L', which is 1 / n of a car's
        curves.append(replace(curve, root=curve.root * np.sqrt(1.0 + cars * excess)))
    return replace(likelihood, curves=tuple(curves))


def mean_car_records(
    model: EffectModel, measurement: Measurement, points: Sequence[FloatArray]
) -> Measurement:
    """The measurement with the mean and half-width curves of the mean car.

    points: of each car, (d,) or longer, as fitted. NotConverged where one has no equilibrium.
    """
    of_each = [model.curves(z) for z in points]
    of_mean = model.curves(np.asarray(np.mean(points, axis=0)))
    cases = {
        name: _moved(case, of_mean, of_each) if name in of_mean.cases else case
        for name, case in measurement.curves.cases.items()
    }
    return replace(measurement, curves=replace(measurement.curves, cases=cases))


def _moved(case: CaseCurves, of_mean: CurveSet, of_each: Sequence[CurveSet]) -> CaseCurves:
    name = case.load_case
    at = of_mean.cases[name].input

    def moved(
        records: Mapping[str, FloatArray],
        mean: Mapping[str, FloatArray],
        each: Sequence[Mapping[str, FloatArray]],
    ) -> dict[str, FloatArray]:
        out = {}
        for response, rows in records.items():
            differences = mean[response] - np.mean([own[response] for own in each], axis=0)
            out[response] = rows + np.array([np.interp(case.input, at, d) for d in differences])
        return out

    return replace(
        case,
        mean=moved(case.mean, of_mean.cases[name].mean, [c.cases[name].mean for c in of_each]),
        half_width=moved(
            case.half_width, of_mean.cases[name].half_width, [c.cases[name].half_width for c in of_each]
        ),
    )
