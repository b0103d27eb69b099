"""A study: what the user asks for, in one TOML file; the shortest names an axle and a measurement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from doe_kc.axle import Axle, Parameter, design_parameters
from doe_kc.axle.parameters import parameter_value
from doe_kc.axle_file import read_axle
from doe_kc.characteristics.reduction import FEWEST_POINTS
from doe_kc.correlation.options import CorrelationOptions
from doe_kc.discovery.options import DiscoveryOptions
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.fields import Positive, Strict
from doe_kc.ground.files import read_toml, validate
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.load_cases import LOAD_CASES
from doe_kc.measurement.manifest import RigState
from doe_kc.measurement.rig_state import axle_in_state, bar_values, rig_state
from doe_kc.parameter_influence.options import InfluenceOptions
from doe_kc.production_scatter.options import ToleranceOptions
from doe_kc.sampling.options import SamplingOptions
from doe_kc.surrogate_models.options import SurrogateOptions
from doe_kc.targets.options import CharacteristicOptions, CurveOptions, check_names
from doe_kc.true_solver.options import SolverOptions
from doe_kc.variables import Space, VariableOptions, build_space

STORES = "store"
"""Folder under `out` of the files that make a repetition quick."""


class StudyFile(Strict):
    """Paths are relative to the study file."""

    schema_: Literal["doe_kc.study/1"] = Field(default="doe_kc.study/1", alias="schema")
    name: str | None = None
    axle: str
    measurement: str | Annotated[list[str], Field(min_length=1)] | None = None
    out: str = "out"
    seed: Annotated[int, Field(ge=0)] = 1
    pictures: PictureFormat = PNG
    windows: dict[str, Positive] = Field(default={})
    influence: InfluenceOptions = InfluenceOptions()
    solver: SolverOptions = SolverOptions()
    variables: VariableOptions = VariableOptions()
    sampling: SamplingOptions = SamplingOptions()
    surrogates: SurrogateOptions = SurrogateOptions()
    characteristics: list[CharacteristicOptions] = Field(default=[])
    curves: list[CurveOptions] = Field(default=[])
    correlation: CorrelationOptions = CorrelationOptions()
    discovery: DiscoveryOptions = DiscoveryOptions()
    tolerance: ToleranceOptions = ToleranceOptions()


@dataclass(frozen=True)
class Study:
    """A checked study.

    axle: in the state that it was measured in, `state`. hidden: values of the axle file that this state
    hides, by internal name. measurements: folder or `test.toml` of each measured car.
    windows: load case -> half-width of the fit window in the input's unit.
    parameters: of the influence study. space: the variables on the unchanged axle, those of
    `use = "selection"` not yet narrowed. twin: the package's own model of the axle that an outside command
    solves, with the load cases that the command answers; None without a command or where it is switched off.
    discovery_remark: a sentence on whose model a discovery speaks of; empty of the study's own.
    """

    name: str
    source: Path
    axle: Axle
    axle_path: Path
    measurements: tuple[Path, ...]
    out: Path
    seed: int
    pictures: PictureFormat
    windows: dict[str, float]
    parameters: tuple[Parameter, ...]
    space: Space
    solver: SolverOptions
    variables: VariableOptions
    sampling: SamplingOptions
    surrogates: SurrogateOptions
    characteristics: tuple[CharacteristicOptions, ...]
    curves: tuple[CurveOptions, ...]
    correlation: CorrelationOptions
    discovery: DiscoveryOptions
    influence: InfluenceOptions
    tolerance: ToleranceOptions
    state: RigState = field(default_factory=RigState)
    hidden: Mapping[str, float] = field(default_factory=dict)
    twin: Axle | None = None
    discovery_remark: str = ""

    def __repr__(self) -> str:
        return f"Study({self.name!r}, {self.space.dimension} variables, from {self.source})"

    @property
    def folder(self) -> Path:
        """The study file's folder, which its paths are relative to."""
        return self.source.parent

    @property
    def axle_words(self) -> str:
        """Name of the axle and of its file, `Front axle, McPherson (axle.toml)`."""
        return f"{self.axle.name} ({self.axle_path.name})"

    @property
    def twin_path(self) -> Path:
        """The axle file of the twin: the study's own unless it names another."""
        named = self.solver.twin
        return self.folder / named if isinstance(named, str) else self.axle_path

    @property
    def store(self) -> Path:
        """The one file of all true-solver evaluations."""
        return self.out / STORES / "evaluations.sqlite"

    def extended_store(self, fingerprint: str) -> Path:
        """The file of the evaluations of the axle with effects that a discovery added."""
        return self.out / STORES / f"evaluations_{fingerprint[:12]}.sqlite"

    @property
    def discovery_store(self) -> Path:
        """The file of what a discovery has computed."""
        return self.out / STORES / "discovery.sqlite"

    def as_measured(self, axle: Axle) -> Axle:
        """Another axle in the state of the measurement."""
        return axle_in_state(axle, self.state)

    def as_designed(self, axle: Axle) -> Axle:
        """An axle of this study with what the measurement's state hid: as it is written to a file."""
        return axle.changed(self.hidden) if self.hidden else axle

    @property
    def measurement(self) -> Path | None:
        """The first measured car's folder or `test.toml`, whose state is that of all; None without any."""
        return self.measurements[0] if self.measurements else None

    def measured(self) -> tuple[Path, ...]:
        """`measurements`; InputError when the study names none."""
        if not self.measurements:
            raise InputError(
                f'{self.source}: names no measurement; add measurement = "FOLDER" (with its test.toml) '
                "or give --measurement DIR."
            )
        return self.measurements


