"""Which effects are certain although something else remains: a partial answer.

What is not in the library can take the name of an effect that makes the same deviations, but not where those
are explained to the last and are many times larger than all that remains.
"""

from __future__ import annotations

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import Finding
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.thresholds import CERTAIN, CERTAIN_SHARE, NAME_ALWAYS_LEVEL, OWN_CONTRASTS
from doe_kc.discovery.verdict.alternatives import Alternatives
from doe_kc.discovery.verdict.verdict import ambiguous


def certain(finding: Finding, own: Alternatives, final: Fit) -> bool:
    """Whether an effect is named whatever else is missing. final: the fit of the last set."""
    if ambiguous(finding) or not (finding.relevant and finding.believed):
        return False
    strong = finding.log10_odds >= CERTAIN and 2.0 * own.loss >= NAME_ALWAYS_LEVEL**2
    return strong and remaining_share(own, final) <= CERTAIN_SHARE and explained(own.map, final.residual_map)


def remaining_share(own: Alternatives, final: Fit) -> float:
    """What noise does not explain of the last fit, over what the effect explains, in squares."""
    excess = final.misfit - float(final.residual.size)
    return max(0.0, excess) / max(2.0 * own.loss, 1.0)


def explained(without: Map, remaining: Map) -> bool:
    """Whether noise explains what remains of the contrasts that disagree most without the effect."""
    missed, left = np.abs(np.nan_to_num(without.z)), np.abs(np.nan_to_num(remaining.z))
    asked = missed >= OWN_CONTRASTS * missed.max()
    return bool((left[asked] <= remaining.threshold).all())
