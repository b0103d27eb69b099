"""Small cars of which one thing is hidden: nominal axle, scatter, an effect, noise; and what is found in it.

Four load cases, thirteen tunable parameters, a library of a dozen hypotheses: a search takes a second or two.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.axle import with_values
from doe_kc.axle.model import Axle
from doe_kc.axle_file import read_axle
from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.curves import RIG_RESPONSES, CaseCurves, CurveSet
from doe_kc.discovery.discover import discover
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result import Discovery
from doe_kc.effects import EFFECTS, apply_effect, observed
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement, reduce_measurement
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.variables import Space, VariableOptions, build_space

RIG = Path(__file__).parents[1] / "data" / "rig"
AXLE = Path(__file__).parents[2] / "examples" / "front_axle" / "axle.toml"
NOISE_OF = "car_b"
LOAD_CASES = ("vertical", "lateral", "lateral_opposite", "steer")
TUNABLE = ["LLF.z", "LLR.z", "ROB.z", "UPB.y", "l?r.F?", "upb.F?", "static.*", "spring.rate"]
SCATTER = {"LLF.z": 0.8, "ROB.z": -0.6, "llr.Fy": 0.1, "spring.rate": 0.4}
"""Of every car, added to nominal."""
LIBRARY = (
    "hub_compliance",
    "strut_bending",
    "tie_rod_compliance",
    "steer_arm_compliance",
    "steering_friction",
    "strut_friction",
    "bushing_progression",
    "rig_channel_gain",
)
HIDDEN: Mapping[str, Mapping[str, Mapping[str, Any]]] = {
    "none": {},
    "named": {"hub_compliance": {"camber_Nm_deg": 5000.0, "toe_Nm_deg": 9000.0}},
    "friction": {"steering_friction": {"force_N": 200.0, "presliding_mm": 0.05}},
    "class": {"steer_arm_compliance": {"radius_mm": 8.0}},
    "unexplained": {"tie_rod_free_play": {"gap_mm": 0.2}},
    "two": {"strut_friction": {"force_N": 120.0}, "rig_channel_gain": {"toe": 1.06}},
    "pair": {
        "hub_compliance": {"camber_Nm_deg": 4000.0, "toe_Nm_deg": 7000.0},
        "steering_friction": {"force_N": 200.0, "presliding_mm": 0.05},
    },
    "mounted": {
        "steering_friction": {"force_N": 200.0, "presliding_mm": 0.03, "law": "iwan"},
        "rack_mount_compliance": {"k_N_mm": 4000.0},
    },
    "steady": {"strut_friction": {"force_N": 150.0}},
    "rubber": {"rubber_hysteresis": {"share": 0.3, "yield_mm": 0.1, "spread": 0.5}},
    "rear_rubber": {"rubber_hysteresis": {"bushings": ["LLR"], "share": 0.4, "yield_mm": 0.1, "spread": 0.5}},
    "lead": {"tie_rod_compliance": {"k_N_mm": 3000.0}},
    "progression": {"bushing_progression": {"UPB": [0.1, 0.1, 0.1]}},
    "beyond": {"hub_compliance": {"camber_Nm_deg": 15000.0, "toe_Nm_deg": 30000.0}},
}
"""Name of a car -> effects in it."""
LATERAL = ("lateral", "lateral_opposite")
"""Enough to name a compliant hub."""
OFF_NOMINAL = {
    "beyond": {"LLF.z": 4.0, "LLR.z": -3.8, "ROB.z": -4.0, "UPB.y": 3.9, "llr.Fx": -0.6},
}
"""Name of a car -> its scatter, where it is another than SCATTER."""
LOOPS_BEFORE = {"steady": 1}
"""Name of a car -> loops that its rig drives before it records."""


@lru_cache(maxsize=1)
def nominal() -> Axle:
    """The example's axle with the few load cases."""
    axle = read_axle(AXLE)
    return replace(axle, load_cases={k: v for k, v in axle.load_cases.items() if k in LOAD_CASES})


