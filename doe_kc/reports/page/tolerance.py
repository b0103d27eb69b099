"""The page of a tolerance study."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from markupsafe import Markup

from doe_kc.production_scatter.result import Tolerance
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.page.axle import png_data
from doe_kc.reports.page.glossary import glossary_section
from doe_kc.reports.render.page import Section, render, table_html, write_page
from doe_kc.reports.tolerance.bands import band_sheet
from doe_kc.reports.tolerance.figures import contributions, distributions, measured_handles, tightening_bars
from doe_kc.reports.tolerance.scatter import band_table, scatter_table
from doe_kc.reports.tolerance.tables import tightening_table, tolerance_table
from doe_kc.reports.tolerance.words import conclusions

DISTRIBUTION_LEAD = (
    "Each car is a draw of all scattering parameters, solved by the true solver. Dashed: what slopes alone "
    "would give; shaded: outside the requirement."
)
CONTRIBUTION_LEAD = (
    "Share of each variance that a parameter, both sides together, takes part in: by its slope, and in "
    "total, with curvature and interactions."
)
TIGHTENING_LEAD = (
    "The same cars with the scatter of one parameter halved or doubled, by first order on top of what the "
    "true solver gave for each."
)
BAND_LEAD = (
    "Where the curves of 95 % and of half of the cars lie; on the right as distance from the unchanged axle."
)


def tolerance_sections(tolerance: Tolerance, *, study: str) -> list[Section]:
    """What follows, Distributions, What to tighten, Contributions, Curves, Scatter of the parameters,
    Words."""
    tightening = table_html(tightening_table(tolerance))
    if tolerance.required:
        tightening = (
            _picture(tightening_bars(tolerance, study=study), "Cars outside, by parameter") + tightening
        )
    looks = measured_handles(tolerance)
    bands = [
        _picture(
            band_sheet(b, tolerance.cars, looks, study=study),
            f"Curves of the cars, {b.load_case}",
            folded=True,
        )
        for b in tolerance.bands
    ]
    return [
        Section("What follows", render("tolerance.html", sentences=conclusions(tolerance))),
        Section(
            "Characteristics",
            table_html(tolerance_table(tolerance))
            + _picture(distributions(tolerance, study=study), "Distributions of the characteristics"),
            DISTRIBUTION_LEAD,
        ),
        Section("What to tighten", tightening, TIGHTENING_LEAD),
        Section(
            "Contributions",
            _picture(contributions(tolerance, study=study), "Contributions"),
            CONTRIBUTION_LEAD,
        ),
        *(
            [Section("Curves", Markup("").join((table_html(band_table(tolerance)), *bands)), BAND_LEAD)]
            if bands
            else []
        ),
        Section("Scatter of the parameters", table_html(scatter_table(tolerance))),
        glossary_section("scatter", "first order", "total share", "95 % interval", "interval"),
    ]


def _picture(page: Sheet, words: str, *, folded: bool = False) -> Markup:
    return render("picture.html", source=png_data(page), words=words, folded=folded)


def write_tolerance_page(
    path: Path,
    tolerance: Tolerance,
    *,
    study: str,
    axle: str,
    date: str,
    labels: Mapping[str, str] | None = None,
) -> Path:
    """Write the page; RunError when it cannot be written. axle: which one it is of. labels: of its points and
    elements."""
    sections = tolerance_sections(tolerance, study=study)
    return write_page(path, f"Tolerance: {study}", sections, subtitle=f"{axle}; {date}", labels=labels)
