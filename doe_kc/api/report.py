"""Report: the last correlation or run of a study, read back from its folder."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.api.comparison import ComparisonResult
from doe_kc.api.correlation import CorrelationResult
from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import as_study
from doe_kc.axle import Axle
from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.correlation.assessment import Status
from doe_kc.study import Study
from doe_kc.workflow.answer import answer_lines
from doe_kc.workflow.rebuild import Rebuilt, rebuild, write_rebuilt

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class ReportResult(FrameResult):
    """A correlation, or the answer of a run, as its folder holds it, rated by the study's present weights.
    rebuilt: the data of it."""

    study: Study
    rebuilt: Rebuilt

    @cached_property
    def correlation(self) -> CorrelationResult:
        """As `correlate` or `run` returned it."""
        recalled = self.rebuilt.recalled
        return CorrelationResult(
            self.study, recalled.correlation, recalled.assessment, self.rebuilt.measurement
        )

    @property
    def comparison(self) -> ComparisonResult | None:
        """Of the correlated axle; None where no run is stored."""
        comparison = self.rebuilt.comparison
        return None if comparison is None else ComparisonResult(self.study, comparison)

    @property
    def record(self) -> AnswerRecord | None:
        """What is kept of the answer: verdict, effects, gap, seconds; None where no run is stored."""
        return self.rebuilt.recalled.answer

    @property
    def status(self) -> Status:
        """sound, doubtful or not_usable."""
        return self.correlation.status

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why, in sentences; for a sound axle what was checked."""
        return self.correlation.reasons

    @property
    def axle(self) -> Axle:
        """The axle to use."""
        return self.correlation.axle

    @property
    def characteristics(self) -> pd.DataFrame:
        """As `CorrelationResult.characteristics`."""
        return self.correlation.characteristics

    @property
    def parameters(self) -> pd.DataFrame:
        """As `CorrelationResult.parameters`."""
        return self.correlation.parameters

    def to_frame(self) -> pd.DataFrame:
        """`characteristics`."""
        return self.characteristics

    @property
    def lines(self) -> list[str]:
        """Status, and of a run effects and gap, of a correlation what was done."""
        record = self.record
        if record is None:
            return self.correlation.lines
        return answer_lines(self.correlation.assessment, record)

    def plot(self, ax: Axes | None = None) -> Axes:
        """As `CorrelationResult.plot`."""
        return self.correlation.plot(ax)

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc report` writes: `out`/correlate, and of a run `out`/compare and the answer at the top;
        returns the paths."""
        return write_rebuilt(replace(self.study, out=Path(out)), self.rebuilt, workers=workers)


def report(
    study: Study | str | PathLike[str],
    *,
    out: str | PathLike[str] | None = None,
    workers: int | None = None,
) -> ReportResult:
    """The last correlation or run that a folder holds, with the study's present targets and weights; no
    design is solved again.

    out: the folder, as of `correlate(out=...)` or `run(out=...)`; what `doe-kc report --out` writes is
    written there. By default the study's own is read and nothing written. workers: processes that draw.

    Raises InputError where the folder holds no correlation, its record is damaged, or its store is that of
    another axle or solver.

    >>> done = kc.correlate("examples/front_axle", method="gauss_newton", budget=5, out="done", workers=1)
    >>> again = kc.report("examples/front_axle", out="done")
    >>> again.status == done.status, again.characteristics["final"].equals(done.characteristics["final"])
    (True, True)
    """
    chosen = as_study(study)
    kept = chosen if out is None else replace(chosen, out=Path(out))
    result = ReportResult(chosen, rebuild(kept))
    if out is not None:
        result.write(out, workers=workers)
    return result
