"""The sizes of an effect in a fit, where a nuisance says the same number added to it."""

from __future__ import annotations

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.thresholds import INPUT_GAIN
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray

SAME = "rig_input_gain"
"""The effect that is a calibration of the rig, only larger than a sound rig has."""


def amplitudes(fit: Fit, hypothesis: Hypothesis) -> tuple[FloatArray, FloatArray]:
    """(m,) amplitudes of a member and (m,) their standard deviations.

    The records show only the sum of a wrong input and of its load case's calibration: that is what counts.
    """
    model = fit.model
    place = next(p for h, p in model.places() if h == hypothesis)
    weights = np.eye(fit.z.size)[place]
    if hypothesis.effect == SAME and hypothesis.location in model.cases:
        (size,) = hypothesis.sizes
        calibration = model.calibrations.start + model.cases.index(hypothesis.location)
        weights[0, calibration] = np.log1p(INPUT_GAIN) / np.log(size.typical)
    covariance = weights @ fit.covariance @ weights.T
    return np.asarray(weights @ fit.z), np.asarray(np.sqrt(np.diag(covariance)))
