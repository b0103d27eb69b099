"""The axle that the search begins with."""

from __future__ import annotations

import numpy as np

from doe_kc.discovery.search.baseline import tune, with_clutter
from doe_kc.discovery.thresholds import TRACE_SD, TRACE_SEEN
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import library, model


def test_the_axle_is_tuned_with_sides_that_differ() -> None:
    tuned = tune(model("pair"))
    assert tuned.converged and not tuned.model.members
    assert tuned.cost < np.inf and tuned.z.size > model("pair").centre.size


def test_traces_are_of_the_sizes_of_effects_that_move_something() -> None:
    """Not of the rig, nor of shapes; where nothing is screened the axle stays as it is."""
    tuned = tune(model("pair"))
    (hub,) = library("hub_compliance")
    screened = DiscoveryWorkers().screenings(tuned, [hub, *library("rig_channel_gain")[:1]])
    found = with_clutter(tuned, screened)
    nuisances = found.model.nuisances
    assert nuisances is not None and set(nuisances.traces) == {hub.name}
    seen = np.linalg.norm(screened[0].columns, axis=0) * TRACE_SD > TRACE_SEEN
    assert found.z.size == tuned.z.size + int(seen.sum()) and seen.any()
    assert with_clutter(tuned, []) is tuned
