"""Targets: what a model shall reach, how much each deviation weighs, how well a design does."""

from __future__ import annotations

from doe_kc.targets.build import build_targets
from doe_kc.targets.improvement import (
    Improvement,
    exact_model_improvement,
    improvements,
    mean_improvement,
)
from doe_kc.targets.options import CharacteristicOptions, CurveOptions
from doe_kc.targets.rating import LIMIT_WEIGHT, Rating, Score, rate, score
from doe_kc.targets.target import Constraint, CurveTarget, MisfitTerm, Objective, Target, Targets

__all__ = [
    "LIMIT_WEIGHT",
    "CharacteristicOptions",
    "Constraint",
    "CurveOptions",
    "CurveTarget",
    "Improvement",
    "MisfitTerm",
    "Objective",
    "Rating",
    "Score",
    "Target",
    "Targets",
    "build_targets",
    "exact_model_improvement",
    "improvements",
    "mean_improvement",
    "rate",
    "score",
]