def read_study(
    path: Path,
    *,
    measurement: Path | Sequence[Path] | None = None,
    out: Path | None = None,
    seed: int | None = None,
    pictures: PictureFormat | None = None,
) -> Study:
    """Study from its file, or from the folder that holds `study.toml`.

    measurement (one car's or several), out, seed, pictures: in place of the study's own. InputError naming
    file and key for anything wrong.
    """
    source = path / "study.toml" if path.is_dir() else path
    file = validate(StudyFile, read_toml(source), str(source))
    for case in file.windows:
        if case not in LOAD_CASES:
            raise InputError(
                f"{source}: [windows] {case} is not a load case; known are {', '.join(LOAD_CASES)}."
                f"{nearest(case, LOAD_CASES)}"
            )
    folder = source.parent
    designed = read_axle(folder / file.axle)
    cars = _paths(measurement) or tuple(folder / name for name in _names(file.measurement))
    state = rig_state(cars[0] if cars else None)
    axle = axle_in_state(designed, state)
    _check_windows(file.windows, axle, str(source))
    check_names(file.characteristics, file.curves, str(source))
    file.discovery.check_names(str(source))
    _check_out(out or folder / file.out, folder, folder / file.axle, cars, str(source))
    study = Study(
        name=file.name or folder.resolve().name,
        source=source,
        axle=axle,
        axle_path=folder / file.axle,
        measurements=cars,
        out=out or folder / file.out,
        seed=file.seed if seed is None else seed,
        pictures=pictures or file.pictures,
        windows=dict(file.windows),
        parameters=select(axle, file.influence.parameters, str(source)),
        space=build_space(axle, file.variables, str(source)),
        solver=file.solver,
        variables=file.variables,
        sampling=file.sampling,
        surrogates=file.surrogates,
        characteristics=tuple(file.characteristics),
        curves=tuple(file.curves),
        correlation=file.correlation,
        discovery=file.discovery,
        influence=file.influence,
        tolerance=file.tolerance,
        state=state,
        hidden=bar_values(designed, state),
    )
    return replace(study, twin=_twin(study))


def _names(measurement: str | list[str] | None) -> list[str]:
    if measurement is None:
        return []
    return [measurement] if isinstance(measurement, str) else measurement


