"""Run: the whole chain, and the one axle that it hands over."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path

from doe_kc.api.comparison import ComparisonResult
from doe_kc.api.correlation import CorrelatedAxle, CorrelationResult, correlation_of
from doe_kc.api.discovery import DiscoveryResult, discovery_of
from doe_kc.api.influence import InfluenceResult, influence_of
from doe_kc.api.measurement import ReductionResult
from doe_kc.api.simulation import SimulationResult
from doe_kc.api.studies import Progress, as_study, stored
from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.correlation.result import Correlation
from doe_kc.discovery.result import Discovery
from doe_kc.measurement import Measurement
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.study import Study
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.answer import Answer, answer_lines
from doe_kc.workflow.chain import Chain, Steps, run_chain, write_chain_files
from doe_kc.workflow.influence import StudyInfluence
from doe_kc.workflow.measure import Reduced
from doe_kc.workflow.run_files import RunFiles


@dataclass(frozen=True, repr=False, eq=False)
class RunResult(CorrelatedAxle):
    """What `doe-kc run` finds. chain: the data of every step."""

    study: Study
    chain: Chain

    @cached_property
    def simulation(self) -> SimulationResult:
        """Of the axle as handed in."""
        return SimulationResult(self.study.axle, self.chain.solution, self.chain.solving_seconds)

    @cached_property
    def reduction(self) -> ReductionResult:
        """Of the rig records."""
        return ReductionResult(self.study, self.chain.reduced, self.chain.solution)

    @cached_property
    def influence(self) -> InfluenceResult:
        """One at a time, of the axle as handed in."""
        return InfluenceResult(self.study, self.chain.influence)

    @cached_property
    def discovery(self) -> DiscoveryResult | None:
        """What the axle lacked; None where it was not looked for (an outside solver of another car)."""
        discovery = self.chain.answer.discovery
        if discovery is None:
            return None
        ground = self.chain.answer.ground
        if ground is not None:
            return DiscoveryResult(ground.study, discovery, ground.records)
        return DiscoveryResult(self.study, discovery, self.chain.reduced.measurement)

    @cached_property
    def correlation(self) -> CorrelationResult:
        """Of the axle with the effects adopted."""
        answer = self.chain.answer
        records = self.chain.reduced.measurement
        return CorrelationResult(self.study, answer.correlation, answer.assessment, records)

    @cached_property
    def comparison(self) -> ComparisonResult:
        """Of the correlated axle."""
        return ComparisonResult(self.study, self.chain.comparison)

    @property
    def answer(self) -> Answer:
        """Correlation, discovery and adoption as the chain left them."""
        return self.chain.answer

    @property
    def record(self) -> AnswerRecord:
        """What is kept of the answer: verdict, effects, gap, seconds."""
        return self.chain.record

    @property
    def lines(self) -> list[str]:
        """Status, effects added, gap."""
        return answer_lines(self.answer.assessment, self.record)

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc run` writes in `out`: the answer (axle.toml, summary.json, index.html) and a folder a
        step; returns the paths. `doe-kc report` needs the store beside, which `run(out=...)` keeps."""
        files = RunFiles(replace(self.study, out=Path(out)), workers=workers)
        write_chain_files(self.chain, files)
        return files.paths


def run(
    study: Study | str | PathLike[str],
    *,
    out: str | PathLike[str] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> RunResult:
    """The whole chain: reduce, influence, discover, add what is missing, correlate; one axle and its status.

    out: folder for what `doe-kc run --out` writes, each step's files when it is done, and of the store from
    which the same call goes on after an interruption; by default nothing is written (but an outside solver's
    answers always go to the study's store). workers:
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
    chosen = as_study(study)

    def influence(of: Study, measurement: Measurement) -> StudyInfluence:
        return influence_of(of, measurement, workers=workers, progress=progress).influence

    def discover(of: Study, measurement: Measurement) -> Discovery:
        return discovery_of(of, measurement, workers=workers, progress=progress).discovery

    def correlate(
        of: Study, reduced: Reduced, adoption: Adoption | None, selection: Selection | None
    ) -> Correlation:
        return correlation_of(
            of,
            reduced,
            progress,
            adoption=adoption,
            selection=selection,
            workers=workers,
            scheduler=scheduler,
        ).correlation

    with stored(chosen, out) as kept:
        files = RunFiles(kept, enabled=out is not None, workers=workers)
        chain = run_chain(kept, Steps(influence, discover, correlate), files)
    return RunResult(chosen, chain)
