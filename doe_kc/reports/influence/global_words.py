"""What global sensitivities say, in sentences: their leads, the legend of their indices, what follows."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from doe_kc.ground.numbers import number
from doe_kc.parameter_influence.global_sensitivity import GlobalSensitivity

GLOBAL_LEAD = (
    "How the variables act over their whole ranges in [variables], by the true solver, beside what the "
    "slopes of the unchanged axle say. Where slopes miss something, "
    "the model is not linear."
)
METHODS_LEAD = (
    "Largest half width of the 95 % confidence interval of a method's main index over the variables, with a "
    "quarter, half and all of its samples, and the largest change that the second half made."
)
GLOBAL_LEGEND: Mapping[str, str] = {
    "Global: by slope": "Effect: exact slope at the start times the variable's range. Share: of the "
    "variance that all slopes together give over the ranges.",
    "Global: Morris": "Mean and standard deviation of the change per whole range, over trajectories through "
    "the box; a standard deviation near the mean says that the effect depends on where the others are.",
    "Global: Sobol": "Share of the variance over the ranges alone, and in total with interactions; "
    "Saltelli's sample.",
    "Global: PAWN": "How far the distribution of the characteristic moves when the variable is held in a "
    "tenth of its range: median Kolmogorov-Smirnov distance; by chance it stays below 'shift by chance'.",
    "Global: beyond the slope": "What the method sees once the slopes' plane is taken off; 0 of a plane.",
    "Global: ±": "Half width of the 95 % confidence interval, by bootstrap.",
}
MOST_SENTENCES = 6


def global_sentences(result: GlobalSensitivity) -> list[str]:
    """What was run, how sure it is, and where slopes mislead, the largest first."""
    out = []
    for m in result.methods:
        failed = (
            f", {m.failed} of {m.blocks + m.failed} samples left out for want of equilibrium"
            if m.failed
            else ""
        )
        out.append(
            f"{m.label}: {m.designs} designs{failed}; largest error of its {m.index(m.main).label} "
            f"{number(float(np.median(m.errors[-1])), 2)} in the middle of the characteristics, changed by "
            f"{number(float(np.median(m.changes)), 2)} in the second half."
        )
    known = [
        (float(v), c.id)
        for v, c in zip(result.explained, result.characteristics, strict=True)
        if math.isfinite(v)
    ]
    if known:
        least = ", ".join(f"{name} {100.0 * v:.0f} %" for v, name in sorted(known)[:3])
        out.append(f"Of the variance over the ranges slopes explain least of {least}.")
    differences = result.disagreements()
    if not differences:
        return [*out, "Slopes of the unchanged axle and global methods agree: linear over the ranges."]
    more = (
        f"; {len(differences) - MOST_SENTENCES} more in the workbook"
        if len(differences) > MOST_SENTENCES
        else ""
    )
    out.append(f"Not linear over the ranges in {len(differences)} entries{more}:")
    return out + [d.sentence for d in differences[:MOST_SENTENCES]]
