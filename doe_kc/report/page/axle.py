"""The axle from three sides, in the page."""

from __future__ import annotations

import base64
import io

from doe_kc.correlation.result import Correlation
from doe_kc.report.axle_views import AxleView, axle_figure, correlation_view
from doe_kc.report.render.page import Section, render
from doe_kc.report.style import write_svg

AXLE_LEAD = (
    "Arrows show how far each hardpoint of the left side moved, drawn longer by the factor in the key; the "
    "cross at an arrow's head is its standard deviation in the same scale, where the measurement gives one."
)


def axle_section(correlation: Correlation) -> Section:
    """The axle that was given and how far its hardpoints moved."""
    view = correlation_view(correlation, "left side")
    return Section("Axle", render("axle.html", picture=svg_data(view), words=_words(view)), AXLE_LEAD)


def svg_data(view: AxleView) -> str:
    """The drawing as a data URL, the same for the same axles."""
    stream = io.BytesIO()
    write_svg(axle_figure(view), stream)
    return "data:image/svg+xml;base64," + base64.b64encode(stream.getvalue()).decode("ascii")


def _words(view: AxleView) -> str:
    """What the drawing shows, for those who cannot see it."""
    farthest = max(view.moves, key=lambda m: m.distance)
    return (
        "Side, top and rear view of the left side of the axle; the point that moved farthest is "
        f"{farthest.name}, by {farthest.distance:.2f} mm."
    )
