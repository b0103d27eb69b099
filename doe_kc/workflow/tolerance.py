"""Tolerance: the production scatter of a study's axle, solved car by car, as workbook, pictures and page."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from datetime import date
from pathlib import Path
from typing import Any

from doe_kc.campaign.export import write_table
from doe_kc.characteristics import characteristics_of
from doe_kc.ground.output import write_columns
from doe_kc.measurement import Measurement
from doe_kc.production_scatter.build import build_scatter
from doe_kc.production_scatter.model import ScatterModel
from doe_kc.production_scatter.requirements import Requirement, build_requirements
from doe_kc.production_scatter.result import Tolerance
from doe_kc.production_scatter.statistics import CarShare
from doe_kc.production_scatter.study import tolerance_study
from doe_kc.reports.render.csv import table_columns
from doe_kc.reports.render.json import table_records
from doe_kc.reports.render.terminal import table_lines
from doe_kc.reports.tolerance.contributions import contribution_table
from doe_kc.reports.tolerance.scatter import band_table, scatter_table
from doe_kc.reports.tolerance.tables import car_columns, tightening_table, tolerance_table
from doe_kc.reports.tolerance.words import conclusions
from doe_kc.study import STORES, Study
from doe_kc.targets import Targets, build_targets
from doe_kc.true_solver.make import solver_for
from doe_kc.workflow.measure import study_measurement
from doe_kc.workflow.measured_cars import measured_cars, named_cars


def tolerance_store(study: Study) -> Path:
    """The file of the cars: apart from the study's other evaluations, since the sides of these differ."""
    return study.out / STORES / "tolerance.sqlite"


def study_scatter(study: Study) -> ScatterModel:
    """The scatter that the study asks for; InputError as `build_scatter`."""
    return build_scatter(study.axle, study.tolerance, str(study.source))


def study_requirements(study: Study, measurement: Measurement | None) -> dict[str, Requirement]:
    """Those stated in [tolerance]; else the intervals of the study's targets, where it has some."""
    entries = characteristics_of(study.axle)
    stated = study.tolerance.requirement
    targets = None if stated else _targets(study, measurement)
    return build_requirements(entries, stated, targets, str(study.source))


def _targets(study: Study, measurement: Measurement | None) -> Targets | None:
    typed = any(c.target is not None for c in study.characteristics)
    if measurement is None and not typed:
        return None
    return build_targets(
        study.axle, measurement, study.characteristics, study.curves, source=str(study.source)
    )


def study_tolerance(
    study: Study,
    *,
    samples: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> Tolerance:
    """The tolerance study; samples: cars in place of the study's own. Cars in the store are not solved again.

    The requirements by default are those of the study's own measurement, the cars drawn beside may be others.
    """
    model = study_scatter(study)
    cars = measured_cars(study)
    own = next((m for f, m in cars if (f,) == study.measurements), None)
    needed = own is None and study.measurement is not None and not study.tolerance.requirement
    requirements = study_requirements(study, study_measurement(study) if needed else own)
    return tolerance_study(
        study.axle,
        solver_for(study.axle, study.solver, study.windows, study.folder),
        model,
        n=samples or study.tolerance.samples,
        seed=study.seed,
        requirements=requirements,
        cars=named_cars(cars),
        store=tolerance_store(study),
        twin=study.twin,
        workers=workers,
        scheduler=scheduler,
        source=str(study.source),
        progress=progress,
    )


def write_tolerance(
    study: Study, tolerance: Tolerance, folder: Path, *, workers: int | None = None
) -> list[Path]:
    """tolerance.xlsx, report.html, the pictures, and a CSV of every table and of the cars."""
    tables = {
        "characteristics.csv": table_columns(tolerance_table(tolerance)),
        "contributions.csv": table_columns(contribution_table(tolerance)),
        "tightening.csv": table_columns(tightening_table(tolerance)),
        "scatter.csv": table_columns(scatter_table(tolerance)),
        "bands.csv": table_columns(band_table(tolerance)),
    }
    written = [write_columns(folder / name, table) for name, table in tables.items()]
    written.append(write_table(folder / "cars.csv", car_columns(tolerance)))
    from doe_kc.reports.page.links import link_pages
    from doe_kc.reports.page.tolerance import write_tolerance_page
    from doe_kc.reports.tolerance.workbook import write_tolerance_workbook

    today = date.today().isoformat()
    written.append(
        write_tolerance_workbook(folder / "tolerance.xlsx", tolerance, study=study.name, date=today)
    )
    written.append(
        write_tolerance_page(
            folder / "report.html",
            tolerance,
            study=study.name,
            axle=study.axle_words,
            date=today,
            labels=study.axle.labels,
        )
    )
    link_pages(folder.parent)
    if study.pictures == "none":
        return written
    from doe_kc.reports.tolerance.figures import write_tolerance_figures

    return written + write_tolerance_figures(
        tolerance, folder, study=study.name, workers=workers, pictures=study.pictures
    )


def tolerance_lines(tolerance: Tolerance) -> list[str]:
    """For a terminal: the scatter of every characteristic, then what follows."""
    return [*table_lines(tolerance_table(tolerance)), *conclusions(tolerance)]


def tolerance_document(tolerance: Tolerance) -> dict[str, Any]:
    """`{"samples", "seed", "failed", "slopes", "outside_any", "characteristics", "contributions",
    "tightening", "conclusions", "seconds"}`; shares in [0, 1], a characteristic's record by its id."""
    table = tolerance_table(tolerance)
    paths = [s.parameter.path for s in tolerance.model.scatters]
    ids = [c.id for c in tolerance.characteristics]
    shares = {"first_order": tolerance.first_shares, "total": tolerance.totals.shares}
    return {
        "samples": tolerance.n,
        "seed": tolerance.seed,
        "failed": len(tolerance.failures),
        "slopes": tolerance.first_order.source,
        "outside_any": _share_document(tolerance.any_outside) if tolerance.required else None,
        "characteristics": dict(zip(ids, map(_finite, table_records(table)), strict=True)),
        "contributions": {
            kind: {
                ident: dict(zip(paths, map(float, column), strict=True))
                for ident, column in zip(ids, values.T, strict=True)
            }
            for kind, values in shares.items()
        },
        "tightening": dict(
            zip(paths, map(_finite, table_records(tightening_table(tolerance, ranked=False))), strict=True)
        ),
        "conclusions": conclusions(tolerance),
        "seconds": tolerance.seconds,
    }


def _finite(record: Mapping[str, Any]) -> dict[str, Any]:
    """Without numbers that JSON cannot hold."""
    return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in record.items()}


def _share_document(share: CarShare) -> dict[str, float]:
    return {"share": share.share, "low": share.low, "high": share.high}
