"""How to read the correlation workbook."""

from __future__ import annotations

CORRELATION_LEGEND = {
    "Frame": "Chassis: X rearwards, Y to the right, Z up, ground z = 0. Characteristics: left wheel.",
    "Signs": "Toe-in +, camber top outwards +, caster top rearwards +; forces as their load case has them.",
    "Paths": "LLF.x is a hardpoint coordinate in mm, llr.Fx a stiffness factor (nominal 1). Both sides "
    "change alike.",
    "Rating": "Equation 2.2: 0 = every target met exactly, the more negative the worse. Violated constraints "
    "weigh by QuadWt 10000 unless the study says otherwise.",
    "Interval": "target ± 0.15 sqrt(target² + 0.005) (equations 5.1 and 5.2) unless the study gives low and "
    "high. Where the role has no constraint it is for information only.",
    "Improvement": "100 % = target met, 0 % = as far off as the baseline, negative = worse. It enters the "
    "mean where the characteristic is an objective or constraint and its baseline is more than three "
    "standard deviations of the target away.",
    "Distance": "(value - target) / sd of the target; empty for a target without error.",
    "Normalised": "1 + sign(target) (value - target) / sqrt(target² + 0.005): value / target away from zero.",
    "sd of a parameter": "Standard deviation from the exact sensitivities at the final design, all variables "
    "free together, prior from the bounds.",
    "Not visible": "The measurement does not halve what was known before it; the final value says nothing "
    "about the car.",
    "Curves": "RMS deviation from the measured mean curve of both wheels; noise is the RMS error of that "
    "curve: an RMS near it is a perfect fit.",
    "Rating terms": "Yellow cells can be edited; sums and the live rating of the summary follow.",
}
