"""The state that a car was measured in, applied to its model."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from doe_kc.axle.model import Axle
from doe_kc.ground.errors import InputError
from doe_kc.measurement.manifest import RigState, load_manifest

BAR_RATE = "arb.rate"


def rig_state(measurement: Path | None) -> RigState:
    """State by a folder's `test.toml`; the usual one where there is none, or none that reads: what is
    wrong with it is told where the records are read."""
    if measurement is None:
        return RigState()
    try:
        return load_manifest(measurement / "test.toml" if measurement.is_dir() else measurement).state
    except InputError:
        return RigState()


def axle_in_state(axle: Axle, state: RigState) -> Axle:
    """The axle as it was measured: without its anti-roll bar where that was off."""
    if state.arb == "on" or BAR_RATE not in axle.values:
        return axle
    return axle.changed({BAR_RATE: 0.0})


def bar_values(axle: Axle, state: RigState) -> Mapping[str, float]:
    """Values of the axle that its state hides, by internal name."""
    return {} if axle_in_state(axle, state) is axle else {BAR_RATE: axle.values[BAR_RATE]}
