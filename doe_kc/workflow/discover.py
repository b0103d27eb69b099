"""Discover: from a study to a verdict on what its axle lacks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path

from doe_kc.axle.model import Axle
from doe_kc.axle.places import places_of
from doe_kc.campaign.executors import processes
from doe_kc.campaign.processes import available_cores
from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.discovery.car_scatter import series_scatter
from doe_kc.discovery.discover import discover
from doe_kc.discovery.mean_car import mean_car_likelihood
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.result_cache import ResultCache
from doe_kc.discovery.solutions import Solutions
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.threads import one_thread
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.variables import Space, VariableOptions, build_space

Progress = Callable[[str, int, int], None]


@one_thread()
def discover_study(
    study: Study,
    measurement: Measurement,
    *,
    exclude: Sequence[str] = (),
    workers: int | None = None,
    progress: Progress = lambda *_: None,
) -> Discovery:
    """Look for effects that the study's axle lacks.

    exclude: ids of effects that are not looked for. progress: told (what, steps done, of how many); more are
    added as they are begun. InputError for an unknown effect, an outside solver, or
    records and sweeps without a common load case. Results are remembered in `discovery.sqlite` of the
    study's folder, so that the same call goes on where it was interrupted.
    """
    if study.solver.command:
        raise InputError(
            f"{study.source}: discovery needs exact sensitivities, which an outside solver does not give; "
            "compare its twin with the records, or remove [solver] command."
        )
    axle = recorded(study.axle, measurement)
    library = effect_library(axle, exclude)
    likelihood = record_likelihood(axle, measurement)
    if not likelihood.curves:
        raise InputError(
            f"{study.source}: no load case of the records is among the axle's; "
            f"expected one of {', '.join(study.axle.load_cases)}."
        )
    count = workers or available_cores()
    space = discovery_space(axle, study.variables, str(study.source))
    model = EffectModel(axle, space, likelihood, solutions=Solutions(count))
    done, total = 0, expected_steps(study, measurement, exclude)
    if measurement.cars:
        progress("re-tuning every car", done, total)
    model, remarks = mean_car(model, measurement)

    def counted(words: str, steps: int, begun: int) -> None:
        nonlocal done, total
        done += steps
        total = max(total, done + begun)
        progress(words, done, total)

    with processes(count) as executor, ResultCache(study.discovery_store) as cache:
        discovery = discover(model, library, DiscoveryWorkers(executor, cache, counted, workers=count))
    if study.discovery_remark:
        remarks = (*remarks, study.discovery_remark)
    return replace(discovery, sentences=(*discovery.sentences, *remarks))


def mean_car(model: EffectModel, measurement: Measurement) -> tuple[EffectModel, tuple[str, ...]]:
    """The model against the records of the mean of several cars, with what that may be off, and what their
    scatter is, in a sentence; of one car the model as it is."""
    if not measurement.cars:
        return model, ()
    series = series_scatter(model, measurement)
    likelihood = mean_car_likelihood(model, measurement)
    return replace(model, likelihood=likelihood, scatter=series.mean_sd), (series.sentence,)


def recorded(axle: Axle, measurement: Measurement) -> Axle:
    """The axle with the load cases that were measured: the others need not be solved."""
    cases = {k: c for k, c in axle.load_cases.items() if k in measurement.curves.cases}
    return replace(axle, load_cases=cases)


def expected_steps(study: Study, measurement: Measurement, exclude: Sequence[str] = ()) -> int:
    """Steps that a discovery reports about: one for each screening, refit and held-out load case."""
    axle = recorded(study.axle, measurement)
    return len(effect_library(axle, exclude)) + 2 * len(axle.load_cases) + 10


def effect_library(axle: Axle, exclude: Sequence[str] = ()) -> tuple[Hypothesis, ...]:
    """Every place of every effect that the axle does not have yet; InputError for an unknown id."""
    for ident in exclude:
        if ident not in EFFECTS:
            raise InputError(
                f"--exclude {ident}: is no effect; known are {', '.join(EFFECTS)}.{nearest(ident, EFFECTS)}"
            )
    places = places_of(axle)
    wanted = [e for e in EFFECTS.values() if e.id not in exclude and e.possible(places)]
    return tuple(h for e in wanted if not e.present(axle) for h in e.hypotheses(places))


def discovery_space(axle: Axle, options: VariableOptions, source: str) -> Space:
    """The study's variables but those that are an effect in other words: they would absorb it wholly."""
    places = places_of(axle)
    held = {path for e in EFFECTS.values() if e.possible(places) for path in e.replaces}
    named = set() if options.use == "selection" else set(options.use)
    changes = [c for c in options.change if not any(fnmatchcase(path, c.match) for path in held & {c.match})]
    use = [glob for glob in named if glob not in held] or ["*"]
    free = options.model_copy(
        update={"use": use, "leave_out": [*options.leave_out, *sorted(held)], "change": changes}
    )
    return build_space(axle, free, source)


@one_thread()
def discover_folder(
    axle_path: Path,
    measurement_dir: Path | Sequence[Path],
    *,
    variables: VariableOptions | None = None,
    exclude: Sequence[str] = (),
    out: Path,
    workers: int = 1,
) -> dict[str, object]:
    """An axle file against a folder of records, without a study file; the answer as data.

    measurement_dir: of one car, or those of several. variables: as in a study, by default all of the axle.
    """
    from doe_kc.axle_file import read_axle
    from doe_kc.measurement import reduce_cars
    from doe_kc.measurement.rig_state import axle_in_state
    from doe_kc.workflow.discovery_document import discovery_document

    axle = read_axle(axle_path)
    folders = (measurement_dir,) if isinstance(measurement_dir, Path) else measurement_dir
    measurement = reduce_cars(folders, half_track=axle.half_track)
    axle = axle_in_state(axle, measurement.manifest.state)
    axle = recorded(axle, measurement)
    library = effect_library(axle, exclude)
    space = discovery_space(axle, variables or VariableOptions(), str(axle_path))
    likelihood, solutions = record_likelihood(axle, measurement), Solutions(workers)
    model, _ = mean_car(EffectModel(axle, space, likelihood, solutions=solutions), measurement)
    with processes(workers) as executor, ResultCache(out / "discovery.sqlite") as cache:
        discovery = discover(model, library, DiscoveryWorkers(executor, cache, workers=workers))
    return dict(discovery_document(discovery, None))
