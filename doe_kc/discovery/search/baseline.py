"""What the search begins with: the axle re-tuned without any effect, and traces of all of them; its sides,
taken anew beside the effects of each set, and traces beside those of the last."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice

import numpy as np

from doe_kc.discovery.derivatives import amplitude_columns
from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.gauss_newton import chord_fit, fit, known_columns
from doe_kc.discovery.linear_nuisances import LinearNuisances, Trace
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.nuisances import side_differences
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.thresholds import TRACE_SD, TRACE_SEEN
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged


def tune(model: EffectModel) -> Fit:
    """The best axle without a further effect, the differences between its sides linear about it."""
    first = fit(model, model.centre)
    sides = _sides(first)
    sided = replace(model, nuisances=LinearNuisances(sides))
    start = np.concatenate([first.z, np.zeros(sided.dimension - model.dimension)])
    return fit(sided, start, known=known_columns(first, sided), aged=0.0)


def with_sides_anew(current: Fit) -> Fit:
    """The fit, the differences between its sides linear about the axle with its effects.

    About the axle without them half-widths of loops do not hang on the sides: beside a strut friction what
    unequal struts make of them was left, a contrast of 8 standard deviations that noise does not explain.
    """
    known = current.model.nuisances
    if known is None:
        return current
    try:
        sides = _sides(current)
    except NotConverged:
        return current
    return _with_nuisances(current, known.with_sides(sides))


def _with_nuisances(current: Fit, nuisances: LinearNuisances) -> Fit:
    """The fit with other columns of its linear nuisances and further ones behind them, as far as its
    derivatives lead."""
    model = replace(current.model, nuisances=nuisances)
    z = np.insert(current.z, current.model.dimension, np.zeros(model.dimension - current.model.dimension))
    jacobian, residual = model.jacobian(current.jacobian.own), model.residual(z)
    return chord_fit(replace(current, model=model, z=z, residual=residual, jacobian=jacobian), model)


def _sides(fit: Fit) -> FloatArray:
    """(M, k) change of the residual by each difference between the sides, about the fit."""
    model = fit.model
    return np.asarray(model.scatter * side_differences(model.axle_at(fit.z), model.space, model.likelihood))


def with_traces(tuned: Fit, screened: Sequence[Screened]) -> Fit:
    """The re-tuned axle with traces of all effects, those that cannot move anything left out."""
    traces: list[Trace] = []
    columns: list[FloatArray] = []
    for s in screened:
        if s.failed or EFFECTS[s.hypothesis.effect].on_rig:
            continue
        for i, (size, column) in enumerate(zip(s.hypothesis.sizes, s.columns.T, strict=True)):
            if not size.shape and np.linalg.norm(column) * TRACE_SD > TRACE_SEEN:
                traces.append(Trace(s.hypothesis, i))
                columns.append(TRACE_SD * column)
    if not traces:
        return tuned
    sides = tuned.model.nuisances or LinearNuisances(np.zeros((tuned.residual.size, 0)))
    model = replace(tuned.model, nuisances=sides.with_traces(traces, np.array(columns).T))
    z = np.concatenate([tuned.z, np.zeros(len(traces))])
    jacobian = model.jacobian(tuned.jacobian.own)
    state = replace(tuned, model=model, z=z, jacobian=jacobian, cost=cost_of(model, z, tuned.residual))
    return chord_fit(state, model)


def with_traces_anew(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit, traces of absent compliances and of sizes of either sign linear about the axle with its
    effects.

    About the axle without them a mount of the rack is a softer column; beside a friction of the rack it is
    not, and shifts that friction by 1 standard deviation. A gain of the tyre load was 8 off, as a ride height
    looks otherwise about an axle that has been re-tuned to hide it.
    """
    model, known = current.model, current.model.nuisances
    if known is None or not model.members:
        return current
    columns, first = known.columns.copy(), known.sides
    able = [(i, t) for i, t in enumerate(known.traces, start=first) if compatible(model, t.hypothesis)]
    signed = [(i, t) for i, t in able if t.size.signed]
    with suppress(NotConverged):
        columns[:, [i for i, _ in signed]] = _derivatives_by(current, [t for _, t in signed])
    yielding = [
        (i, t)
        for i, t in able
        if t.size.growth == "compliance" and not any(s.needed for s in t.hypothesis.sizes)
    ]
    changes = _changes_by(current, [t for _, t in yielding], workers)
    for (i, _), change in zip(yielding, changes, strict=True):
        if change is not None:
            columns[:, i] = change
    return _with_nuisances(current, replace(known, columns=columns))


