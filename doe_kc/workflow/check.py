"""Check: what any command would refuse of a study, collected before one of them runs."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from doe_kc.axle.plausibility import axle_warnings
from doe_kc.correlation.methods import check_method
from doe_kc.curves import CurveSet
from doe_kc.ground.errors import DoeKcError, InputError, RunError
from doe_kc.measurement import Manifest, Measurement, load_manifest, reduce_cars
from doe_kc.measurement.branches import RunCurves, reduce_case
from doe_kc.measurement.reduction import case_records, check_window_points, measured_cases, measured_curves
from doe_kc.sampling._base import find_sampler
from doe_kc.study import Study, read_study
from doe_kc.workflow.check_targets import (
    aimless_constraints,
    empty_intervals,
    missed_targets,
    stated_intervals,
)
from doe_kc.workflow.rig_checks import axle_curves, rig_findings
from doe_kc.workflow.setup import setup_differences
from doe_kc.workflow.twin_check import twin_differences


@dataclass(frozen=True)
class Fault:
    """where: file, record or key. kind: study, solver, method, variables, targets, sampling, surrogates,
    tolerance, measurement, record, setup, twin, out, or that of a finding on the records. message: the whole
    sentence.
    """

    where: str
    kind: str
    message: str


@dataclass(frozen=True)
class StudyCheck:
    """study: None when it cannot be read. manifest: None without a measurement that can be read.
    errors: what some command refuses. warnings: what is sound and still worth a look.
    """

    study: Study | None
    manifest: Manifest | None
    errors: tuple[Fault, ...]
    warnings: tuple[Fault, ...]

    @property
    def document(self) -> dict[str, object]:
        """`{"errors": [{"where", "kind", "message"}], "warnings": [...]}`."""
        return {"errors": [asdict(e) for e in self.errors], "warnings": [asdict(w) for w in self.warnings]}


class _Collector:
    def __init__(self) -> None:
        self.errors: list[Fault] = []
        self.warnings: list[Fault] = []

    def __call__(self, kind: str, check: Callable[[], object]) -> bool:
        """Whether the check passes."""
        try:
            check()
        except DoeKcError as error:
            self.errors.append(_fault(kind, str(error)))
            return False
        return True


def check_study(
    path: Path, *, measurement: Path | Sequence[Path] | None = None, out: Path | None = None
) -> StudyCheck:
    """Every fault of a study file that can be told without fitting anything.

    measurement, out: in place of the study's own. Of a study file or an axle that cannot be read, the first
    fault; of others as `check_read_study`.
    """
    try:
        study = read_study(path, measurement=measurement, out=out)
    except InputError as error:
        return StudyCheck(None, None, (_fault("study", str(error)),), ())
    return check_read_study(study)


def check_read_study(study: Study) -> StudyCheck:
    """Every fault of a study that was read. Those that do not follow from one another are all told."""
    collect = _Collector()
    manifest, curves = _check_measurement(study, collect)
    _check_work(study, collect)
    intervals = list(stated_intervals(study, curves))
    for sentence in (*empty_intervals(study, intervals), *aimless_constraints(study, manifest)):
        collect.errors.append(_fault("targets", sentence))
    collect("out", lambda: _check_out(study.out))
    collect("out", lambda: _check_store(study))
    missed = (_fault("targets", sentence) for sentence in missed_targets(study, intervals))
    warnings = (*collect.warnings, *_warnings(study, manifest), *missed)
    return StudyCheck(study, manifest, tuple(collect.errors), warnings)


def _fault(kind: str, message: str) -> Fault:
    return Fault(message.split(": ", 1)[0], kind, message)


def _check_measurement(study: Study, collect: _Collector) -> tuple[Manifest | None, CurveSet | None]:
    """The manifest, and the measured curves of the load cases that have no fault; of several cars without
    fault those of their mean."""
    if study.measurement is None:
        if study.variables.use == "selection":
            sentence = 'variables: use = "selection" needs a measurement; name one, or use = ["*"].'
            collect.errors.append(_fault("variables", f"{study.source}: {sentence}"))
        if study.correlation.set_first:
            sentence = "correlation.set_first needs a measurement; name one or drop the key."
            collect.errors.append(_fault("measurement", f"{study.source}: {sentence}"))
        return None, None
    cars = [_check_car(study, path, collect) for path in study.measurements]
    if len(cars) == 1 or collect.errors:
        return cars[0]
    mean: list[Measurement] = []

    def reduced() -> None:
        mean.append(reduce_cars(study.measurements, windows=study.windows, half_track=study.axle.half_track))

    return (mean[0].manifest, mean[0].curves) if collect("measurement", reduced) else cars[0]


def _check_car(study: Study, folder: Path, collect: _Collector) -> tuple[Manifest | None, CurveSet | None]:
    path = folder / "test.toml" if folder.is_dir() else folder
    try:
        manifest = load_manifest(path)
    except InputError as error:
        collect.errors.append(_fault("measurement", str(error)))
        return None, None
    runs: dict[str, tuple[RunCurves, ...]] = {}
    for case in measured_cases(manifest):
        collect("record", lambda case=case: runs.update(_checked_case(study, path, manifest, case)))  # type: ignore[misc]
    for finding in rig_findings(path, manifest, runs, axle_curves(study.axle)):
        fault = Fault(finding.where, finding.kind, finding.message)
        (collect.errors if finding.severity == "error" else collect.warnings).append(fault)
    if not set(manifest.records) & set(study.axle.load_cases):
        sentence = "no load case of the records is among the axle's; expected one of "
        collect.errors.append(
            _fault("measurement", f"{study.source}: {sentence}{', '.join(study.axle.load_cases)}.")
        )
    for sentence in _unset(study, manifest):
        collect.errors.append(_fault("measurement", f"{study.source}: correlation.set_first: {sentence}"))
    return manifest, measured_curves(manifest, runs, study.axle.half_track)


def _checked_case(
    study: Study, path: Path, manifest: Manifest, case: str
) -> Mapping[str, tuple[RunCurves, ...]]:
    """Records read, branches told apart, enough points in the fit window; as `reduce` does it."""
    runs = {case: reduce_case(case_records(path, manifest, case))}
    curves = measured_curves(manifest, runs, study.axle.half_track)
    check_window_points(curves, study.windows)
    if case == "vertical" and case in study.axle.load_cases:
        from doe_kc.measurement.ride_height import vertical_curves

        vertical_curves(curves)
    return runs


def _unset(study: Study, manifest: Manifest) -> Iterator[str]:
    """What `set_first` asks of the records that they do not tell."""
    from doe_kc.measurement.reduction import static_angles

    angles = static_angles(manifest.alignment) or {}
    for path in study.correlation.set_first:
        if path == "ride_height" and "vertical" not in manifest.records:
            yield "ride_height needs a record of vertical motion; add it or drop the entry."
        if path.startswith("static.") and path.removeprefix("static.") not in angles:
            yield f"{path} needs [alignment] in the records' test.toml; add it or drop the entry."


def _check_work(study: Study, collect: _Collector) -> None:
    """Methods, samplers, models and the outside solver that the study names."""
    known = collect(
        "method",
        lambda: check_method(study.correlation.method, source=f"{study.source}: correlation.method"),
    )
    if study.solver.command:
        from doe_kc.true_solver.make import solver_for
        from doe_kc.workflow.correlate import study_method

        collect("solver", lambda: solver_for(study.axle, study.solver, study.windows, study.folder))
        if known:
            collect("method", lambda: study_method(study))
    sampler = study.sampling.method
    if collect("sampling", lambda: find_sampler(sampler, f"{study.source}: sampling.method")) and sampler in (
        "table",
        "full_factorial",
    ):
        from doe_kc.workflow.sample import study_design

        collect("sampling", lambda: study_design(study, method=None, n=None))
    _check_tolerance(study, collect)
    for model in study.surrogates.models:
        from doe_kc.surrogate_models.models import make

        collect("surrogates", lambda model=model: make(model))  # type: ignore[misc]


def _check_tolerance(study: Study, collect: _Collector) -> None:
    """Scatter, correlations, requirements and cars that [tolerance] names."""
    from doe_kc.characteristics import characteristics_of
    from doe_kc.production_scatter.build import build_scatter
    from doe_kc.production_scatter.requirements import build_requirements
    from doe_kc.workflow.measured_cars import car_folders

    source, options = str(study.source), study.tolerance
    collect("tolerance", lambda: build_scatter(study.axle, options, source))
    entries = characteristics_of(study.axle)
    collect("tolerance", lambda: build_requirements(entries, options.requirement, None, source))
    collect("tolerance", lambda: car_folders(study))


def _check_out(out: Path) -> None:
    """That results can be written, by a file that vanishes; nothing is made that is not there."""
    place = out
    while not place.exists() and place != place.parent:
        place = place.parent
    try:
        with tempfile.TemporaryFile(dir=place):
            pass
    except OSError as error:
        raise InputError(
            f"{out}: results cannot be written there ({error.strerror}); choose a writable folder with --out "
            "or out = in the study."
        ) from None


def _check_store(study: Study) -> None:
    """That stored evaluations, where there are any, are of this axle and solver."""
    if study.store.is_file():
        from doe_kc.campaign.store import open_store
        from doe_kc.true_solver.make import solver_for

        solver = solver_for(study.axle, study.solver, study.windows, study.folder)
        with suppress(RunError), open_store(study.store, solver):  # a run under way is no fault
            pass


def _warnings(study: Study, manifest: Manifest | None) -> Iterator[Fault]:
    for sentence in axle_warnings(study.axle):
        yield Fault(str(study.axle_path), "axle", sentence)
    for sentence in twin_differences(study):
        yield _fault("twin", sentence)
    if manifest is not None:
        for sentence in setup_differences(study.axle, manifest):
            yield _fault("setup", sentence)
        if manifest.state.arb == "off" and study.solver.command:
            yield _fault(
                "setup",
                f"{manifest.name}: the anti-roll bar was off; the outside solver has to be run without it.",
            )
    elif study.measurement is None and all(c.target is None for c in study.characteristics):
        yield _fault(
            "targets",
            f"{study.source}: names neither a measurement nor a typed target; correlate, discover and reduce "
            "need one.",
        )


def check_lines(check: StudyCheck) -> list[str]:
    """What the study names, for a terminal; nothing of one that cannot be read."""
    study, manifest = check.study, check.manifest
    if study is None:
        return []
    if manifest is not None:
        count = sum(len(files) for files in manifest.records.values())
        records = f"{manifest.name}: {count} records, {len(manifest.records)} load cases"
    else:
        records = "none named" if study.measurement is None else f"{study.measurement}: cannot be read"
    return [
        f"study        {study.name} ({study.source})",
        f"axle         {study.axle.name} ({study.axle_path})",
        *([f"twin         {study.twin.name} ({study.twin_path})"] if study.twin is not None else []),
        f"load cases   {', '.join(study.axle.load_cases)}",
        f"effects      {', '.join(study.axle.effects) or 'none'}",
        f"parameters   {len(study.parameters)} selected",
        f"variables    {study.space.dimension}, method {study.correlation.method}",
        f"measurement  {records}",
        f"results      {study.out}",
    ]
