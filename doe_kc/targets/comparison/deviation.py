"""The deviation of two curves (thesis, equation 2.1)."""

from __future__ import annotations

import numpy as np

from doe_kc.ground.typing import FloatArray


def rms_deviation(curve: FloatArray, target: FloatArray) -> float:
    """sqrt(1/N sum (y_i - y'_i)^2), in the unit of y.

    curve, target: (n,) on the same inputs. The thesis prints the input's increment under the root too, which
    gives the result the unit of y times the root of the input's; here it is 1.
    """
    return float(np.sqrt(np.mean((curve - target) ** 2)))
