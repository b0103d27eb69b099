"""Handover: everything that a finished correlation leaves to the engineer, and its JSON and terminal text."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from datetime import date
from pathlib import Path
from typing import Any

from doe_kc.axle_file.write import write_axle
from doe_kc.correlation.assessment import Assessment, assess
from doe_kc.correlation.front import front_of
from doe_kc.correlation.result import Correlation
from doe_kc.ground.output import write_columns
from doe_kc.measurement import Measurement
from doe_kc.reports.comparison.car_table import cars_beside, write_cars
from doe_kc.reports.correlation.characteristics import characteristic_table
from doe_kc.reports.correlation.evaluations import evaluation_table
from doe_kc.reports.correlation.parameters import parameter_table, remark_sentences
from doe_kc.reports.correlation.summary import summary
from doe_kc.reports.correlation.terms import curve_table, term_columns
from doe_kc.reports.correlation.twin_tables import twin_entry, twin_table
from doe_kc.reports.correlation.workbook import write_correlation_workbook
from doe_kc.reports.hysteresis import hysteresis_table, loop_widths
from doe_kc.reports.page.correlation import write_correlation_page
from doe_kc.reports.page.links import link_pages
from doe_kc.reports.render.csv import table_columns
from doe_kc.reports.render.json import table_records
from doe_kc.reports.render.terminal import table_lines
from doe_kc.reports.table import Table
from doe_kc.study import Study

CORRELATION_TABLES: Mapping[str, Callable[[Correlation], Table[Any]]] = {
    "parameters.csv": parameter_table,
    "characteristics.csv": characteristic_table,
    "curves.csv": curve_table,
    "evaluations.csv": evaluation_table,
}
AXLE = "axle.toml"
AXLE_PICTURE = "correlation_axle"


def write_correlation(
    study: Study,
    correlation: Correlation,
    measurement: Measurement | None,
    folder: Path,
    *,
    assessment: Assessment | None = None,
    workers: int | None = None,
) -> list[Path]:
    """axle.toml, the tables, correlation.xlsx, report.html and the figures; returns the paths.

    measurement: for the measured curves; None with typed targets. assessment: by default the correlation's
    own. workers: processes that draw. RunError when the folder cannot be written.
    """
    verdict = assessment or assess(correlation)
    designed = study.as_designed(correlation.axle)
    axle = write_axle(designed, study.axle_path, folder / AXLE, note=axle_note(correlation, verdict))
    notes = {
        "Axle": f"{correlation.axle.name}: {AXLE}, from {study.axle_path.name}",
        "Measurement": measurement.manifest.name if measurement is not None else "none, targets are typed",
        "Effects": ", ".join(correlation.axle.effects) or "none",
    }
    words: dict[str, Any] = {
        "study": study.name,
        "date": date.today().isoformat(),
        "notes": notes,
        "assessment": verdict,
    }
    page = write_correlation_page(folder / "report.html", correlation, measurement, **words)
    link_pages(folder.parent)
    loops = [] if measurement is None else loop_widths(correlation, measurement)
    cars = cars_beside(correlation, measurement)
    figures = _write_figures(study, correlation, measurement, folder, workers)
    return [
        axle,
        *(
            write_columns(folder / name, table_columns(of(correlation)))
            for name, of in CORRELATION_TABLES.items()
        ),
        *write_cars(cars, folder),
        write_columns(folder / "rating_terms.csv", term_columns(correlation)),
        *(
            [write_columns(folder / "twin.csv", table_columns(twin_table(correlation.twin)))]
            if correlation.twin is not None
            else ()
        ),
        *(
            [write_columns(folder / "hysteresis.csv", table_columns(hysteresis_table(loops)))]
            if loops
            else ()
        ),
        write_correlation_workbook(
            folder / "correlation.xlsx",
            correlation,
            **words,
            loops=loops,
            cars=cars,
            axle_picture=_axle_picture(figures),
        ),
        page,
        *figures,
        *(_write_front(correlation, folder, study) if correlation.method == "pareto" else ()),
    ]


def _write_figures(
    study: Study, correlation: Correlation, measurement: Measurement | None, folder: Path, workers: int | None
) -> list[Path]:
    if study.pictures == "none":
        return []
    from doe_kc.reports.correlation.figures import write_correlation_figures

    return write_correlation_figures(
        correlation, measurement, folder, study=study.name, workers=workers, pictures=study.pictures
    )


def _axle_picture(figures: Sequence[Path]) -> bytes | None:
    """The drawn axle, for the workbook; None where it is not drawn as PNG."""
    drawn = [path for path in figures if path.name == f"{AXLE_PICTURE}.png"]
    return drawn[0].read_bytes() if drawn else None


def axle_note(correlation: Correlation, assessment: Assessment) -> str:
    """First line of the axle file: status, effects, rating."""
    effects = ", ".join(correlation.axle.effects) or "none"
    rating = f"Rating {correlation.rating:.6g}, correlated by {correlation.method}."
    return f"{assessment.line} Effects: {effects}. {rating}"


def _write_front(correlation: Correlation, folder: Path, study: Study) -> list[Path]:
    """pareto_front.csv and its picture: the confirmed trade-offs between the load cases."""
    front = front_of(correlation.problem.search, correlation.run.evaluated)
    table = write_columns(folder / "pareto_front.csv", front.columns())
    if study.pictures == "none":
        return [table]
    from doe_kc.reports.correlation.pareto_figure import write_pareto_figure

    return [table, *write_pareto_figure(front, folder, study=study.name, pictures=study.pictures)]


def correlation_document(
    correlation: Correlation, axle_path: Path, assessment: Assessment | None = None
) -> dict[str, Any]:
    """What `correlate --json` writes. Numbers that are not finite become null in the file.

    characteristics: every one with a target; low, high: the constraint interval, where the study sets none
    that of equations 5.1 and 5.2; held, reachable: as in `CharacteristicRow`. parameters: sd is null at a
    bound, where `inward` tells how far inside the value may lie (68 %). twin: beside an outside model.
    """
    verdict, parameters = assessment or assess(correlation), parameter_table(correlation)
    return {
        "status": verdict.status,
        "reasons": list(verdict.reasons),
        "method": correlation.method,
        "evaluations": len(correlation.run.evaluated),
        "rating": correlation.rating,
        "feasible": correlation.feasible,
        "mean_improvement_percent": correlation.mean_improvement,
        "characteristics": table_records(characteristic_table(correlation)),
        "parameters": dict(zip((r.path for r in parameters.rows), table_records(parameters), strict=True)),
        **({"twin": twin_entry(correlation.twin)} if correlation.twin is not None else {}),
        "axle": str(axle_path),
        "seconds": correlation.seconds,
        "stopped": correlation.run.stopped,
        "steps": list(correlation.steps),
        "notes": list(correlation.notes),
    }


def correlation_lines(correlation: Correlation, assessment: Assessment | None = None) -> list[str]:
    """The outcome for a terminal, its status first; * marks what lies outside interval and noise."""
    words = summary(correlation, assessment)
    lines = [words.pop("Status"), *table_lines(characteristic_table(correlation))]
    lines += [f"{key}: {text}" for key, text in words.items()]
    return lines + remark_sentences(correlation)
