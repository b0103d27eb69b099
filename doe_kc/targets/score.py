"""What a design reaches of its targets: values of the characteristics and RMS deviations of the curves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.curves import CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.targets.comparison.deviation import rms_deviation
from doe_kc.targets.target import Targets, sampled


@dataclass(frozen=True)
class Score:
    """values: (k,) characteristics in the order of the targets. rms: (c,) in each response's unit.

    misfit: mean square of the residuals against the records, 1 is noise; 0 where it does not count.
    """

    values: FloatArray
    rms: FloatArray
    misfit: float = 0.0


def score(targets: Targets, characteristics: FloatArray, curves: CurveSet | None) -> Score:
    """Score of one design; characteristics: all registered ones, in their order.

    ValueError when a curve target meets a model without curves.
    """
    if targets.curves and curves is None:
        raise ValueError("the model gives no curves, so curve targets cannot be judged")
    rms = [rms_deviation(sampled(t, curves), t.curve) for t in targets.curves] if curves else []
    return Score(np.asarray(characteristics)[targets.rows], np.array(rms))
