"""The report page of a discovery: what the model lacks, how that was found, what to test next."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from markupsafe import Markup
from matplotlib.colors import LogNorm, to_hex

from doe_kc.curves import response_name
from doe_kc.discovery.result import Discovery, VerdictKind
from doe_kc.discovery.verdict.other_sizes import OTHER_SIZE
from doe_kc.discovery.verdict.sentences import OBJECTION
from doe_kc.effects.words import effect_label
from doe_kc.ground.numbers import with_sd
from doe_kc.load_cases import case_label
from doe_kc.measurement import Measurement
from doe_kc.reports.discovery.effect_words import effect_words, effect_words_table
from doe_kc.reports.discovery.gap_steps import gap_steps, gap_steps_figure
from doe_kc.reports.discovery.gaps import MODEL_COLOURS
from doe_kc.reports.discovery.heat_map import (
    DISAGREEMENT_MAP,
    MAP_RETUNED,
    MAP_SIGNS,
    QUIET_COLOUR,
    GridCell,
    MapGrid,
    beyond_words,
    discovery_grids,
    shape_words,
    signed,
)
from doe_kc.reports.discovery.library import library_table
from doe_kc.reports.discovery.loops import LOOPS_DRAWN, loop_figure, loop_pairs, loop_table
from doe_kc.reports.discovery.parameter_figure import arrow_colour
from doe_kc.reports.discovery.parameters import TunedParameter, tuned_table
from doe_kc.reports.discovery.words import contrast_words, headline, own_sentences
from doe_kc.reports.page.axle import svg_data
from doe_kc.reports.page.discovery_candidates import (
    candidates_section,
    held_out_section,
    scan_section,
    tests_section,
)
from doe_kc.reports.page.discovery_curves import curves_section, gap_section
from doe_kc.reports.page.glossary import glossary_section
from doe_kc.reports.render.page import Section, render, table_html, write_page
from doe_kc.reports.table import Column, PageCell, ink_on


def verdict_section(discovery: Discovery, notes: Mapping[str, str]) -> Section:
    """The answer in one sentence, a line for each effect, the gap step by step, what remains; the statistics
    behind it folded."""
    words = [effect_words(discovery, f) for f in (*discovery.findings, *discovery.traces)]
    steps = gap_steps(discovery)
    html = render(
        "discovery_verdict.html",
        headline=headline(discovery),
        fill=VERDICT_FILLS[discovery.verdict],
        ink=ink_on(VERDICT_FILLS[discovery.verdict]),
        sentence=discovery.sentences[0],
        gap=discovery.gap,
        has_effect=bool(discovery.fitted.model.members),
        better=sum(h.gain > 0.0 for h in discovery.held_out),
        cases=len(discovery.held_out),
        effects=table_html(effect_words_table(words)) if words else "",
        picture=svg_data(gap_steps_figure(steps, discovery.gap.noise_floor)),
        steps=steps,
        **_loops(discovery),
        remains=_remains(discovery),
        statistics=own_sentences(discovery)[1:],
        notes=notes,
    )
    return Section("Verdict", html)


NO_LOOPS = "None: no loop, measured or modelled, stands out of the noise, so neither friction nor hysteresis."
UNKNOWN_LOOPS = "Not known: the records run through each load case in one direction only."
LOOP_REMS = 20.0
"""Width of one loop's drawing in the page."""


def _loops(discovery: Discovery) -> dict[str, Any]:
    """Picture and table of the loops, or why there are none."""
    pairs = loop_pairs(discovery)
    if not pairs:
        curves = discovery.search.tuned.model.likelihood.curves
        known = any(c.branches == "half_width" for c in curves)
        return {"loops": "", "no_loops": NO_LOOPS if known else UNKNOWN_LOOPS}
    return {
        "loops": svg_data(loop_figure(pairs)),
        "loops_width": LOOP_REMS * min(len(pairs), LOOPS_DRAWN),
        "loop_rows": table_html(loop_table(pairs)),
    }


VERDICT_FILLS: Mapping[VerdictKind, str] = {
    "named": "0072B2",
    "none": "0072B2",
    "class": "E69F00",
    "unexplained": "D55E00",
}
"""RRGGBB behind the verdict's headline."""


def _remains(discovery: Discovery) -> list[str]:
    """What the records leave open, in sentences."""
    out = [
        f"These records do not tell {' from '.join(effect_label(e).lower() for e in group)}."
        for group in discovery.classes
    ]
    out += [
        f"Unexplained: {contrast_words(c)}, {signed(z)} times the noise." for c, z in discovery.unexplained
    ]
    if discovery.beyond:
        out.append(f"Outside their bounds: {', '.join(discovery.beyond)}; check the nominal axle.")
    if not out and discovery.verdict == "unexplained":
        out = [s for s in discovery.sentences if s.startswith(OBJECTION)]
    elif not out:
        left = discovery.gap.with_effect
        out = [f"Nothing: {left:.2f} times the noise of the rig are left, which is noise."]
    others = [s.removeprefix(OTHER_SIZE) for s in discovery.sentences if s.startswith(OTHER_SIZE)]
    return [*out, *(sentence[0].upper() + sentence[1:] for sentence in others)]


MAPS_LEAD = " ".join(
    (
        "The largest disagreement of each load case and response as a multiple of its noise, and its shape.",
        MAP_SIGNS,
        *MAP_RETUNED,
    )
)
DARK = 0.6
"""Place on the colour scale from which white text is read better."""


def maps_section(discovery: Discovery) -> Section:
    """One table a map, the same colours in all."""
    grids = discovery_grids(discovery)
    largest = max((abs(c.z) for g in grids for c in g.cells.values()), default=1.0)
    norm = LogNorm(min(g.threshold for g in grids), max(largest, 10.0 * grids[0].threshold))
    html = render("discovery_maps.html", maps=[_map(g, norm) for g in grids])
    return Section("Where they disagree", html, MAPS_LEAD)


