"""Analysers that know the key, nothing, or luck: they test the scoring."""

from __future__ import annotations

import random
from typing import Any

from benchmarks.discovery.catalogue import REFERENCE
from benchmarks.discovery.truth import DELETED, Truth

BLANK: dict[str, Any] = {"effects": [], "classes": [], "unexplained_at": [], "gap": {}, "held_out": {}}


def perfect(truth: Truth) -> dict[str, Any]:
    """Names what is hidden with its exact numbers, and says where the rest is."""
    if truth.outside or truth.suite == DELETED:
        places = [{"load_case": c, "response": r, "shape": "bend", "z": 9.0} for c, r in sorted(truth.shows)]
        return {**BLANK, "verdict": "unexplained", "unexplained_at": places, "seconds": 1.0}
    effects = [
        {
            "id": e.id,
            "location": e.location or None,
            "probability": 0.999,
            "parameters": {n: {"value": v, "sd": abs(v) / 20, "unit": ""} for n, v in e.parameters.items()},
        }
        for e in truth.effects
    ]
    return {
        **BLANK,
        "verdict": "named" if effects else "none",
        "effects": effects,
        "gap": {"nominal": 9.0, "tuned": 3.0, "with_effect": 1.0, "noise_floor": 1.0, "best_decoy": 2.0},
        "held_out": {"steer": {"tuned": 3.0, "with_effect": 1.0}} if effects else {},
        "seconds": 1.0,
    }


def always_none(truth: Truth) -> dict[str, Any]:
    """Finds nothing missing, ever."""
    return {**BLANK, "verdict": "none", "seconds": 1.0}


def lucky(truth: Truth, seed: int = 0) -> dict[str, Any]:
    """Names any effect, and is sure of it."""
    ident = random.Random(f"{seed} {truth.name}").choice(REFERENCE)
    effect: dict[str, Any] = {"id": ident, "location": None, "probability": 0.95, "parameters": {}}
    return {**BLANK, "verdict": "named", "effects": [effect], "seconds": 1.0}
