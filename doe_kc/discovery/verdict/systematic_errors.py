"""How large one rig's systematic errors are, estimated from the records of one car.

Repeats do not show what a sensor's calibration leaves open, nor how far the rig's own friction and backlash
open a loop: sets of effects are searched for and compared with what such errors may be. What the last set
leaves of a hundred curves shows what they are: their scales are those of the largest evidence, and sizes of
effects are estimated with them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from doe_kc.correlation.curve_data import CurveData, SystematicError
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, rewhitened_fit
from doe_kc.discovery.search.law_discrepancy import marginal
from doe_kc.ground.in_turn import in_turn

SYSTEMATIC_ERRORS: tuple[SystematicError, ...] = ("hysteresis", "calibration")
"""The one that shows most first."""
SCALES = (2.0, 1.0, 0.5, 0.35, 0.25, 0.18, 0.13, 0.09, 0.06, 0.03)
"""Of such an error, over what is assumed of it, falling. The evidence has one maximum along them."""


def systematic_scales(fit: Fit) -> dict[SystematicError, float]:
    """Kind of systematic error -> its scale with the largest evidence, over what the fit's errors hold."""
    scales: dict[SystematicError, float] = dict.fromkeys(SYSTEMATIC_ERRORS, 1.0)

    def evidence(scales: Mapping[SystematicError, float]) -> float:
        errors = with_systematic_errors(fit.model.likelihood, scales)
        return marginal(rewhitened_fit(fit, errors))

    most = evidence(scales)
    for kind in SYSTEMATIC_ERRORS:
        assumed = SCALES.index(1.0)
        for way in (SCALES[assumed + 1 :], SCALES[:assumed][::-1]):
            candidates = [{**scales, kind: scale} for scale in way]
            for scale, candidate in zip(
                way, in_turn(evidence, candidates, fit.model.solutions.pool), strict=False
            ):
                if candidate <= most:
                    break
                most, scales[kind] = candidate, scale
            if scales[kind] != 1.0:
                break
    return scales


def with_systematic_errors(likelihood: Likelihood, scales: Mapping[SystematicError, float]) -> Likelihood:
    """The same records, each kind of systematic error at a scale of what their errors hold of it."""
    return replace(likelihood, curves=tuple(_scaled(c, scales) for c in likelihood.curves))


def _scaled(curve: CurveData, scales: Mapping[SystematicError, float]) -> CurveData:
    covariance = curve.root @ curve.root.T
    systematic = {kind: scales.get(kind, 1.0) * error for kind, error in curve.systematic.items()}
    for kind, error in curve.systematic.items():
        covariance += np.outer(systematic[kind], systematic[kind]) - np.outer(error, error)
    return replace(curve, root=np.asarray(np.linalg.cholesky(covariance)), systematic=systematic)
