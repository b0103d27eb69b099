"""The deviation of two curves (thesis, equation 2.1)."""

from __future__ import annotations

import numpy as np

from doe_kc.typing import FloatArray


def rms_deviation(curve: FloatArray, target: FloatArray, increment: float = 1.0) -> float:
    """sqrt(1/N sum (y_i - y'_i)^2 dx), in the unit of y for the default increment dx = 1.

    curve, target: (n,) on the same inputs. The thesis prints the increment under the root, which gives
    the result the unit of y times the root of the input's; with dx = 1 it is the plain RMS.
    """
    return float(np.sqrt(np.mean((curve - target) ** 2) * increment))
