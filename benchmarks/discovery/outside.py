"""Effects that no library lists: faults of the rig, and a part whose curve is of another form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.discovery.chance import sign
from benchmarks.discovery.path import SAMPLES
from benchmarks.discovery.sensors import RESOLUTION, kind
from doe_kc.axle import Axle
from doe_kc.axle.force_curve import curve_values
from doe_kc.curves import RIG_RESPONSES, TYRE_LOAD
from doe_kc.ground.typing import FloatArray

Channels = Mapping[str, FloatArray]
"""Response -> (2, n)."""
Change = Callable[[str, FloatArray, Channels], dict[str, FloatArray]]
"""(load case, input over amplitude (n,), channels) -> what is added to some of them."""
FORCE_SIGN = {"drive": 1.0, "brake": -1.0}
ARM = 200.0
"""mm, height of the wheel centres below the axis about which the body pitches on its clamps."""


@dataclass(frozen=True)
class Outside:
    """kind: what it is. size: in `unit`. shows: (load case or "*", response) where it can be seen."""

    kind: str
    size: float
    unit: str
    shows: tuple[tuple[str, str], ...]
    added: Change | None = None
    stop_growth: float = 0.0

    def axle(self, axle: Axle) -> Axle:
        """The axle with it, where it is the car's."""
        if not self.stop_growth:
            return axle
        at = range(axle.topology.bump_points)
        x, y = (np.array([axle.values[f"bump_stop.table.{of}{i}"] for i in at]) for of in "xy")
        stiffer = y * (1.0 + self.stop_growth * x / x[-1])
        return axle.changed(dict(curve_values("bump_stop.table", x, stiffer)))

    def read(self, case: str, relative: FloatArray, channels: Channels) -> dict[str, FloatArray]:
        """Channels as the rig gives them, before noise."""
        if self.added is None:
            return dict(channels)
        extra = self.added(case, relative, channels)
        return {r: c + extra[r] if r in extra else c for r, c in channels.items()}


def _only(case: str, response: str, value: Callable[[FloatArray], FloatArray]) -> Change:
    def added(at: str, relative: FloatArray, channels: Channels) -> dict[str, FloatArray]:
        return {response: value(relative)[None, :]} if at == case else {}

    return added


UNIT = {"angle": "deg", "displacement": "mm", "tyre_load": "N"}


def _place(rng: np.random.Generator) -> tuple[str, str, float, str]:
    """(load case, response, signed size at 12 to 30 times white noise, unit)."""
    case = str(rng.choice(["vertical", "roll", "lateral", "lateral_opposite", "drive", "brake", "steer"]))
    response = str(rng.choice(RIG_RESPONSES))
    size = sign(rng) * float(rng.uniform(12.0, 30.0)) * RESOLUTION[kind(response)]
    return case, response, size, UNIT[kind(response)]


def kink(rng: np.random.Generator) -> Outside:
    """A cable touches: one channel bends beyond an input."""
    case, response, size, unit = _place(rng)
    at, way = float(rng.uniform(0.2, 0.5)), sign(rng)
    beyond = _only(case, response, lambda u: size * np.maximum(way * u - at, 0.0) / (1.0 - at))
    return Outside("kink", size, unit, ((case, response),), beyond)


def slip(rng: np.random.Generator) -> Outside:
    """A target slips at one input on the way down and back on the way up."""
    case, response, size, unit = _place(rng)
    down, up = (float(v) for v in rng.uniform(-0.6, 0.6, 2))

    def value(u: FloatArray) -> FloatArray:
        falling = np.arange(u.size) < u.size // 2
        return size * np.where(falling, u < down, u < up)

    return Outside("slip", size, unit, ((case, response),), _only(case, response, value))


def drift(rng: np.random.Generator) -> Outside:
    """The spin sensor warms up during a run."""
    case = str(rng.choice(["vertical", "lateral", "drive", "brake", "steer"]))
    size = sign(rng) * float(rng.uniform(0.03, 0.09))
    run = _only(case, "spin", lambda u: size * np.arange(u.size) / SAMPLES)
    return Outside("drift", size, "deg", ((case, "spin"),), run)


def cross_talk(rng: np.random.Generator) -> Outside:
    """Camber leaks into toe, in one load case that was run with a badly aligned target."""
    case = str(rng.choice(["vertical", "roll", "lateral", "lateral_opposite"]))
    size = sign(rng) * float(rng.uniform(0.15, 0.4))

    def added(at: str, relative: FloatArray, channels: Channels) -> dict[str, FloatArray]:
        middle = SAMPLES // 4
        camber = channels["camber"]
        return {"toe": size * (camber - camber[:, middle : middle + 1])} if at == case else {}

    return Outside("cross_talk", size, "deg/deg", ((case, "toe"),), added)


def load_shift(rng: np.random.Generator) -> Outside:
    """The toe sensor of one wheel is bent by the wheel's load."""
    side, size = int(rng.integers(2)), sign(rng) * float(rng.uniform(0.02, 0.05))

    def added(at: str, relative: FloatArray, channels: Channels) -> dict[str, FloatArray]:
        load = channels[TYRE_LOAD]
        shift = size * (load - load.mean(axis=1, keepdims=True)) / 1000.0
        shift[1 - side] = 0.0
        return {"toe": shift}

    return Outside("load_shift", size, "deg/kN", (("vertical", "toe"), ("roll", "toe")), added)


def body_pitch(rng: np.random.Generator) -> Outside:
    """The body yields on its clamps under longitudinal force, progressively, and takes the datum along."""
    size = sign(rng) * float(rng.uniform(0.04, 0.1))

    def added(at: str, relative: FloatArray, channels: Channels) -> dict[str, FloatArray]:
        if at not in FORCE_SIGN:
            return {}
        pitch = FORCE_SIGN[at] * size * relative * np.abs(relative)
        return {"spin": pitch[None, :], "wc_x": np.radians(pitch)[None, :] * ARM}

    shows = tuple((case, r) for case in FORCE_SIGN for r in ("spin", "wc_x"))
    return Outside("body_pitch", size, "deg", shows, added)


def stop_shape(rng: np.random.Generator) -> Outside:
    """The bump stop stiffens more, or less, than the model's curve."""
    growth = float(rng.choice([-0.6, 1.0])) * float(rng.uniform(0.7, 1.0))
    blank = Outside("stop_shape", growth, "-", (("vertical", TYRE_LOAD), ("roll", TYRE_LOAD)))
    return replace(blank, stop_growth=growth)


OUTSIDE: dict[str, Callable[[np.random.Generator], Outside]] = {
    "kink": kink,
    "slip": slip,
    "drift": drift,
    "cross_talk": cross_talk,
    "load_shift": load_shift,
    "body_pitch": body_pitch,
    "stop_shape": stop_shape,
}
