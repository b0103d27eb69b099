"""Faults of the test that are effects of the library: what the rig does, and what it reads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.discovery.hidden import Hidden
from doe_kc.axle import Axle
from doe_kc.curves import TYRE_LOAD
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.load_cases.roll import CounterPhaseRoll


def driven(
    case: LoadCase, inputs: FloatArray, axle: Axle, hidden: Sequence[Hidden]
) -> tuple[LoadCase, FloatArray]:
    """The load case and inputs (n,) that the rig really runs while it records `inputs` of `case`."""
    gain = float(_options(hidden, "rig_input_gain").get(case.id, 1.0))
    inputs = gain * inputs
    if case.id == "roll" and _options(hidden, "roll_technique").get("technique") == "counter_phase":
        pads = axle.half_track * np.tan(np.radians(inputs))
        return CounterPhaseRoll(amplitude=float(pads.max()), steps=case.steps), pads
    return case, inputs


def read(
    case: LoadCase,
    inputs: FloatArray,
    channels: Mapping[str, FloatArray],
    static: Mapping[str, FloatArray],
    hidden: Sequence[Hidden],
) -> dict[str, FloatArray]:
    """Response -> (2, n) as the rig's wrong sensors give it, absolute. static: response -> (2,) at rest."""
    out = dict(channels)
    for response, gain in _options(hidden, "rig_channel_gain").items():
        zero = static[response][:, None] * (response != TYRE_LOAD)
        out[response] = zero + float(gain) * (out[response] - zero)
    if case.id == "roll" and _options(hidden, "roll_technique").get("technique") == "wheel_to_ground":
        # the right side goes down: the road leans the left wheel's top inwards, the right one's outwards
        out["camber"] = out["camber"] + np.array([[-1.0], [1.0]]) * inputs
    return out


def _options(hidden: Sequence[Hidden], ident: str) -> Mapping[str, Any]:
    return next((h.options for h in hidden if h.id == ident), {})
