"""Rebuild: the last correlation or run of a study, read back and written anew; nothing is solved again."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.targets.comparison import Comparison
from doe_kc.workflow.answer import answer_lines, write_answer
from doe_kc.workflow.compare import compare_model, write_comparison
from doe_kc.workflow.measure import study_records
from doe_kc.workflow.reload_correlation import Recalled, recall
from doe_kc.workflow.write_correlation import correlation_lines, write_correlation


@dataclass(frozen=True)
class Rebuilt:
    """recalled: correlation, its assessment with the study's present weights, and the record of its run.
    measurement: the rig records, None with typed targets only. comparison: of the correlated axle, None where
    the solver gave no curves or the correlation was no part of a run."""

    recalled: Recalled
    measurement: Measurement | None
    comparison: Comparison | None

    @property
    def is_run(self) -> bool:
        """Whether there is an answer to write at the top of the folder."""
        return self.recalled.answer is not None and self.measurement is not None

    @property
    def lines(self) -> list[str]:
        """For a terminal: the answer of a run, then the correlation; of a correlation alone that."""
        correlation, assessment = self.recalled.correlation, self.recalled.assessment
        lines = correlation_lines(correlation, assessment)
        record = self.recalled.answer
        return lines if record is None else [*answer_lines(assessment, record), *lines[1:]]


def rebuild(study: Study) -> Rebuilt:
    """What `study.out` holds of a correlation. InputError where there is none, or as `recall`."""
    reduced = study_records(study)
    recalled = recall(study, reduced, study.out / "correlate")
    measurement = None if reduced is None else reduced.measurement
    curves = recalled.correlation.best.outcome.curves
    comparison = None
    if recalled.answer is not None and measurement is not None and curves is not None:
        comparison = compare_model(study, curves, measurement)
    return Rebuilt(recalled, measurement, comparison)


def write_rebuilt(study: Study, rebuilt: Rebuilt, *, workers: int | None = None) -> list[Path]:
    """The files of `correlate`, and of a run also `compare` and the answer, in `study.out`; their paths.

    RunError when the folder cannot be written.
    """
    correlation, assessment = rebuilt.recalled.correlation, rebuilt.recalled.assessment
    record, measurement = rebuilt.recalled.answer, rebuilt.measurement
    folder = study.out / "correlate"
    written = write_correlation(
        study, correlation, measurement, folder, assessment=assessment, workers=workers
    )
    if rebuilt.comparison is not None:
        written += write_comparison(
            rebuilt.comparison, study.out / "compare", workers=workers, pictures=study.pictures
        )
    if record is not None and measurement is not None:
        written += write_answer(study, correlation, assessment, record, measurement)
    return written
