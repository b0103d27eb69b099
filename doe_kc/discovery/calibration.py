"""What the calibration of the rig's inputs leaves open: one common stretch of every load case's input."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.typing import FloatArray

INPUT_GAIN = 0.003
"""Standard deviation of an input's scale: load cells, travel and angle sensors of a rig are good to 0.3 %."""


def input_gains(likelihood: Likelihood) -> FloatArray:
    """(M, k) change of the whitened residual per standard deviation of each load case's input scale.

    All responses of a load case share it, which is why it is not among the errors of single curves: the
    record at the input u is in truth of u (1 + g), so that the curve moves by g u dy/du.
    """
    cases = list(dict.fromkeys(c.load_case for c in likelihood.curves))
    out = np.zeros((likelihood.size, len(cases)))
    for curve, place in likelihood.slices():
        stretched = INPUT_GAIN * curve.input * np.gradient(curve.value, curve.input)
        out[place, cases.index(curve.load_case)] = curve.whitened(stretched)
    return out
