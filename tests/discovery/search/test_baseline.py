"""The axle that the search begins with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.linear_nuisances import Trace
from doe_kc.discovery.nuisances import side_differences
from doe_kc.discovery.search.baseline import (
    tune,
    with_friction_traces,
    with_sides_anew,
    with_traces,
    with_traces_anew,
)
from doe_kc.discovery.thresholds import SIDE_ANGLE, TRACE_SD, TRACE_SEEN
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import apply_effect
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests.discovery.cases import discovery, library, model


def with_effect(bare: Fit, effect: Hypothesis, sizes: Sequence[float]) -> Fit:
    """At the same point with an effect of these sizes, whose derivatives are blank."""
    beside, z = bare.model.extended(effect), np.append(bare.z, sizes)
    own = np.hstack([bare.jacobian.own, np.zeros((bare.residual.size, len(sizes)))])
    return replace(bare, model=beside, z=z, residual=beside.residual(z), jacobian=beside.jacobian(own))


def test_the_axle_is_tuned_with_sides_that_differ() -> None:
    tuned = tune(model("pair"))
    assert tuned.converged and not tuned.model.members
    assert tuned.cost < np.inf and tuned.z.size > model("pair").centre.size


def test_sides_are_linear_about_the_axle_with_its_effects() -> None:
    """Against differences of solutions: what unequal camber makes of the loops of a strut friction too."""
    bare = tune(model("pair"))
    (friction,) = library("strut_friction")
    before = with_effect(bare, friction, [1.0, 0.0])
    beside, z = before.model, before.z
    found = with_sides_anew(before)
    assert bare.model.nuisances is not None and found.model.nuisances is not None
    sides, anew = bare.model.nuisances.columns, found.model.nuisances.columns
    assert sides.shape == anew.shape
    axle = beside.axle_at(z)
    there = [v.path for v in beside.space.variables if f"{v.path}@R" in axle.values]
    camber = there.index("static.camber")

    def unlike(sd: float) -> FloatArray:
        half = 0.5 * sd * SIDE_ANGLE
        moved = {f"static.camber@{of}": axle.values[f"static.camber@{of}"] for of in "LR"}
        moved["static.camber@L"] -= half
        moved["static.camber@R"] += half
        return beside.likelihood.residual(curve_set(solve(axle.changed(moved))), np.zeros(0))

    change = 0.5 * (unlike(1.0) - unlike(-1.0))
    assert np.linalg.norm(anew[:, camber] - change) < 0.01 * np.linalg.norm(change)
    assert np.linalg.norm(sides[:, camber] - change) > 0.2 * np.linalg.norm(change)
    assert found.cost <= cost_of(found.model, z, found.model.residual(z))


def test_a_search_ends_with_sides_about_the_axle_with_its_effects() -> None:
    search = discovery("friction").search
    bare, last = search.tuned.model.nuisances, search.with_effects
    assert bare is not None and last.model.nuisances is not None
    count = bare.count
    sides = side_differences(last.model.axle_at(last.z), last.model.space, last.model.likelihood)
    off = np.linalg.norm(last.model.nuisances.columns[:, :count] - sides)
    assert off < 0.2 * np.linalg.norm(bare.columns - sides), "taken anew close to where it ends"


def test_sides_that_are_not_known_yet_stay_so() -> None:
    bare = tune(model("pair"))
    alone = replace(bare, model=replace(bare.model, nuisances=None))
    assert with_sides_anew(alone) is alone


def test_traces_are_of_the_sizes_of_effects_that_move_something() -> None:
    """Not of the rig, nor of shapes; where nothing is screened the axle stays as it is."""
    tuned = tune(model("pair"))
    (hub,) = library("hub_compliance")
    screened = DiscoveryWorkers().screenings(tuned, [hub, *library("rig_channel_gain")[:1]])
    found = with_traces(tuned, screened)
    nuisances = found.model.nuisances
    assert nuisances is not None and {t.hypothesis.name for t in nuisances.traces} == {hub.name}
    seen = np.linalg.norm(screened[0].columns, axis=0) * TRACE_SD > TRACE_SEEN
    assert found.z.size == tuned.z.size + int(seen.sum()) and seen.any()
    assert with_traces(tuned, []) is tuned


def test_traces_of_compliances_are_linear_about_the_axle_with_its_effects() -> None:
    """Against solutions: a mount of the rack beside a friction of the rack is no softer column."""
    tuned = tune(model("friction"))
    friction, mount, strut = library("steering_friction", "rack_mount_compliance", "strut_friction")
    traced = with_traces(tuned, DiscoveryWorkers().screenings(tuned, [friction, mount, strut]))
    before = with_effect(traced, friction, [1.0, 0.0])
    known, beside, z = traced.model.nuisances, before.model, before.z
    assert known is not None
    found = with_traces_anew(before, DiscoveryWorkers())
    assert found.model.nuisances is not None and found.model.nuisances.traces == known.traces
    first, at = known.count - len(known.traces), known.traces.index(Trace(mount, 0))
    old, new = known.columns[:, first + at], found.model.nuisances.columns[:, first + at]
    axle = beside.driven(beside.axle_at(z), z)
    with_trace = apply_effect(axle, mount.effect, {"k_N_mm": mount.sizes[0].value(TRACE_SD)}, source="trace")
    without, there = (
        beside.likelihood.residual(curve_set(solve(a)), np.zeros(0)) for a in (axle, with_trace)
    )
    change = there - without
    assert np.linalg.norm(new - change) < 1e-6 * np.linalg.norm(change)
    assert np.linalg.norm(old - change) > 0.005 * np.linalg.norm(change)  # the friction's part
    others = np.delete(np.arange(known.count), first + at)
    np.testing.assert_array_equal(found.model.nuisances.columns[:, others], known.columns[:, others])
    assert found.cost <= cost_of(found.model, z, found.model.residual(z))


def test_traces_of_either_sign_are_derivatives_about_the_axle_with_its_effects() -> None:
    """A step of a trace's own size is not small: across a stop's contact it shifted a gain of the tyre load
    by four standard deviations."""
    tuned = tune(model("named"))
    hub, height = library("hub_compliance", "ride_height_offset")
    traced = with_traces(tuned, DiscoveryWorkers().screenings(tuned, [hub, height]))
    before = with_effect(traced, hub, [1.0, 1.0])
    known, beside, z = traced.model.nuisances, before.model, before.z
    assert known is not None
    found = with_traces_anew(before, DiscoveryWorkers()).model.nuisances
    assert found is not None
    column = found.columns[:, found.count - len(found.traces) + found.traces.index(Trace(height, 0))]
    member = beside.extended(height)
    ahead, behind = (member.residual(np.append(z, step)) for step in (1e-4, -1e-4))
    derivative = TRACE_SD * (ahead - behind) / 2e-4
    assert np.linalg.norm(column - derivative) < 1e-2 * np.linalg.norm(derivative)


def test_without_effects_or_traces_there_is_nothing_to_take_anew() -> None:
    tuned = tune(model("pair"))
    assert with_traces_anew(tuned, DiscoveryWorkers()) is tuned


def test_traces_of_frictions_are_by_both_laws_about_the_axle_with_its_effects() -> None:
    """Against solutions, of the one that is absent; a law that only presses is a spring of its own."""
    tuned = tune(model("pair"))
    steering, strut = library("steering_friction", "strut_friction")
    traced = with_traces(tuned, DiscoveryWorkers().screenings(tuned, [steering, strut]))
    untraced = traced.z.copy()
    untraced[traced.model.traces] = 0.0
    before = with_effect(replace(traced, z=untraced), steering, [1.0, 0.0])
    known, beside, z = traced.model.nuisances, before.model, before.z
    assert known is not None
    found = with_friction_traces(before, DiscoveryWorkers())
    anew = found.model.nuisances
    assert anew is not None
    by_law = [Trace(strut, 0), Trace(replace(strut, law="iwan"), 0)]
    assert anew.traces == (*known.traces, by_law[1])
    assert found.z.size == z.size + 1
    there = np.insert(z, beside.dimension, 0.0)
    assert found.cost <= cost_of(found.model, there, found.model.residual(there))
    first, bare = anew.count - len(anew.traces), beside.residual(z)
    columns = [anew.columns[:, first + anew.traces.index(trace)] for trace in by_law]
    for trace, column in zip(by_law, columns, strict=True):
        member = beside.extended(trace.hypothesis)
        change = member.residual(np.append(z, [TRACE_SD, 0.0])) - bare
        np.testing.assert_allclose(column, change / np.sqrt(2.0), atol=1e-9)
    assert np.linalg.norm(columns[1] - columns[0]) > 0.1 * np.linalg.norm(columns[0])
    others = np.delete(np.arange(known.count), first + anew.traces.index(by_law[0]))
    np.testing.assert_array_equal(anew.columns[:, others], known.columns[:, others])
    assert with_friction_traces(tuned, DiscoveryWorkers()) is tuned
