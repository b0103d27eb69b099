"""Samples the study's variables by the true solver, every result into the study's store."""

from __future__ import annotations

import re
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.axle.parameters import parameter_value
from doe_kc.campaign.export import Format, designs_frame, export_store, write_table
from doe_kc.campaign.record import StoredCurves
from doe_kc.campaign.runner import Campaign
from doe_kc.campaign.store import read_store
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.render.json import table_records
from doe_kc.reports.render.terminal import table_lines
from doe_kc.reports.surrogates.sample_tables import CharacteristicSpan, span_table
from doe_kc.reports.table import Table
from doe_kc.sampling import Design, find_sampler, sample
from doe_kc.study import Study
from doe_kc.surrogate_models.designs import place
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.outcome import Outcome

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


@dataclass(frozen=True)
class SampleResult:
    """outcomes: of the design's rows, without curves, which are in the store.

    runs: true-solver runs made; kept: rows whose result was there before, or stands in an earlier row.
    """

    design: Design
    outcomes: tuple[Outcome, ...]
    runs: int
    seconds: float

    @property
    def kept(self) -> int:
        return len(self.outcomes) - self.runs

    @property
    def counts(self) -> str:
        """Runs, what was there, failures, and the time, in words."""
        return f"{self.runs} run, {self.kept} already there, {len(self.failed)} failed; {self.seconds:.1f} s"

    @property
    def spans(self) -> Table[CharacteristicSpan]:
        """Of every characteristic over the designs that were solved."""
        values = [o.characteristics for o in self.outcomes if not o.failed]
        return span_table(np.array(values).reshape(len(values), len(CHARACTERISTICS)))

    @property
    def failed(self) -> list[Outcome]:
        """Rows without a result."""
        return [o for o in self.outcomes if o.failed]


def study_design(study: Study, *, method: str | None, n: int | None, extend: bool = False) -> Design:
    """Designs of the study's space; method and n in place of the study's own.

    extend: stored designs of the space count among the n, and only what is missing is drawn, to complete
    them. InputError for an unknown method, a table that does not fit, a full factorial too large, or nothing
    to add.
    """
    options = study.sampling
    chosen = method or options.method
    find_sampler(chosen, "--method" if method else f"{study.source}: sampling.method")
    wanted = n or options.n
    stored = _stored(study) if extend else []
    if stored and len(stored) >= wanted:
        raise InputError(
            f"{study.store}: holds {len(stored)} designs of the study's variables already, --n {wanted} adds "
            f"none; give --n above {len(stored)}."
        )
    new = sample(
        study.space,
        wanted - len(stored),
        seed=study.seed,
        method=chosen,
        levels=options.levels,
        table=study.folder / options.table if options.table is not None else None,
        existing=np.array([point for point, _ in stored]) if stored else None,
        constraints=[constraint.build() for constraint in options.constraint],
    )
    return _joined(study, stored, new) if stored else new


def _stored(study: Study) -> list[tuple[FloatArray, Mapping[str, float]]]:
    """Point and parameters of every stored design of the space, failed ones too."""
    if not study.store.is_file():
        return []
    with read_store(study.store) as store:
        records = [(place(r.parameters, study.space, study.axle), r.parameters) for r in store.records()]
    return [(point, parameters) for point, parameters in records if point is not None]


def _joined(study: Study, stored: Sequence[tuple[FloatArray, Mapping[str, float]]], new: Design) -> Design:
    """Stored designs with the digits they are stored with, so that none is run again, then the new ones."""
    rows = [[kept.get(p, parameter_value(study.axle, p)) for p in new.paths] for _, kept in stored]
    labels = [f"stored {i + 1}" for i in range(len(rows))]
    return replace(new, values=np.vstack([rows, new.values]), labels=(*labels, *new.labels))


def run_sample(
    study: Study,
    design: Design,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    stored_curves: StoredCurves = "all",
    progress: Callable[[int], None] = lambda _: None,
) -> SampleResult:
    """Every design of the sample evaluated, by the study's solver into the study's store.

    stored_curves: what is kept of new designs beside their characteristics.
    """
    started = time.perf_counter()
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    with Campaign(
        solver,
        study.store,
        workers=workers,
        scheduler=scheduler,
        retry_failed=retry_failed,
        stored_curves=stored_curves,
    ) as campaign:
        outcomes = campaign.evaluate(list(design.rows()), f"sample:{design.method}", progress, curves=False)
    return SampleResult(design, tuple(outcomes), campaign.runs, time.perf_counter() - started)


def write_sample(study: Study, sampled: SampleResult, folder: Path, form: Format | None = None) -> list[Path]:
    """designs.csv of the sample; with a format also designs.parquet and the whole store, curves included."""
    frame = designs_frame(list(sampled.design.rows()), sampled.outcomes)
    frame.insert(0, "label", list(sampled.design.labels))
    written = [write_table(folder / "designs.csv", frame)]
    if form == "parquet":
        written.append(write_table(folder / "designs.parquet", frame))
    if form is not None:
        with read_store(study.store) as store:
            written += export_store(store, folder, form, study.windows)
    return written


def reasons(outcomes: Sequence[Outcome]) -> list[tuple[int, str]]:
    """How often each kind of failure, the most frequent first; alike but for numbers is one kind.

    The reason given is the first of its kind.
    """
    kinds = [NUMBER.sub("#", o.reason) for o in outcomes]
    first = {kind: o.reason for kind, o in reversed(list(zip(kinds, outcomes, strict=True)))}
    return [(count, first[kind]) for kind, count in Counter(kinds).most_common()]


def sample_document(study: Study, sampled: SampleResult) -> dict[str, Any]:
    """Counts, reasons of failures, and low, mean, high of each characteristic.

    `{"method", "n", "seed", "runs", "kept", "failed", "reasons", "characteristics", "store", "seconds"}`.
    """
    spans = sampled.spans
    return {
        "method": sampled.design.method,
        "n": len(sampled.outcomes),
        "seed": sampled.design.seed,
        "runs": sampled.runs,
        "kept": sampled.kept,
        "failed": len(sampled.failed),
        "reasons": [{"count": count, "reason": reason} for count, reason in reasons(sampled.failed)],
        "characteristics": dict(zip((s.entry.id for s in spans.rows), table_records(spans), strict=True)),
        "store": str(study.store),
        "seconds": sampled.seconds,
    }


def sample_lines(sampled: SampleResult) -> list[str]:
    """For a terminal: the span of every characteristic, the reasons of failures, the counts."""
    return [
        *table_lines(sampled.spans),
        *(f"{count} x {reason}" for count, reason in reasons(sampled.failed)),
        f"{len(sampled.outcomes)} designs ({sampled.design.method}): {sampled.counts}",
    ]
