"""The correlation workbook: what came out, from what, and a rating sheet to try other weights in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc import __version__
from doe_kc.correlation.assessment import Assessment, assess
from doe_kc.correlation.result import Correlation
from doe_kc.reports.comparison.car_table import car_table
from doe_kc.reports.correlation.characteristics import characteristic_table
from doe_kc.reports.correlation.dna import DNA_REACH
from doe_kc.reports.correlation.evaluations import evaluation_table
from doe_kc.reports.correlation.parameters import parameter_table, remark_sentences
from doe_kc.reports.correlation.rating_sheet import FINAL_RATING, rating_sheet
from doe_kc.reports.correlation.summary import summary
from doe_kc.reports.correlation.terms import curve_table
from doe_kc.reports.correlation.twin_tables import twin_table
from doe_kc.reports.drawing.style import BASELINE_COLOUR, FINAL_COLOUR
from doe_kc.reports.hysteresis import LoopWidth, hysteresis_table
from doe_kc.reports.render.cells import frame, put
from doe_kc.reports.render.charts import add_bars, add_picture, chart_sheet
from doe_kc.reports.render.workbook import TABLE_FIRST_ROW, lines_sheet, new_book, table_sheet, write_book
from doe_kc.reports.table import four_digits
from doe_kc.targets.comparison import CarComparison

CORRELATION_LEGEND = {
    "Frame": "Chassis: X rearwards, Y to the right, Z up, ground z = 0. Characteristics: left wheel.",
    "Signs": "Toe-in +, camber top outwards +, caster top rearwards +; forces as their load case has them.",
    "Paths": "LLF.x is a hardpoint coordinate in mm, llr.Fx a stiffness factor (nominal 1). Both sides "
    "change alike.",
    "Rating": "Equation 2.2: 0 = every target met exactly, the more negative the worse. Violated constraints "
    "weigh by QuadWt 10000 unless the study says otherwise.",
    "Interval": "target ± 0.15 sqrt(target² + 0.005) (equations 5.1 and 5.2) unless the study gives low and "
    "high. Where the role has no constraint it is for information only.",
    "Improvement": "100 % = target met, 0 % = as far off as the baseline, negative = worse. It enters the "
    "mean where the characteristic is an objective or constraint and its baseline is more than three "
    "standard deviations of the target away.",
    "Distance": "(value - target) / sd of the target; empty for a target without error.",
    "Normalised": "1 + sign(target) (value - target) / sqrt(target² + 0.005): value / target away from zero.",
    "sd of a parameter": "Of the car's value about the final one, by the exact sensitivities at the final "
    "design (of the twin where an outside solver has one): all variables and the sizes of effects that were "
    "found free together, prior from the bounds; with the distance of the most probable value from the final "
    "one.",
    "Not visible": "The measurement does not halve what was known before it; the final value says nothing "
    "about the car.",
    "Curves": "RMS deviation from the measured mean curve of both wheels; noise is the RMS error of that "
    "curve: an RMS near it is a perfect fit.",
    "Rating terms": "Yellow cells can be edited; sums and the live rating of the summary follow.",
}


def write_correlation_workbook(
    path: Path,
    correlation: Correlation,
    *,
    study: str,
    date: str,
    notes: Mapping[str, str] | None = None,
    assessment: Assessment | None = None,
    loops: Sequence[LoopWidth] = (),
    cars: Sequence[CarComparison] = (),
    axle_picture: bytes | None = None,
) -> Path:
    """Write sheets Summary, DNA, Axle, Characteristics, Cars, Parameters, Curves, Twin, Hysteresis,
    Evaluations, Rating terms and Legend; Axle, Cars, Twin and Hysteresis where there is a picture, are
    several cars, a twin and loops.

    study: name in titles and page headers. date: as it shall stand in the summary. notes: further lines of
    the summary, title -> text (axle file, measurement, ...). assessment: by default the correlation's own.
    axle_picture: PNG. RunError naming path and remedy when the place is locked or full.
    """
    book = new_book(f"Correlation: {study}")
    _summary_sheet(book, correlation, study, date, notes or {}, assessment or assess(correlation))
    remark = (
        "Final and baseline over the target, away from zero; 1 is the target. Longer bars end at the axis."
    )
    dna = chart_sheet(book, "DNA", "Correlation DNA", remark, study)
    if axle_picture is not None:
        remark = "How far each hardpoint of the left side moved; the factor is in the key."
        add_picture(chart_sheet(book, "Axle", "The axle before and after", remark, study), axle_picture)
    _dna_chart(dna, table_sheet(book, characteristic_table(correlation), study), correlation)
    if cars:
        table_sheet(book, car_table(cars), study)
    table_sheet(book, parameter_table(correlation), study)
    table_sheet(book, curve_table(correlation), study)
    if correlation.twin is not None:
        table_sheet(book, twin_table(correlation.twin), study)
    if loops:
        table_sheet(book, hysteresis_table(loops), study)
    table_sheet(book, evaluation_table(correlation), study)
    rating_sheet(book, correlation, study)
    lines_sheet(
        book, "Legend", "Legend", "How to read this workbook.", list(CORRELATION_LEGEND.items()), study
    )
    return write_book(path, book)


def _dna_chart(ws: Worksheet, data: Worksheet, correlation: Correlation) -> None:
    """Bars of baseline and final about the target, from the sheet of the characteristics."""
    table = characteristic_table(correlation)
    letters = {c.key: get_column_letter(i) for i, c in enumerate(table.sheet_columns, start=1)}
    values = [letters["baseline_normalized"], letters["final_normalized"]]
    add_bars(
        ws, data, names=letters["label"], values=values,
        colors=[c.removeprefix("#") for c in (BASELINE_COLOUR, FINAL_COLOUR)],
        rows=(TABLE_FIRST_ROW, TABLE_FIRST_ROW + len(table.rows) - 1),
        limits=(1.0 - DNA_REACH, 1.0 + DNA_REACH), middle=1.0, axis="normalised to the target (1)",
    )  # fmt: skip


def _summary_sheet(
    book: Workbook,
    correlation: Correlation,
    study: str,
    date: str,
    notes: Mapping[str, str],
    assessment: Assessment,
) -> None:
    """Outcome, what to think of bounds and unseen variables, and where it came from."""
    remarks = {f"Note {i}": text for i, text in enumerate(remark_sentences(correlation), start=1)}
    origin = {"Study": study, "Date": date, "Program": f"doe_kc {__version__}", **notes}
    lines = list({**summary(correlation, assessment), **remarks, **origin}.items())
    doubts = {
        "Status": assessment.status != "sound",
        "Constraints": not correlation.feasible,
        "Twin": correlation.twin is not None and correlation.twin.status != "sound",
        **dict.fromkeys(remarks, True),
    }
    remark = "What the correlation reached, and what to know before using it."
    flagged = {i for i, (key, _) in enumerate(lines) if doubts.get(key)}
    ws = lines_sheet(book, "Summary", "Correlation", remark, lines, study, bold=4, flagged=flagged)
    row = 4 + len(lines)
    put(ws, row, 1, "Rating, live", bold=True, vertical="top")
    cell = put(ws, row, 2, None, number=four_digits(correlation.rating), horizontal="left")
    cell.value = f"='Rating terms'!{FINAL_RATING}"
    put(ws, row + 1, 2, "with the weights, targets and intervals as they stand in the sheet Rating terms")
    frame(ws, range(row, row + 1), range(1, 3))
