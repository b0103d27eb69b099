"""The records of the mean car, which are not quite the mean of the cars' records.

Where a curve bends, as where a stop touches, the mean of cars that touch at different travels is rounder than
the curve of any car. The difference is what a model of each car says of it: with the parameters z_i that fit
each car's records, f((z_1 + ... + z_n) / n) less the mean of f(z_i), to be added to the mean of the records.
It is of second order in the scatter, and of what the model lacks it takes a share of second order only.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.discovery.fit import fit
from doe_kc.discovery.model import EffectModel
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement


def mean_car_records(model: EffectModel, measurement: Measurement) -> Measurement:
    """The measurement with the mean and half-width curves of the mean car.

    model: without effects, of the measured axle. NotConverged when the nominal axle has no equilibrium.
    """
    fitted = [
        fit(replace(model, likelihood=record_likelihood(model.axle, car)), model.centre).z
        for car in measurement.cars
    ]
    of_each = [model.curves(z) for z in fitted]
    of_mean = model.curves(np.asarray(np.mean(fitted, axis=0)))
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