@lru_cache(maxsize=1)
def space() -> Space:
    """The tunable parameters."""
    return build_space(nominal(), VariableOptions.model_validate({"use": TUNABLE}), "test")


def library(*effects: str) -> list[Hypothesis]:
    """All hypotheses of effects, by default of the small library."""
    return [h for ident in effects or LIBRARY for h in EFFECTS[ident].hypotheses()]


@cache
def hidden_axle(car: str) -> Axle:
    """The axle of a car: nominal with scatter and its hidden effects."""
    values, scatter = nominal().values, OFF_NOMINAL.get(car, SCATTER)
    axle = with_values(nominal(), {k: values[f"{k}@L"] + v for k, v in scatter.items()})
    for ident, options in HIDDEN[car].items():
        axle = apply_effect(axle, ident, options, source="test")
    return axle.conditioned(LOOPS_BEFORE.get(car, 0))


@cache
def records(car: str, seed: int = 1) -> Measurement:
    """Reduced records of a car: its solved curves on a measured car's grid, noise drawn from its model."""
    like = _noise()
    axle = hidden_axle(car)
    solved = observed(axle, curve_set(solve(axle)))
    rng = np.random.default_rng([seed, *car.encode()])
    cases = {name: _case(like, solved, name, rng) for name in LOAD_CASES}
    assert solved.static is not None
    static = {r: solved.static[r] + 0.005 * rng.standard_normal(2) for r in like.curves.static or {}}
    return replace(like, curves=CurveSet("synthetic", cases, static, solved.half_track))


@lru_cache(maxsize=1)
def _noise() -> Measurement:
    return reduce_measurement(RIG / NOISE_OF)


def _case(like: Measurement, solved: CurveSet, name: str, rng: np.random.Generator) -> CaseCurves:
    ours, theirs = solved.cases[name], like.curves.cases[name]

    def drawn(curve: FloatArray, covariance: FloatArray) -> FloatArray:
        values, vectors = np.linalg.eigh(covariance)
        error = vectors @ (np.sqrt(np.maximum(values, 0.0)) * rng.standard_normal(values.size))
        return np.asarray(np.interp(theirs.input, ours.input, curve) + error)

    mean, half = {}, {}
    for r in RIG_RESPONSES:
        noise = like.noise[name][r]
        mean[r] = np.array([drawn(ours.mean[r][s], noise.covariance(side=s)) for s in (0, 1)])
        half[r] = np.array(
            [drawn(ours.half_width[r][s], noise.half_width_covariance(side=s)) for s in (0, 1)]
        )
    return CaseCurves(name, theirs.input_unit, theirs.input, mean, half)


def model(car: str, load_cases: Sequence[str] = LOAD_CASES) -> EffectModel:
    """The nominal axle against a car's records."""
    axle = replace(nominal(), load_cases={name: nominal().load_cases[name] for name in load_cases})
    return EffectModel(axle, space(), record_likelihood(axle, records(car)))


@cache
def discovery(car: str) -> Discovery:
    """What is found in a car."""
    return discover(model(car), known_to(car))


def known_to(car: str) -> list[Hypothesis]:
    """The library that a car is searched with."""
    if car == "unexplained":
        return library("strut_bending", "strut_friction", "bushing_progression")
    if car == "class":  # a typical steer arm so weak that it is as plausible as a weak tie rod
        (arm,) = library("steer_arm_compliance")
        weak = replace(arm, sizes=tuple(replace(s, typical=9.0) for s in arm.sizes))
        return [weak, *library("tie_rod_compliance", "hub_compliance", "strut_friction")]
    if car in ("two", "steady"):  # friction takes its time
        return library("strut_friction", "rig_channel_gain", "hub_compliance")
    if car == "pair":
        return library("hub_compliance", "steering_friction", "strut_bending", "tie_rod_compliance")
    if car == "friction":
        return library(*(e for e in LIBRARY if e != "bushing_progression"))
    return library()
