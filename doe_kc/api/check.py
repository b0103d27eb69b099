"""Check: what any function would refuse of a study, before one of them runs."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.api.frame_result import FrameResult
from doe_kc.study import Study
from doe_kc.workflow.check import StudyCheck, check_lines, check_read_study, check_study

if TYPE_CHECKING:
    import pandas as pd

FAULT_COLUMNS = ("severity", "kind", "where", "message")


@dataclass(frozen=True, repr=False, eq=False)
class CheckResult(FrameResult):
    """Faults of a study; there is nothing to draw. check: study, rig manifest, errors, warnings as data."""

    check: StudyCheck

    @property
    def sound(self) -> bool:
        """Whether there is no error; warnings may remain."""
        return not self.check.errors

    @property
    def study(self) -> Study | None:
        """The study; None where its file or its axle cannot be read."""
        return self.check.study

    @property
    def errors(self) -> pd.DataFrame:
        """One row a fault that some function refuses: kind, where (file, record or key), message."""
        return self._rows("error")

    @property
    def warnings(self) -> pd.DataFrame:
        """The same of what is sound and still worth a look."""
        return self._rows("warning")

    def _rows(self, severity: str) -> pd.DataFrame:
        frame = self.to_frame()
        return frame[frame["severity"] == severity].drop(columns="severity").reset_index(drop=True)

    def to_frame(self) -> pd.DataFrame:
        """One row a fault, errors first: severity ("error", "warning"), kind (study, axle, solver, method,
        variables, targets, sampling, surrogates, measurement, record, setup, out), where, message."""
        import pandas as pd

        faults = [("error", f) for f in self.check.errors] + [("warning", f) for f in self.check.warnings]
        return pd.DataFrame(
            [(severity, f.kind, f.where, f.message) for severity, f in faults], columns=list(FAULT_COLUMNS)
        )

    @property
    def lines(self) -> list[str]:
        """Counts, then what the study names, or why it cannot be read."""
        errors, warnings = len(self.check.errors), len(self.check.warnings)
        head = "all sound" if self.sound else f"{errors} error{'s' * (errors > 1)}"
        if warnings:
            head += f", {warnings} warning{'s' * (warnings > 1)}"
        return [head, *check_lines(self.check), *(f.message for f in self.check.errors[:3])]


def check(
    study: Study | str | PathLike[str],
    *,
    measurement: str | PathLike[str] | None = None,
    out: str | PathLike[str] | None = None,
) -> CheckResult:
    """Every fault of a study, its axle and its rig records that can be told without solving anything.

    study: a `Study`, its file or its folder. measurement, out: in place of the study's own, where a path is
    given. Nothing is run or written.

    Raises nothing for bad input: each fault is a row of the result, with the sentence that another function
    would raise.

    >>> result = kc.check("examples/front_axle")
    >>> result.sound, len(result.errors)
    (True, 0)
    >>> kc.check("examples/no_such_folder").errors.loc[0, "kind"]
    'study'
    """
    if isinstance(study, Study):
        return CheckResult(check_read_study(study))
    return CheckResult(
        check_study(
            Path(study),
            measurement=None if measurement is None else Path(measurement),
            out=None if out is None else Path(out),
        )
    )
