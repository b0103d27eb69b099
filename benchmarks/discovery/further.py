"""Effects beyond the reference list: those that look like it, and plain faults of the test."""

from __future__ import annotations

import numpy as np

from benchmarks.discovery.catalogue import compliance, draw
from benchmarks.discovery.chance import log_uniform, sign
from benchmarks.discovery.hidden import Hidden
from doe_kc.axle import Axle
from doe_kc.curves import RIG_RESPONSES

FURTHER = (
    "tie_rod_compliance",
    "ball_joint_compliance",
    "power_assist",
    "steering_ratio",
    "rig_channel_gain",
    "rig_input_gain",
)


@draw("tie_rod_compliance")
def tie_rod(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return compliance("tie_rod_compliance", rng, size, {"k_N_mm": 15000.0})


@draw("ball_joint_compliance")
def ball_joint(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return compliance("ball_joint_compliance", rng, size, {"k_N_mm": 12000.0})


@draw("power_assist")
def power_assist(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    numbers = {"gain": size, "reference_N": log_uniform(rng, 150.0, 600.0)}
    return Hidden("power_assist", size, None, numbers, numbers)


@draw("steering_ratio")
def steering_ratio(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """The record tells the steering wheel's angle, so that another pinion is the car's, not the rig's."""
    numbers = {"factor": 1.03 ** (size * sign(rng))}
    return Hidden("steering_ratio", size, None, numbers, numbers)


@draw("rig_channel_gain")
def rig_channel_gain(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    place = str(rng.choice(RIG_RESPONSES))
    numbers = {place: 1.05 ** (size * sign(rng))}
    return Hidden("rig_channel_gain", size, place, numbers, numbers)


@draw("rig_input_gain")
def rig_input_gain(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    place = str(rng.choice(list(axle.load_cases)))
    numbers = {place: 1.05 ** (size * sign(rng))}
    return Hidden("rig_input_gain", size, place, numbers, numbers)
