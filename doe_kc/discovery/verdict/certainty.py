"""Which effects are certain although something else remains: a partial answer.

What is not in the library can take the name of an effect that makes the same deviations, but not where those
are explained to the last and are many times larger than all that remains.
"""

from __future__ import annotations

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import Finding
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.thresholds import (
    CERTAIN,
    CERTAIN_SHARE,
    CONFIDENT,
    NAME_ALWAYS_LEVEL,
    OWN_CONTRASTS,
    WRONG_NAMES,
)
from doe_kc.discovery.verdict.adequacy import Adequacy
from doe_kc.discovery.verdict.alternatives import Alternatives
from doe_kc.discovery.verdict.verdict import ambiguous
from doe_kc.effects import EFFECTS


def certain(finding: Finding, own: Alternatives, final: Fit) -> bool:
    """Whether an effect that is no trace is named whatever else is missing. final: fit of the last set.

    No gain or offset of the rig is: it can stand for anything that is missing, as its traces can. Without a
    tyre compliance in the library the lateral force in opposition was 4.9 % too large for certain, in a rig
    that was right.
    """
    hypothesis = finding.hypothesis
    if ambiguous(finding) or not finding.believed or (EFFECTS[hypothesis.effect].on_rig and hypothesis.sizes):
        return False
    strong = finding.log10_odds >= CERTAIN and 2.0 * own.loss >= NAME_ALWAYS_LEVEL**2
    return strong and remaining_share(own, final) <= CERTAIN_SHARE and explained(own, final.residual_map)


def remaining_share(own: Alternatives, final: Fit) -> float:
    """What noise does not explain of the last fit, over what the effect explains, in squares."""
    size = float(final.residual.size)
    excess = final.misfit - size - CONFIDENT * float(np.sqrt(2.0 * size))
    return max(0.0, excess) / max(2.0 * own.loss, 1.0)


def name_doubt(own: Alternatives, final: Fit, adequacy: Adequacy | None) -> float:
    """Odds that something outside the library is at work in a named effect's place.

    How often a name was wrong in the benchmark, more where noise hardly explains what remains (`adequacy`;
    None where that is at work beside the effect), and what remains over what the effect explains.
    """
    support = 1.0 if adequacy is None else adequacy.support
    return WRONG_NAMES / support + remaining_share(own, final)


def explained(own: Alternatives, remaining: Map) -> bool:
    """Whether noise explains what remains of the contrasts in which the effect shows most."""
    signal, left = own.change.contrasts, np.abs(np.nan_to_num(remaining.z))
    asked = signal >= OWN_CONTRASTS * signal.max()
    return bool((left[asked] <= remaining.threshold).all())
