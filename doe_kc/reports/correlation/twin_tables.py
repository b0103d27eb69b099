"""Where an outside model and its twin disagree: one table for CSV, workbook, page and JSON."""

from __future__ import annotations

from typing import Any

from doe_kc.correlation.twin_agreement import TwinAgreement, TwinDifference
from doe_kc.curves import response_name
from doe_kc.load_cases import case_label
from doe_kc.reports.render.json import table_records
from doe_kc.reports.table import Column, PageCell, PageLayout, Table

TWIN_REMARK = (
    "The outside model less its twin. In noise: RMS over the measured points in standard deviations of the "
    "records, both wheels; up to 1 the records cannot tell the models apart. Half-widths of loops "
    "likewise, in standard deviations of a point."
)

TWIN_COLUMNS: tuple[Column[TwinDifference], ...] = (
    Column("load_case", "Load case", lambda r: r.load_case, width=28, json="load_case",
           words=lambda r: case_label(r.load_case), page=PageCell()),
    Column("response", "Response", lambda r: r.response, width=24, json="response",
           words=lambda r: response_name(r.response), page=PageCell()),
    Column("unit", "Unit", lambda r: r.unit, width=8, json="unit", page=PageCell()),
    Column("noise_start", "In noise, start", lambda r: r.start, "0.0", 15, json="noise_start",
           page=PageCell(digits=3)),
    Column("noise_best", "In noise, final", lambda r: r.best, "0.0", 15, json="noise_best",
           page=PageCell(digits=3)),
    Column("largest", "Largest, final", lambda r: r.largest, "0.0000", 15, json="largest",
           page=PageCell(digits=3)),
    Column("at", "at input", lambda r: r.at, "0.###", 11, json="at", page=PageCell(digits=4)),
    Column("loop", "Largest of half-width", lambda r: r.loop, "0.0000", 20, json="loop",
           page=PageCell(digits=3)),
    Column("loop_noise", "Half-width in noise", lambda r: r.loop_noise, "0.0", 18, json="loop_noise",
           page=PageCell(digits=3)),
)  # fmt: skip


def twin_table(agreement: TwinAgreement) -> Table[TwinDifference]:
    """A row a load case and response, the largest difference first."""
    return Table(
        "Twin",
        TWIN_REMARK,
        TWIN_COLUMNS,
        agreement.rows,
        flagged=lambda r: r in agreement.beyond,
        empty="The two models could not be compared.",
        page=PageLayout[TwinDifference](
            "twin-differences",
            "Outside model and twin",
            filtered=True,
            choices={"beyond": "beyond the noise only"},
            tags=lambda r: "beyond" if r in agreement.beyond else "",
        ),
    )


def twin_entry(agreement: TwinAgreement) -> dict[str, Any]:
    """For JSON: status, sentence, explained percentage, the variable to look at, and the table."""
    shift = agreement.shift
    return {
        "status": agreement.status,
        "sentence": agreement.line,
        "changes_explained_percent": None if agreement.share is None else 100.0 * agreement.share,
        "variable": None
        if shift is None
        else {"path": shift.path, "change": shift.change, "unit": shift.unit, "share": shift.share},
        "differences": table_records(twin_table(agreement)),
    }
