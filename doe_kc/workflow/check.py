"""Check: what any command would refuse of a study, collected before one of them runs."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from doe_kc.axle.plausibility import axle_warnings
from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_one
from doe_kc.correlation.methods import check_method
from doe_kc.curves import CurveSet
from doe_kc.ground.errors import DoeKcError, InputError, RunError
from doe_kc.measurement import Manifest, load_manifest
from doe_kc.measurement.branches import RunCurves, reduce_case
from doe_kc.measurement.reduction import case_records, check_window_points, measured_cases, measured_curves
from doe_kc.sampling._base import find_sampler
from doe_kc.study import Study, read_study
from doe_kc.targets.build import first, last
from doe_kc.targets.comparison.interval import constraint_interval
from doe_kc.workflow.rig_checks import axle_curves, rig_findings
from doe_kc.workflow.setup import setup_differences


@dataclass(frozen=True)
class Fault:
    """where: file, record or key. kind: study, solver, method, variables, targets, sampling, surrogates,
    measurement, record, setup, out, or that of a finding on the records. message: the whole sentence.
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


def check_study(path: Path, *, measurement: Path | None = None, out: Path | None = None) -> StudyCheck:
    """Every fault of a study that can be told without fitting anything.

    measurement, out: in place of the study's own. Faults that do not follow from one another are all told;
    of a study file or an axle that cannot be read, the first.
    """
    try:
        study = read_study(path, measurement=measurement, out=out)
    except InputError as error:
        return StudyCheck(None, None, (_fault("study", str(error)),), ())
    collect = _Collector()
    manifest, curves = _check_measurement(study, collect)
    _check_work(study, collect)
    intervals = list(_stated_intervals(study, curves))
    for sentence in (*_empty(study, intervals), *_aimless_constraints(study, manifest)):
        collect.errors.append(_fault("targets", sentence))
    collect("out", lambda: _check_out(study.out))
    collect("out", lambda: _check_store(study))
    warnings = (*collect.warnings, *_warnings(study, manifest), *_missed_targets(study, intervals))
    return StudyCheck(study, manifest, tuple(collect.errors), warnings)


def _fault(kind: str, message: str) -> Fault:
    return Fault(message.split(": ", 1)[0], kind, message)


def _check_measurement(study: Study, collect: _Collector) -> tuple[Manifest | None, CurveSet | None]:
    """The manifest, and the measured curves of the load cases that have no fault."""
    if study.measurement is None:
        if study.variables.use == "selection":
            sentence = 'variables: use = "selection" needs a measurement; name one, or use = ["*"].'
            collect.errors.append(_fault("variables", f"{study.source}: {sentence}"))
        if study.correlation.set_first:
            sentence = "correlation.set_first needs a measurement; name one or drop the key."
            collect.errors.append(_fault("measurement", f"{study.source}: {sentence}"))
        return None, None
    path = study.measurement / "test.toml" if study.measurement.is_dir() else study.measurement
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
    for model in study.surrogates.models:
        from doe_kc.surrogates.models import make

        collect("surrogates", lambda model=model: make(model))  # type: ignore[misc]


@dataclass(frozen=True)
class _StatedInterval:
    """A constraint of which the study types an end, the other end that of equations 5.1 and 5.2; nan where
    there is no target to take it from. aimed: whether the rating counts the distance to the target."""

    entry: Characteristic
    target: float
    low: float
    high: float
    aimed: bool

    @property
    def words(self) -> str:
        return f"[{self.low:g}, {self.high:g}] {self.entry.unit}"


def _stated_intervals(study: Study, curves: CurveSet | None) -> Iterator[_StatedInterval]:
    """About typed targets, else about those measured."""
    for ident, entry in CHARACTERISTICS.items():
        own = [o for o in study.characteristics if fnmatchcase(ident, o.match)]
        if last(own, "low") is None and last(own, "high") is None:
            continue
        target = last(own, "target")
        if target is None and curves is not None:
            target = reduce_one(entry, curves, window=study.windows.get(entry.load_case))
        implied = constraint_interval(first(target, math.nan))
        yield _StatedInterval(
            entry,
            first(target, math.nan),
            first(last(own, "low"), implied[0]),
            first(last(own, "high"), implied[1]),
            first(last(own, "objective"), entry.objective) and first(last(own, "goal"), "target") == "target",
        )


def _empty(study: Study, intervals: Sequence[_StatedInterval]) -> Iterator[str]:
    """Intervals whose low is not below high."""
    for interval in intervals:
        if interval.low >= interval.high:
            yield (
                f"{study.source}: characteristics {interval.entry.id}: the interval {interval.words} is "
                "empty; low must be below high."
            )


def _missed_targets(study: Study, intervals: Sequence[_StatedInterval]) -> Iterator[Fault]:
    """Targets that their own interval excludes: a correlation ends between the two."""
    for interval in intervals:
        low, high, target = interval.low, interval.high, interval.target
        if interval.aimed and low < high and (target < low or target > high):
            yield _fault(
                "targets",
                f"{study.source}: characteristics {interval.entry.id}: the interval {interval.words} does "
                f"not hold the target {target:g}, so that no design meets both; correct low and high, or "
                "give objective = false.",
            )


def _aimless_constraints(study: Study, manifest: Manifest | None) -> Iterator[str]:
    """Constraints of which nothing that they match is measured or typed."""
    cases = {"static", *(manifest.records if manifest is not None else ())}
    for option in study.characteristics:
        stated = option.constraint or option.low is not None or option.high is not None
        matched = [e for i, e in CHARACTERISTICS.items() if fnmatchcase(i, option.match)]
        typed = any(
            o.target is not None and any(fnmatchcase(e.id, o.match) for e in matched)
            for o in study.characteristics
        )
        if stated and not typed and not any(e.load_case in cases for e in matched):
            yield (
                f"{study.source}: characteristics: match = {option.match!r} states a constraint, but no "
                "record is of its load case and no target is given; add target = VALUE or the record, or "
                "drop the entry."
            )


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
    if manifest is not None:
        for sentence in setup_differences(study.axle, manifest):
            yield _fault("setup", sentence)
    elif study.measurement is None and all(c.target is None for c in study.characteristics):
        yield _fault(
            "targets",
            f"{study.source}: names neither a measurement nor a typed target; correlate, discover and reduce "
            "need one.",
        )
