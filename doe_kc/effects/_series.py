"""A dry friction beside a spring, both on a compliance in series with them.

On a rigid mount a friction f R beside a spring k makes the force k y + f R. On a compliance of the stiffness
k r / (r - 1), both r times as large, it makes the same force at the same y if it has the same share f of its
limit at the distance x = (y - (r - 1) f R / k) / r: the compliance takes the rest of the motion y. So the
loops are exactly alike, and a rig that sees y tells them apart only by what else is known of the spring and
of the law.
"""

from __future__ import annotations

import math

import numpy as np

from doe_kc.effects._backbone import VirginCurve

SHORTEST = 1e-3
"""-, distance on the compliance over that on the rigid mount, where the compliance would take more than
all."""
YIELDED = 1.0 - math.exp(-1.0)
"""-, share of the limit at the yield displacement of an exponential virgin curve."""


def on_compliance(curve: VirginCurve, spring_distance: float, ratio: float) -> VirginCurve:
    """The virgin curve of the friction on a compliance that makes the loops of another one without it.

    curve: of the other one. spring_distance: R / k, in the unit of its distances. ratio: r > 0; below 1 the
    compliance is taken away. Exact where the compliance does not take more than all of a motion.
    """
    left = (curve.distances - (ratio - 1.0) * spring_distance * curve.shares) / ratio
    distances = np.maximum.accumulate(np.maximum(left, SHORTEST * curve.distances))
    shortened = VirginCurve(distances, curve.shares, 1.0)
    return VirginCurve(distances, curve.shares, shortened.distance(YIELDED))