def _paths(measurement: Path | Sequence[Path] | None) -> tuple[Path, ...]:
    if measurement is None:
        return ()
    return (measurement,) if isinstance(measurement, Path) else tuple(measurement)


def _twin(study: Study) -> Axle | None:
    """The twin, in the state of the measurement; InputError where it cannot be one of the outside model."""
    options = study.solver
    if not options.command or options.twin is False:
        return None
    twin = study.as_measured(read_axle(study.twin_path)) if isinstance(options.twin, str) else study.axle
    place = f"{study.source}: solver.twin {study.twin_path.name}"
    ours, other = (a.topology.structure.type for a in (study.axle, twin))
    if ours != other:
        raise InputError(
            f"{place}: is of the type {other}, the study's axle of {ours}; name an axle file of that type, "
            "or twin = false."
        )
    answered = [c for c in study.axle.load_cases if not options.load_cases or c in options.load_cases]
    for case in answered:
        if case not in twin.load_cases:
            raise InputError(
                f"{place}: has no load case {case}, which the outside model answers; add it to the twin, or "
                "leave it out of solver.load_cases."
            )
        ends = [float(np.abs(a.load_cases[case].inputs()).max()) for a in (study.axle, twin)]
        if ends[1] < ends[0] * (1.0 - 1e-9):
            unit = study.axle.load_cases[case].unit
            raise InputError(
                f"{place}: sweeps load case {case} to {ends[1]:g} {unit}, the study's axle to {ends[0]:g}; "
                f"give [load_cases.{case}] of the twin the same amplitude."
            )
    for path in (*study.space.paths, *(t.follower for t in study.space.ties), *(study.space.fixed or {})):
        parameter_value(twin, path, source=place)
    return replace(twin, load_cases={k: c for k, c in twin.load_cases.items() if k in answered})


def _check_out(out: Path, folder: Path, axle: Path, cars: Sequence[Path], source: str) -> None:
    """Results are not written over the axle file or among the records."""
    if "\0" in str(out):  # refused where it is written
        return
    for key, path in (("axle", axle), *(("measurement", car) for car in cars)):
        if "\0" in str(path):
            raise InputError(f"{source}: {key} holds a null character, which no path can; correct it.")
    place = out.resolve()
    if place in (axle.resolve(), Path(source).resolve()):
        raise InputError(f"{source}: out is {out}, a file of the study; name a folder of its own.")
    for car in cars:
        records = (car.parent if car.is_file() else car).resolve()
        if place.is_relative_to(records) and not folder.resolve().is_relative_to(records):
            raise InputError(f"{source}: out is {out}, inside the records' folder; name a folder beside it.")


def _check_windows(windows: dict[str, float], axle: Axle, source: str) -> None:
    """A line through fewer than three solved points is no fit."""
    for case, width in windows.items():
        points = np.sort(np.abs(axle.load_cases[case].inputs()))
        if np.count_nonzero(points <= width) < FEWEST_POINTS:
            raise InputError(
                f"{source}: [windows] {case} = {width:g} {axle.load_cases[case].unit} holds fewer than "
                f"{FEWEST_POINTS} solved points; widen it to {points[FEWEST_POINTS - 1]:g} or more."
            )


def select(axle: Axle, globs: list[str], source: str) -> tuple[Parameter, ...]:
    """Design parameters whose path matches a glob; InputError for a glob that matches none."""
    if not globs:
        raise InputError(f'{source}: parameters: the list is empty; name globs, or ["*"] for all.')
    everything = design_parameters(axle)
    for glob in globs:
        if not any(fnmatchcase(p.path, glob) for p in everything):
            raise InputError(
                f"{source}: parameters: {glob!r} matches no parameter; expected a path or glob such as "
                f"LLF.* or llr.F?.{nearest(glob, [p.path for p in everything])}"
            )
    return tuple(p for p in everything if any(fnmatchcase(p.path, g) for g in globs))
