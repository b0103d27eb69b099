"""The axle from three sides, in the page."""

from __future__ import annotations

import base64
import io

from markupsafe import Markup

from doe_kc.axle.members import drawn_points
from doe_kc.axle.model import HARDPOINTS, Axle
from doe_kc.correlation.result import Correlation
from doe_kc.reports.axle.point_moves import AxleView, correlation_view
from doe_kc.reports.axle.strip import strip_figure
from doe_kc.reports.axle.views import axle_figure
from doe_kc.reports.drawing.png import png_bytes
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.style import DPI, write_svg
from doe_kc.reports.render.page import Section, render

AXLE_LEAD = (
    "Arrows show how far each hardpoint of the left side moved, drawn longer by the factor in the key; the "
    "cross at an arrow's head is its standard deviation in the same scale, where the measurement gives one."
)


def axle_section(correlation: Correlation) -> Section:
    """The axle that was given and how far its hardpoints moved."""
    view = correlation_view(correlation, "left side")
    return Section("Axle", _drawing(axle_figure(view), view), AXLE_LEAD)


def strip_section(view: AxleView) -> Section:
    """The same beside each other, for the first page."""
    return Section("The axle", _drawing(strip_figure(view), view), AXLE_LEAD)


def _drawing(page: Sheet, view: AxleView) -> Markup:
    return render("axle.html", picture=svg_data(page), words=_words(view), points=_point_labels(view.before))


def _point_labels(axle: Axle) -> dict[str, str]:
    """What each drawn hardpoint is."""
    return {name: axle.labels.get(name) or HARDPOINTS[name] for name in drawn_points(axle)}


def svg_data(page: Sheet) -> str:
    """A drawing as a data URL, the same for the same axles."""
    stream = io.BytesIO()
    write_svg(page, stream)
    return "data:image/svg+xml;base64," + base64.b64encode(stream.getvalue()).decode("ascii")


def png_data(page: Sheet) -> str:
    """A drawing of many curves as a data URL: a fifth of the time of `svg_data`, and no larger."""
    content = png_bytes(page.pixels(), DPI, words={"Software": "doe_kc"})
    return "data:image/png;base64," + base64.b64encode(content).decode("ascii")


def _words(view: AxleView) -> str:
    """What the drawing shows, for those who cannot see it."""
    farthest = max(view.moves, key=lambda m: m.distance)
    return (
        "Side, top and rear view of the left side of the axle; the point that moved farthest is "
        f"{farthest.name}, by {farthest.distance:.2f} mm."
    )
