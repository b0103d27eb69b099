"""K&C rig records: read, checked, reduced to curves, noise, trends, gradients and characteristics."""

from __future__ import annotations

from doe_kc.measurement.car_scatter import CarFigures, car_figures
from doe_kc.measurement.cars import reduce_cars
from doe_kc.measurement.gradients import Gradient, GradientEstimate
from doe_kc.measurement.manifest import Manifest, load_manifest
from doe_kc.measurement.noise import CaseNoise, ErrorComponents, NoiseModel
from doe_kc.measurement.records import RigRecord, read_record
from doe_kc.measurement.reduction import HALF_TRACK, Measurement, reduce_measurement
from doe_kc.measurement.ride_height import Contribution, RideHeight, infer_ride_height
from doe_kc.measurement.trend import PolynomialTrend, fit_trends

__all__ = [
    "HALF_TRACK",
    "CarFigures",
    "CaseNoise",
    "Contribution",
    "ErrorComponents",
    "Gradient",
    "GradientEstimate",
    "Manifest",
    "Measurement",
    "NoiseModel",
    "PolynomialTrend",
    "RideHeight",
    "RigRecord",
    "car_figures",
    "fit_trends",
    "infer_ride_height",
    "load_manifest",
    "read_record",
    "reduce_cars",
    "reduce_measurement",
]