def with_friction_traces(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit, traces of absent frictions about the axle with its effects, by each law of as few numbers as
    the default one, alike in size.

    A friction that only presses is a spring, as stiff as its law says. By Dahl's law about the axle without
    effects, 4 N in a strut by Prandtl-Iwan's left 1.1 to 1.7 standard deviations in the lateral stiffness of
    the tyres, of six cars always towards stiffer ones.
    """
    model, known = current.model, current.model.nuisances
    if known is None or not model.members:
        return current
    columns, first = known.columns.copy(), known.sides
    by_law: dict[int, list[Trace]] = {}
    for i, trace in enumerate(known.traces, start=first):
        effect = EFFECTS[trace.hypothesis.effect]
        if effect.frictional and compatible(model, trace.hypothesis):
            laws = effect.variants(trace.hypothesis)
            numbers = len(trace.hypothesis.sizes)
            by_law[i] = [replace(trace, hypothesis=law) for law in laws if len(law.sizes) == numbers]
    every = iter(_changes_by(current, [t for alike in by_law.values() for t in alike], workers))
    traces: list[Trace] = []
    further: list[FloatArray] = []
    for i, alike in by_law.items():
        count = len(alike)
        changes = [change / np.sqrt(count) for change in islice(every, count) if change is not None]
        if len(changes) < count:
            continue
        columns[:, i] = changes[0]
        traces += alike[1:]
        further += changes[1:]
    anew = replace(known, columns=columns)
    return _with_nuisances(current, anew.with_traces(traces, np.array(further).T) if traces else anew)


def _derivatives_by(current: Fit, traces: Sequence[Trace]) -> FloatArray:
    """(M, k) change of the residual by traces of their standard deviations, by its derivatives about the fit.

    All of them are absent there, so that each is what it is alone.
    """
    model = current.model
    for hypothesis in {t.hypothesis.name: t.hypothesis for t in traces}.values():
        model = model.extended(hypothesis)
    absent = np.concatenate([current.z, np.zeros(len(model.sizes) - len(current.model.sizes))])
    starts = {h.name: place.start for h, place in model.places()}
    places = [starts[t.hypothesis.name] + t.place for t in traces]
    return TRACE_SD * amplitude_columns(model, absent, model.residual(absent), places)


def _changes_by(current: Fit, traces: Sequence[Trace], workers: DiscoveryWorkers) -> list[FloatArray | None]:
    """(M,) change of the residual by each trace of its standard deviation, about the fit; None where the axle
    has no equilibrium with it."""
    models = [current.model.extended(trace.hypothesis) for trace in traces]
    alone = [TRACE_SD * np.eye(len(trace.hypothesis.sizes))[trace.place] for trace in traces]
    points = [(m, np.concatenate([current.z, a])) for m, a in zip(models, alone, strict=True)]
    known, linear = current.model.nuisances, current.z[current.model.linear]
    assert known is not None
    out: list[FloatArray | None] = []
    for model, with_trace in zip(models, workers.residuals(points), strict=True):
        own = known.moved((current.model.weights - model.weights) * linear)  # it has no trace as a member
        out.append(None if with_trace is None else with_trace + own - current.residual)
    return out
