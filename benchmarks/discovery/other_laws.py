"""Effects by laws that the analyser's default does not have: rubber, frictions, compliances, progressions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.discovery.catalogue import (
    PROGRESSION,
    hub,
    rack_mount,
    steering_friction,
    strut_bending,
    strut_friction,
)
from benchmarks.discovery.chance import log_uniform, sign, spread
from benchmarks.discovery.hidden import Hidden
from benchmarks.discovery.laws import Shape, table
from doe_kc.axle import Axle
from doe_kc.axle.model import BUSHINGS

OtherLaw = Callable[[np.random.Generator, float, Axle], Hidden]
STRONG = (0.3, 0.5)
"""Share by which a compliance stiffens or softens under full load; the catalogue's do by 0.15 at most."""
TWO_STAGE = (0.35, 0.10, 0.03, 0.04, 0.03, 0.05, 0.40)
"""Shares of a friction of two stages: a seal that breaks away early, a bearing that does late."""
UNEQUAL = 0.3
"""Standard deviation of the logarithm of a bushing's share, and of its yield distance."""


def rubber(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """Sliders of another spread than the analyser's 0.8, no bushing like another."""
    names = [name.upper() for name in BUSHINGS]
    width = float(rng.uniform(0.3, 0.5) if rng.random() < 0.5 else rng.uniform(1.1, 1.4))
    middle = log_uniform(rng, 0.1, 0.4)
    options: dict[str, Any] = {
        "bushings": names,
        "share": {name: 0.2 * size * spread(rng, 1.0, UNEQUAL) for name in names},
        "yield_mm": {name: middle * spread(rng, 1.0, UNEQUAL) for name in names},
        "spread": width,
    }
    return Hidden("rubber_hysteresis", size, None, options, {"share": 0.2 * size}, approximate=True)


def two_stage_friction(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """Rack or strut, by a backbone of two stages."""
    drawn = (steering_friction if rng.random() < 0.5 else strut_friction)(rng, size, axle)
    return replace(drawn, options={**drawn.options, "law": "backbone", "shares": list(TWO_STAGE)})


def sharp_friction(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """Rack or strut, elastic up to one limit."""
    drawn = (steering_friction if rng.random() < 0.5 else strut_friction)(rng, size, axle)
    return replace(drawn, options={**drawn.options, "law": "lognormal", "spread": 0.05})


def bent_compliance(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """Hub or strut whose stiffness changes by a third to a half up to full load, either way."""
    drawn = (hub if rng.random() < 0.5 else strut_bending)(rng, size, axle)
    return replace(drawn, stiffening=sign(rng) * float(rng.uniform(*STRONG)), approximate=True)


def _progression(shape: Shape) -> OtherLaw:
    def draw(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
        free = float(rng.uniform(0.1, 0.6))
        tables, parameters = {}, {}
        for i, of in enumerate(("Fx", "Fy", "Fz")):
            added = PROGRESSION["LLR"] * size * spread(rng, 1.0, 0.3)
            k, cubic = (axle.values[f"llr.{what}.{of}@L"] for what in ("stiffness", "cubic"))
            tables["llr", of] = table(k, cubic, added, shape, free)
            parameters[f"LLR[{i}]"] = added
        options = {"shape": shape, "free_mm": free}
        return Hidden(
            "bushing_progression", size, "LLR", options, parameters, tables=tables, approximate=True
        )

    return draw


STEERING_LAWS: tuple[dict[str, Any], ...] = (
    {"law": "iwan"},
    {"law": "lognormal", "spread": 1.0},
    {"law": "lognormal", "spread": 0.4},
    {"law": "backbone", "shares": list(TWO_STAGE)},
)
"""Laws of a steering friction on a mount that yields: none is the analyser's default one, the last none of
its closed ones."""


def friction_on_mount(
    law: int, sizes: tuple[float, float], rng: np.random.Generator, axle: Axle
) -> tuple[Hidden, Hidden]:
    """A steering friction by one of `STEERING_LAWS`, and a mount of the rack that yields: by some laws they
    make nearly the loops of a smaller friction on a rigid one."""
    friction = steering_friction(rng, log_uniform(rng, *sizes), axle)
    friction = replace(friction, options={**friction.options, **STEERING_LAWS[law]})
    return friction, rack_mount(rng, log_uniform(rng, *sizes), axle)


OTHER_LAWS: dict[str, OtherLaw] = {
    "two-stage friction": two_stage_friction,
    "sharp friction": sharp_friction,
    "bent compliance": bent_compliance,
    "exponential progression": _progression("exponential"),
    "soft stop": _progression("soft_stop"),
}