def _map(grid: MapGrid, norm: LogNorm) -> dict[str, Any]:
    return {
        "title": grid.title,
        "words": beyond_words(grid),
        "threshold": grid.threshold,
        "heads": [response_name(r) for r in grid.responses],
        "rows": [
            (case_label(case), [_map_cell(grid, grid.cells.get((case, r)), norm) for r in grid.responses])
            for case in grid.cases
        ],
    }


def _map_cell(grid: MapGrid, cell: GridCell | None, norm: LogNorm) -> dict[str, str] | None:
    if cell is None:
        return None
    quiet = abs(cell.z) <= grid.threshold
    place = float(norm(abs(cell.z)))
    return {
        "z": signed(cell.z),
        "shape": shape_words(cell),
        "title": f"{contrast_words(cell.contrast)}: {signed(cell.z)} standard deviations",
        "back": QUIET_COLOUR if quiet else to_hex(DISAGREEMENT_MAP(place)),
        "ink": "#5b6670" if quiet else "#ffffff" if place > DARK else "#000000",
    }


BIAS_LEAD = (
    "Where an effect is missing, re-tuning bends parameters that have nothing to do with it. Circles: "
    "distance from nominal after re-tuning without an effect, as a multiple of production scatter (±sd); "
    "arrows lead to the place with the effect."
)
BIAS_REACH, BIAS_WIDTH = 2.5, 200.0
"""Distance at the ends of the drawing, and its width in units."""


def parameters_section(discovery: Discovery) -> Section:
    """One row a tunable parameter, sortable and filterable, those furthest off first."""
    table = tuned_table(discovery)
    rows = sorted(table.rows, key=lambda p: -abs(p.tuned_distance))
    columns = (*table.columns, *_page_columns(bool(discovery.fitted.model.members)))
    html = table_html(replace(table, rows=rows, columns=columns))
    return Section("Parameters with and without the effect", html, BIAS_LEAD)


def _page_columns(has_effect: bool) -> Iterator[Column[TunedParameter]]:
    """The last value with its standard deviation, and the distances as a drawing."""

    def last(p: TunedParameter) -> float:
        return p.with_effect if has_effect else p.tuned

    head = f"{'With the effect' if has_effect else 'Re-tuned'} ± sd"
    shown = PageCell[TunedParameter](head, text=lambda p: with_sd(last(p), p.sd), strong=lambda p: True)
    yield Column("last", None, last, "0.0000", csv=False, page=shown)
    drawing = PageCell[TunedParameter](
        "Distance from nominal, ±2.5 sd", text=_distance_bar, order=lambda p: abs(p.tuned_distance)
    )
    yield Column("bar", None, lambda p: p.tuned_distance, csv=False, page=drawing)


def _distance_bar(p: TunedParameter) -> Markup:
    known = math.isfinite(p.with_effect_distance)
    return render(
        "tuned.svg",
        p=p,
        width=BIAS_WIDTH,
        start=_distance_place(p.tuned_distance),
        end=_distance_place(p.with_effect_distance) if known else None,
        colour=arrow_colour(p) if known else "",
        circle=MODEL_COLOURS["tuned"],
    )


def _distance_place(distance: float) -> float:
    """Unit across the drawing, cut off at its ends."""
    share = min(max(distance / BIAS_REACH, -1.0), 1.0)
    return round(0.5 * BIAS_WIDTH * (1.0 + 0.94 * share), 1)


LIBRARY_LEAD = (
    "Would have shown: it would have been found from the detectable size on, in four of five cars, if the "
    "model is right but for this; for a stiffness, a softer part would have been found. Not resolved: the "
    "same, but the model does not explain the records, so that nothing follows. Not testable: re-tuning "
    "absorbs it or it shows too little in these load cases; the parameters that hide it are named with the "
    "move that does so, and the parts that, measured on a bench, would show it, with the standard deviations "
    "that its typical size would then make."
)


def discovery_sections(
    discovery: Discovery, measurement: Measurement | None, *, notes: Mapping[str, str] | None = None
) -> list[Section]:
    """In the order of a test engineer's questions. notes: further lines of the first section."""
    made = {"Measurement": measurement.manifest.name} if measurement is not None else {}
    held_out = [held_out_section(discovery)] if discovery.held_out else []
    return [
        verdict_section(discovery, {**made, **(notes or {})}),
        tests_section(discovery),
        maps_section(discovery),
        *curves_section(discovery),
        gap_section(discovery),
        *held_out,
        parameters_section(discovery),
        library_section(discovery),
        candidates_section(discovery),
        *scan_section(discovery),
        glossary_section(*DISCOVERY_TERMS),
    ]


DISCOVERY_TERMS = (
    "noise",
    "times the noise",
    "± uncertainty",
    "sure (98 %)",
    "odds",
    "evidence",
    "best other effect",
    "held out",
    "adequacy",
    "prior",
)


def library_section(discovery: Discovery) -> Section:
    """One row a hypothesis, sortable and filterable."""
    return Section("Library of effects", table_html(library_table(discovery)), LIBRARY_LEAD)


def write_discovery_page(
    path: Path,
    discovery: Discovery,
    measurement: Measurement | None,
    *,
    study: str,
    date: str,
    notes: Mapping[str, str] | None = None,
) -> Path:
    """Write the page; RunError when it cannot be written."""
    sections = discovery_sections(discovery, measurement, notes=notes)
    return write_page(
        path, f"Missing effects: {study}", sections, subtitle=date, labels=discovery.fitted.model.axle.labels
    )
