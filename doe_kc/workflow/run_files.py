"""Files of a run: what each step of the chain leaves in the study's folder as soon as it is done."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.discovery.result import Discovery
from doe_kc.measurement import Measurement
from doe_kc.reports.simulation.tables import write_simulation
from doe_kc.solver.result import Solution
from doe_kc.study import Study
from doe_kc.targets.comparison import Comparison
from doe_kc.workflow.answer import Answer, write_answer
from doe_kc.workflow.compare import write_comparison
from doe_kc.workflow.influence import StudyInfluence, write_influence
from doe_kc.workflow.measure import Reduced, write_reduced
from doe_kc.workflow.rebuild import write_chain
from doe_kc.workflow.twin_discovery import DiscoveryGround
from doe_kc.workflow.write_correlation import write_correlation
from doe_kc.workflow.write_discovery import write_discovery


class RunFiles:
    """Writes the steps of a run under `study.out`, a folder a step.

    enabled: False to write nothing. paths: what was written so far, but for the
    record run.json. Every method raises RunError when the
    folder cannot be written.
    """

    def __init__(self, study: Study, *, enabled: bool = True, workers: int | None = None) -> None:
        self.study, self.enabled, self.workers = study, enabled, workers
        self.paths: list[Path] = []

    def simulation(self, solution: Solution) -> None:
        """The axle as handed in, in `simulate`."""
        self._keep(lambda: write_simulation(solution, self.study.out / "simulate"))

    def reduction(self, reduced: Reduced) -> None:
        """The rig records, in `reduce`."""
        folder, pictures = self.study.out / "reduce", self.study.pictures
        self._keep(lambda: write_reduced(reduced, folder, workers=self.workers, pictures=pictures))

    def influence(self, influence: StudyInfluence) -> None:
        """The influence study, in `influence`."""
        folder = self.study.out / "influence"
        self._keep(lambda: write_influence(self.study, influence, folder, workers=self.workers))

    def discovery(self, discovery: Discovery, ground: DiscoveryGround) -> None:
        """What the axle lacks, in `discover`."""
        folder, records = self.study.out / "discover", ground.records
        self._keep(lambda: write_discovery(ground.study, discovery, records, folder, workers=self.workers))

    def correlation(self, answer: Answer, record: AnswerRecord, measurement: Measurement) -> None:
        """The correlated axle, in `correlate`; run.json before the rest, so that `report` can mend that."""
        folder = self.study.out / "correlate"
        if self.enabled:
            write_chain(answer, record, folder)
        self._keep(
            lambda: write_correlation(
                self.study,
                answer.correlation,
                measurement,
                folder,
                assessment=answer.assessment,
                workers=self.workers,
            )
        )

    def comparison(self, comparison: Comparison) -> None:
        """The correlated axle beside the records, in `compare`."""
        folder, pictures = self.study.out / "compare", self.study.pictures
        self._keep(lambda: write_comparison(comparison, folder, workers=self.workers, pictures=pictures))

    def answer(self, answer: Answer, record: AnswerRecord, measurement: Measurement) -> None:
        """axle.toml, summary.json and index.html, and the record with the time of the whole run."""
        if self.enabled:
            write_chain(answer, record, self.study.out / "correlate")
        self._keep(
            lambda: write_answer(self.study, answer.correlation, answer.assessment, record, measurement)
        )

    def _keep(self, write: Callable[[], list[Path]]) -> None:
        if self.enabled:
            self.paths += write()
