"""What rubber's friction makes of the stiffness that a bench measures at one amplitude."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.axle.sliders import yield_ratios


@dataclass(frozen=True)
class DynamicStiffness:
    """ratio: secant stiffness, peak force over peak travel, over the elastic stiffness at zero; >= 1.
    loss_angle: deg, its sine the work of a loop over pi times peak force times peak travel."""

    ratio: float
    loss_angle: float


def dynamic_stiffness(
    share: float, yield_mm: float, spread: float, amplitude: float, *, elastic: float = 1.0
) -> DynamicStiffness:
    """Of a steady loop of +-amplitude, mm, > 0, of one axis. elastic: secant stiffness of the elastic law
    there over that at zero.

    Slider j takes 4 k y (a - y) a loop beyond its yield distance y, nothing before.
    """
    yields = yield_mm * yield_ratios(spread)
    strength = share * yield_mm / yields.size
    ratio = elastic + float(np.sum(strength * np.minimum(1.0, amplitude / yields))) / amplitude
    work = 4.0 * strength * float(np.sum(np.maximum(amplitude - yields, 0.0)))
    return DynamicStiffness(ratio, float(np.degrees(np.arcsin(work / (np.pi * ratio * amplitude**2)))))
