"""The shape of laws: granted where an effect works, nowhere else, and not as a scale."""

from __future__ import annotations

import numpy as np

from doe_kc.discovery.granted import granted
from tests.discovery.cases import library, model


def test_only_what_the_effect_changes_is_widened() -> None:
    (friction,) = library("steering_friction")
    car = model("friction").extended(friction)
    z = car.centre.copy()
    z[-2] = 0.8
    wide = granted(car, car.likelihood, z)
    before = {(c.load_case, c.response, c.side, c.branches): c for c in car.likelihood.curves}
    for curve in wide.likelihood.curves:
        was = before[curve.load_case, curve.response, curve.side, curve.branches]
        grown = np.trace(curve.root @ curve.root.T) / np.trace(was.root @ was.root.T)
        if (curve.load_case, curve.response, curve.branches) == ("steer", "toe", "half_width"):
            assert grown > 2.0
        if curve.load_case == "lateral_opposite" and curve.response == "tyre_load":
            assert grown < 1.05


def test_a_change_of_scale_is_no_shape() -> None:
    (hub,) = library("hub_compliance")
    car = model("named").extended(hub)
    z = car.centre.copy()
    z[-2:] = 1.0
    without = model("named").residual(z[:-2])
    made = car.residual(z) - without
    wide = granted(car, car.likelihood, z).likelihood
    for (curve, place), now in zip(car.likelihood.slices(), wide.curves, strict=True):
        if (curve.load_case, curve.response, curve.branches) == ("lateral", "camber", "mean"):
            change = curve.root @ made[place]
            before = np.linalg.norm(curve.whitened(change))
            bent = np.linalg.norm(now.whitened(change * np.cos(3.0 * curve.input / curve.input.max())))
            assert np.linalg.norm(now.whitened(change)) > 0.5 * before
            assert bent < 0.5 * np.linalg.norm(
                curve.whitened(change * np.cos(3.0 * curve.input / curve.input.max()))
            )
