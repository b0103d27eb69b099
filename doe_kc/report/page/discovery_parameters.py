"""Parameters that re-tuning had to bend, and where they go with the effect."""

from __future__ import annotations

import math
from typing import Any

from doe_kc.discovery.result import Discovery
from doe_kc.ground.numbers import with_sd
from doe_kc.report.discovery_gaps import MODEL_COLOURS
from doe_kc.report.discovery_parameters import arrow_colour
from doe_kc.report.discovery_tables import TunedParameter, tuned_parameters
from doe_kc.report.render.page import Section, render

BIAS_LEAD = (
    "Where an effect is missing, re-tuning bends parameters that have nothing to do with it. Circles: "
    "distance from nominal after re-tuning without an effect, in standard deviations of the prior; "
    "arrows lead to the place with the effect."
)
BIAS_REACH, BIAS_WIDTH = 2.5, 200.0
"""Distance at the ends of the drawing, and its width in units."""


def parameters_section(discovery: Discovery) -> Section:
    """One row a tunable parameter, sortable and filterable."""
    rows = sorted((_row(p) for p in tuned_parameters(discovery)), key=lambda r: -abs(r["p"].tuned_distance))
    has_effect = bool(discovery.fitted.model.members)
    html = render(
        "discovery_parameters.html",
        rows=rows,
        width=BIAS_WIDTH,
        has_effect=has_effect,
        colour=MODEL_COLOURS["tuned"],
    )
    return Section("Parameters with and without the effect", html, BIAS_LEAD)


def _row(p: TunedParameter) -> dict[str, Any]:
    last = p.with_effect if math.isfinite(p.with_effect) else p.tuned
    known = math.isfinite(p.with_effect_distance)
    return {
        "p": p,
        "start": _place(p.tuned_distance),
        "end": _place(p.with_effect_distance) if known else None,
        "colour": arrow_colour(p) if known else "",
        "last": with_sd(last, p.sd),
        "tags": "moved" if p.moved >= 1.0 else "",
    }


def _place(distance: float) -> float:
    """Unit across the drawing, cut off at its ends."""
    share = min(max(distance / BIAS_REACH, -1.0), 1.0)
    return round(0.5 * BIAS_WIDTH * (1.0 + 0.94 * share), 1)
