"""Optional physical effects, one module each; `EFFECTS` maps id to effect."""

from __future__ import annotations

import sys

from doe_kc.effects._base import (
    EFFECTS,
    Effect,
    Option,
    apply_effect,
    effect,
    effect_id,
    observed,
    refuse_on_rig,
)
from doe_kc.ground.registry import import_members

import_members(sys.modules[__name__])

__all__ = ["EFFECTS", "Effect", "Option", "apply_effect", "effect", "effect_id", "observed", "refuse_on_rig"]
