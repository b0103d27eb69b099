"""Run: the whole chain, and the one axle that it hands over."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.api.comparison import ComparisonResult
from doe_kc.api.correlation import CorrelationResult, correlation_of
from doe_kc.api.discovery import DiscoveryResult, discovery_of
from doe_kc.api.frame_result import FrameResult
from doe_kc.api.influence import InfluenceResult, influence_of
from doe_kc.api.measurement import ReductionResult
from doe_kc.api.simulation import SimulationResult, simulate
from doe_kc.api.studies import Progress, as_study, stored
from doe_kc.axle import Axle
from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.correlation.assessment import Status
from doe_kc.correlation.result import Correlation
from doe_kc.discovery.result import Discovery
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.answer import Answer, answer_lines, answer_record
from doe_kc.workflow.chain import Steps, follow_chain
from doe_kc.workflow.compare import compare_model
from doe_kc.workflow.measure import Reduced, reduce_records
from doe_kc.workflow.reload_correlation import write_chain
from doe_kc.workflow.write_answer import write_answer

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class RunResult(FrameResult):
    """What `doe-kc run` finds. simulation: of the axle as handed in; reduction: the rig records; influence:
    one at a time; discovery: what the axle lacked, None where it was not looked for (an outside solver of
    another car); correlation: of the axle with the effects adopted; comparison: of the correlated axle.
    answer, record: the chain's own data."""

    study: Study
    simulation: SimulationResult
    reduction: ReductionResult
    influence: InfluenceResult
    discovery: DiscoveryResult | None
    correlation: CorrelationResult
    comparison: ComparisonResult
    answer: Answer
    record: AnswerRecord

    @property
    def status(self) -> Status:
        """sound, doubtful or not_usable."""
        return self.answer.assessment.status

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why, in sentences; for a sound axle what was checked."""
        return self.answer.assessment.reasons

    @property
    def axle(self) -> Axle:
        """The axle to use: with the effects that it lacked, correlated."""
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
        """Status, effects added, gap."""
        return answer_lines(self.answer.assessment, self.record)

    def plot(self, ax: Axes | None = None) -> Axes:
        """As `CorrelationResult.plot`."""
        return self.correlation.plot(ax)

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc run` writes in `out`: the answer (axle.toml, summary.json, index.html) and a folder a
        step; returns the paths. `doe-kc report` needs the store beside, which `run(out=...)` keeps."""
        folder, study = Path(out), replace(self.study, out=Path(out))
        written = self.simulation.write(folder / "simulate")
        written += self.reduction.write(folder, workers=workers)
        written += self.influence.write(folder, workers=workers)
        if self.discovery is not None:
            written += self.discovery.write(folder, workers=workers)
        written += self.correlation.write(folder, workers=workers)
        written += self.comparison.write(folder, workers=workers)
        measurement = self.reduction.reduced.measurement
        correlation, assessment = self.correlation.correlation, self.answer.assessment
        written += write_answer(study, correlation, assessment, self.record, measurement)
        return written


def run(
    study: Study | str | PathLike[str],
    *,
    out: str | PathLike[str] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> RunResult:
    """The whole chain: reduce, influence, discover, add what is missing, correlate; one axle and its status.

    out: folder for what `doe-kc run --out` writes, its store among it, from which the same call goes on; by
    default nothing is written (but an outside solver's answers always go to the study's store). workers:
    processes, one per core by default. scheduler: address of a Dask scheduler, for the correlation. progress:
    called with (what, steps done, of how many about).

    An axle that is not usable is returned like any other: look at `status`. Raises InputError for a study or
    record that is wrong, RunError where the axle has no equilibrium.

    >>> result = kc.run("examples/front_axle", workers=1)
    >>> result.status, result.discovery.verdict
    ('sound', 'named')
    >>> result.axle
    Axle('Front axle, McPherson', effects: hub_compliance)
    """
    started = time.perf_counter()
    chosen = as_study(study)
    chosen.measured()
    simulation = simulate(chosen.axle)
    reduced = reduce_records(chosen, simulation.solution)
    influence = influence_of(chosen, reduced.measurement, workers=workers, progress=progress)

    def discovered(of: Study, measurement: Measurement) -> Discovery:
        return discovery_of(of, measurement, workers=workers, progress=progress).discovery

    def correlated(of: Study, records: Reduced, adoption: Adoption | None) -> Correlation:
        return correlation_of(
            of,
            records,
            adoption=adoption,
            selection=influence.influence.selection,
            workers=workers,
            scheduler=scheduler,
            progress=progress,
        ).correlation

    with stored(chosen, out) as kept:
        answer = follow_chain(kept, reduced, Steps(discover=discovered, correlate=correlated))
    measurement = reduced.measurement
    curves = answer.correlation.best.outcome.curves or simulation.curve_set
    result = RunResult(
        study=chosen,
        simulation=simulation,
        reduction=ReductionResult(chosen, reduced, simulation.solution),
        influence=influence,
        discovery=None
        if answer.discovery is None
        else DiscoveryResult(chosen, answer.discovery, measurement),
        correlation=CorrelationResult(chosen, answer.correlation, answer.assessment, measurement),
        comparison=ComparisonResult(chosen, compare_model(chosen, curves, measurement)),
        answer=answer,
        record=answer_record(answer, time.perf_counter() - started),
    )
    if out is not None:
        write_chain(answer, result.record, Path(out) / "correlate")
        result.write(out, workers=workers)
    return result
