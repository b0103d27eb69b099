"""Which hypotheses of a screening are worth a joint refit: the best, its rivals, a decoy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.projection import Projection
from doe_kc.discovery.screen import Screened
from doe_kc.discovery.thresholds import ABSORBED_SHARE, LEADERS, OF_ONE_KIND, REFIT_SHARE, RELEVANT, RIVAL
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray

SEVERAL_PLACES = ("bushing_preload", "bushing_progression", "left_right_asymmetry")
"""Effects that a model may have in several places at once."""


def leaders(screened: Sequence[Screened], project: Projection, least: float) -> list[Screened]:
    """The best and its rivals, which would explain the same; a decoy of another kind is among them.

    Effects that explain something else are no rivals: they have their own step.
    """
    if not screened or screened[0].gain <= least:
        return []
    best = screened[0]
    out = [best]
    own = _explained(best, project)
    for s in screened[1:]:
        if s.gain <= max(least, REFIT_SHARE * best.gain) or len(out) == LEADERS:
            break
        kind = sum(o.hypothesis.effect == s.hypothesis.effect for o in out)
        if kind < OF_ONE_KIND and abs(float(own @ _explained(s, project))) > RIVAL:
            out.append(s)
    small = (
        best.amplitudes.size > 0 and float(np.abs(best.amplitudes[0])) < RELEVANT
    )  # a trace needs no decoy
    if not small and all(s.hypothesis.effect == best.hypothesis.effect for s in out):
        out += [s for s in screened if s.hypothesis.effect != best.hypothesis.effect and not s.failed][:1]
    return out


def overlooked(screened: Sequence[Screened], least: float) -> list[Screened]:
    """Those that a screening may have missed though a typical one would show by `least` of ln likelihood."""
    shows = float(np.sqrt(2.0 * least))
    return [s for s in screened if not s.failed and s.absorbed >= ABSORBED_SHARE and s.detectability >= shows]


def _explained(screened: Screened, project: Projection) -> FloatArray:
    """(M + d,) direction of what the effect does at its size, after re-tuning."""
    change = screened.columns @ screened.amplitudes if screened.amplitudes.size else screened.change
    seen = project(change)
    length = float(np.linalg.norm(seen))
    return np.asarray(seen / length if length > 0.0 else seen)


def compatible(model: EffectModel, hypothesis: Hypothesis) -> bool:
    """Whether the model can take the effect besides those it has."""
    for member in model.members:
        if member.effect == hypothesis.effect:
            if member.effect not in SEVERAL_PLACES:
                return False
            if _bushing(member) == _bushing(hypothesis):
                return False
    return True


def _bushing(hypothesis: Hypothesis) -> str:
    return (hypothesis.location or "").partition("_")[0]
