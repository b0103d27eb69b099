"""Draws each effect of the reference list, and those that look like them, at a size in typical sizes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.discovery.chance import log_uniform, sign, spread
from benchmarks.discovery.hidden import Hidden
from benchmarks.discovery.laws import SHAPES, table
from doe_kc.axle import Axle

Draw = Callable[[np.random.Generator, float, Axle], Hidden]
STIFFENING = 0.15
"""Largest share by which a compliance stiffens or softens under full load: no joint is linear."""
CATALOGUE: dict[str, Draw] = {}
REFERENCE = (
    "hub_compliance",
    "strut_bending",
    "steering_friction",
    "strut_friction",
    "rack_mount_compliance",
    "bushing_preload",
    "bushing_progression",
    "subframe_flexibility",
    "ride_height_offset",
    "tie_rod_free_play",
    "left_right_asymmetry",
    "tyre_horizontal_compliance",
    "roll_technique",
)
"""The effects that every library has to know."""


def draw(ident: str) -> Callable[[Draw], Draw]:
    """Decorator: enter a draw into the catalogue."""

    def enter(function: Draw) -> Draw:
        CATALOGUE[ident] = function
        return function

    return enter


def compliance(
    ident: str, rng: np.random.Generator, size: float, typical: Mapping[str, float], apart: float = 0.3
) -> Hidden:
    """Stiffnesses typical / size, not all in the same ratio: real parts are softer about one axis.

    apart: standard deviation of the logarithm of their ratio, about which the size is kept."""
    factors = np.array([spread(rng, 1.0, apart) for _ in typical])
    factors /= float(np.exp(np.mean(np.log(factors))))
    options = {k: v / size * float(f) for (k, v), f in zip(typical.items(), factors, strict=True)}
    stiffening = float(rng.uniform(-STIFFENING, STIFFENING))
    return Hidden(ident, size, None, options, dict(options), tuple(options), stiffening)


@draw("hub_compliance")
def hub(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return compliance("hub_compliance", rng, size, {"camber_Nm_deg": 6000.0, "toe_Nm_deg": 9000.0})


@draw("strut_bending")
def strut_bending(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return compliance("strut_bending", rng, size, {"k_Nm_deg": 8000.0, "torsion_Nm_deg": 30000.0})


@draw("rack_mount_compliance")
def rack_mount(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return compliance("rack_mount_compliance", rng, size, {"k_N_mm": 6000.0})


@draw("subframe_flexibility")
def subframe(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return compliance("subframe_flexibility", rng, size, {"scale": 1.0})


@draw("tyre_horizontal_compliance")
def tyre_horizontal(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    typical = {"k_lat_N_mm": 180.0, "k_long_N_mm": 250.0}
    return compliance("tyre_horizontal_compliance", rng, size, typical)


def _friction(ident: str, size: float, force: float, presliding: float) -> Hidden:
    """The presliding of another law is another number, so that only the force is asked for."""
    shown = {"force_N": force * size}
    return Hidden(ident, size, None, {**shown, "presliding_mm": presliding, "law": "iwan"}, shown)


@draw("steering_friction")
def steering_friction(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return _friction("steering_friction", size, 250.0, log_uniform(rng, 0.025, 0.12))


@draw("strut_friction")
def strut_friction(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return _friction("strut_friction", size, 120.0, log_uniform(rng, 0.15, 0.6))


@draw("damper_friction")
def damper_friction(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    return replace(strut_friction(rng, size, axle), id="damper_friction")


@draw("bushing_preload")
def bushing_preload(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """Mostly along one axis, as a bushing clamped off its free angle pushes."""
    name = str(rng.choice(["LLR", "LLR", "LLF", "UPB"]))
    force = 0.1 * rng.standard_normal(3)
    force[int(rng.integers(3))] = sign(rng)
    values = [float(f) for f in 600.0 * size * force]
    parameters = {f"{name}[{i}]": v for i, v in enumerate(values)}
    return Hidden("bushing_preload", size, name, {name: values}, parameters)


PROGRESSION = {"LLR": 0.05, "LLF": 0.05, "UPB": 0.02}
"""1/mm^2, typical, per bushing."""


@draw("bushing_progression")
def bushing_progression(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """In all three directions of one bushing, by a table of another shape than the analyser's cubic."""
    name = str(rng.choice(["LLR", "LLR", "LLF", "UPB"]))
    shape = SHAPES[int(rng.integers(len(SHAPES)))]
    free = float(rng.uniform(0.1, 0.6))
    tables, parameters = {}, {}
    for i, of in enumerate(("Fx", "Fy", "Fz")):
        added = PROGRESSION[name] * size * spread(rng, 1.0, 0.3)
        k, cubic = (axle.values[f"{name.lower()}.{what}.{of}@L"] for what in ("stiffness", "cubic"))
        tables[name.lower(), of] = table(k, cubic, added, shape, free)
        parameters[f"{name}[{i}]"] = added
    options = {"shape": shape, "free_mm": free}
    return Hidden("bushing_progression", size, name, options, parameters, tables=tables, approximate=True)


@draw("ride_height_offset")
def ride_height(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    value = 7.0 * size * sign(rng)
    return Hidden("ride_height_offset", size, None, {"offset_mm": value}, {"offset_mm": value})


@draw("tie_rod_free_play")
def free_play(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """Worn on both sides, or on one."""
    joints: list[str] = [["ROB_L", "ROB_R"], ["ROB_L"], ["ROB_R"]][int(rng.integers(3))]
    place = "ROB" if len(joints) == 2 else joints[0]
    numbers = {"gap_mm": 0.2 * size, "contact_N_mm": log_uniform(rng, 14000.0, 28000.0)}
    options: dict[str, Any] = {"joints": joints, **numbers}
    return Hidden("tie_rod_free_play", size, place, options, numbers)


@draw("left_right_asymmetry")
def asymmetry(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    place = f"{rng.choice(['LLR', 'LLF', 'UPB', 'SFF', 'SFR'])}_{rng.choice(['L', 'R'])}"
    factor = 1.25 ** (size * sign(rng))
    return Hidden("left_right_asymmetry", size, place, {"scale": {place: factor}}, {place: factor})


@draw("roll_technique")
def roll_technique(rng: np.random.Generator, size: float, axle: Axle) -> Hidden:
    """There or not, so that it has no size."""
    technique = ["counter_phase", "wheel_to_ground"][int(rng.integers(2))]
    return Hidden("roll_technique", 1.0, None, {"technique": technique})
