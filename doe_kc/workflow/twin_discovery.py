"""Discovery through the twin of an outside model: what that model lacks, in its own terms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.campaign.runner import Campaign
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.options import SolverOptions
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.own import AxleSolver

OWN_TERMS = (
    "This is said of the outside model, in its own terms: what differs between it and its twin at {design} "
    "was taken off the records before the twin was compared with them, so that an effect which the outside "
    "model has already is not named."
)
START = "the study's first design"


@dataclass(frozen=True)
class DiscoveryGround:
    """What a discovery works on: a study that the package's own solver answers, and records in its terms."""

    study: Study
    records: Measurement


def discovery_ground(study: Study, measurement: Measurement) -> DiscoveryGround:
    """The study as it is; beside an outside model its twin, and the records less what differs between both at
    the study's first design, which the outside model solves unless the store has it.

    InputError for an outside model without a twin or without curves, RunError where one has no equilibrium.
    """
    if not study.solver.command:
        return DiscoveryGround(study, measurement)
    if study.twin is None:
        raise InputError(
            f"{study.source}: discovery needs exact sensitivities, which an outside solver does not give; "
            "name its twin with [solver] twin, or remove [solver] command."
        )
    values = study.space.values(study.space.start)
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    with Campaign(solver, study.store) as campaign:
        (outcome,) = campaign.evaluate([values], "baseline")
    if outcome.failed:
        raise RunError(f"the baseline axle cannot be solved: {outcome.reason}")
    return twin_ground(study, measurement, outcome, values, START)


def twin_ground(
    study: Study, measurement: Measurement, outside: Outcome, values: Mapping[str, float], design: str
) -> DiscoveryGround:
    """The twin, and the records less what differs between both models at one design.

    outside: its answer to the absolute `values`. design: what that is called in words. Errors as
    `discovery_ground`.
    """
    if study.twin is None or outside.curves is None:
        raise InputError(f"{study.source}: the outside model gave no curves, which discovery compares.")
    twin = AxleSolver(study.twin, study.windows).evaluate(values)
    if twin.curves is None:
        raise RunError(f"{study.twin_path}: the twin cannot be solved: {twin.reason}")
    own = replace(
        study,
        axle=study.twin,
        axle_path=study.twin_path,
        twin=None,
        solver=SolverOptions(),
        discovery_remark=OWN_TERMS.format(design=design),
    )
    return DiscoveryGround(own, less_disagreement(measurement, outside.curves, twin.curves))


def less_disagreement(measurement: Measurement, outside: CurveSet, twin: CurveSet) -> Measurement:
    """The records less what the outside model says beyond its twin at one design: of mean and half-width
    curves and static angles, at the records' inputs. A load case or response that the outside model does not
    answer is left out: nothing is known of what differs there.
    """
    cases = {
        ident: _case(case, outside.cases[ident], twin.cases[ident])
        for ident, case in measurement.curves.cases.items()
        if ident in outside.cases and ident in twin.cases
    }
    static = {
        angle: values - ((outside.static or {})[angle] - (twin.static or {})[angle])
        for angle, values in (measurement.curves.static or {}).items()
        if angle in (outside.static or {}) and angle in (twin.static or {})
    }
    return replace(measurement, curves=replace(measurement.curves, cases=cases, static=static or None))


def _case(measured: CaseCurves, outside: CaseCurves, twin: CaseCurves) -> CaseCurves:
    known = [r for r in measured.mean if r in outside.mean and r in twin.mean]
    grid = measured.input

    def less(kind: str, response: str) -> FloatArray:
        rows = [getattr(c, kind)[response] for c in (measured, outside, twin)]
        ours, other = (
            np.array([np.interp(grid, case.input, side) for side in curve])
            for case, curve in zip((outside, twin), rows[1:], strict=True)
        )
        return np.asarray(rows[0] - (ours - other))

    return replace(
        measured,
        mean={r: less("mean", r) for r in known},
        half_width={r: less("half_width", r) for r in known if r in measured.half_width},
    )
