"""What effects too small to be seen do to the sizes of those that are found.

Every car has a little of everything. A trace that no screening brings in is fitted by what looks like it, so
that a size is off by more than noise says.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from doe_kc.discovery.search import EffectSearch
from doe_kc.discovery.thresholds import PRESENT, TRACE_LEVEL
from doe_kc.effects import EFFECTS
from doe_kc.ground.typing import FloatArray


def unseen(search: EffectSearch) -> FloatArray:
    """(m,) standard deviation of the final model's amplitudes by all effects that are not in it.

    To first order: each at PRESENT of its typical size, less where more would have been seen, independently.
    """
    final = search.final
    members = {h.name for h in final.model.members}
    others = [
        s
        for s in search.steps[-1].screened
        if not s.failed and s.hypothesis.name not in members and not EFFECTS[s.hypothesis.effect].on_rig
    ]
    if not others:
        return np.zeros(final.amplitudes.size)
    sizes = np.array([min(PRESENT, TRACE_LEVEL / max(s.detectability, 1e-9)) for s in others])
    changes = np.array([s.change for s in others]).T * sizes
    moves = cho_solve(cho_factor(final.hessian), final.jacobian.T @ changes)
    return np.asarray(np.linalg.norm(moves[final.model.dimension :], axis=1))
