"""What no car has, though it can be solved: a warning each, with the range that passenger cars keep to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.geometry import point
from doe_kc.axle.model import BUSHING_AXES, Axle
from doe_kc.curves import SIDE_WORDS


@dataclass(frozen=True)
class Range:
    """A quantity that passenger cars keep within [lower, upper] `unit`; reason: why, in a clause.

    needs: points or values without which an axle does not have it.
    """

    name: str
    unit: str
    lower: float
    upper: float
    reason: str
    value: Callable[[Axle, str], float]
    needs: tuple[str, ...] = ()

    def applies(self, axle: Axle) -> bool:
        """Whether the axle has the quantity."""
        return all(any(n in axle.values for n in (name, f"{name}@L", f"{name}.x@L")) for name in self.needs)

    def warning(self, axle: Axle, side: str) -> str:
        """A sentence when the axle is outside; else empty. side: "L" or "R"."""
        value = self.value(axle, side)
        if self.lower <= value <= self.upper:
            return ""
        of_side = "" if self.name in axle.values else f" ({SIDE_WORDS[side]})"
        return (
            f"{self.name}{of_side} is {value:.4g} {self.unit}, outside {self.lower:g} to "
            f"{self.upper:g}: {self.reason}. Check value and unit."
        )


def _length(first: str, second: str) -> Callable[[Axle, str], float]:
    return lambda axle, side: float(np.linalg.norm(point(axle, first, side) - point(axle, second, side)))


def _of(name: str) -> Callable[[Axle, str], float]:
    return lambda axle, side: axle.values[f"{name}@{side}" if f"{name}@{side}" in axle.values else name]


def _arm(axle: Axle, side: str) -> float:
    """Distance of the lower ball joint from the line through the lower arm's bushings."""
    front, rear, ball = (point(axle, name, side) for name in ("LLF", "LLR", "LWB"))
    along = (rear - front) / np.linalg.norm(rear - front)
    return float(np.linalg.norm(np.cross(ball - front, along)))


def _steer_lever(axle: Axle, side: str) -> float:
    """Distance of the outer tie-rod ball from the kingpin axis."""
    lower, upper, outer = (point(axle, name, side) for name in ("LWB", "UPB", "ROB"))
    along = (upper - lower) / np.linalg.norm(upper - lower)
    return float(np.linalg.norm(np.cross(outer - lower, along)))


RANGES = (
    Range(
        "half track, |WLC.y|",
        "mm",
        500,
        1100,
        "road vehicles are 1.2 to 2.1 m wide",
        lambda a, s: -point(a, "WLC", s)[1],
    ),
    Range("WLC.z", "mm", 150, 600, "it is the loaded tyre radius", lambda a, s: point(a, "WLC", s)[2]),
    Range(
        "lower arm, LWB to the line LLF-LLR",
        "mm",
        100,
        700,
        "it has to leave room for the engine and the wheel",
        _arm,
        ("LLF", "LLR", "LWB"),
    ),
    Range(
        "lower arm, LLF to LLR",
        "mm",
        80,
        700,
        "its bushings take brake forces as a couple",
        _length("LLF", "LLR"),
        ("LLF", "LLR", "LWB"),
    ),
    Range(
        "tie rod, RIB to ROB",
        "mm",
        150,
        700,
        "it is about as long as the lower arm",
        _length("RIB", "ROB"),
        ("RIB", "ROB"),
    ),
    Range(
        "steer arm, ROB to the kingpin axis",
        "mm",
        50,
        250,
        "30 to 50 deg of wheel angle for 60 to 90 mm of rack",
        _steer_lever,
        ("LWB", "UPB", "ROB"),
    ),
    Range(
        "strut, LWD to UPB",
        "mm",
        200,
        900,
        "it holds spring and damper",
        _length("LWD", "UPB"),
        ("LWD", "UPB"),
    ),
    Range("static.toe", "deg", -2, 2, "more wears tyres off", _of("static.toe")),
    Range("static.camber", "deg", -6, 4, "more wears tyres off", _of("static.camber")),
    Range("tyre.rate", "N/mm", 80, 800, "passenger-car tyres have 150 to 350 N/mm", _of("tyre.rate")),
    Range("tyre.static_load", "N", 1000, 15000, "100 to 1500 kg a wheel", _of("tyre.static_load")),
    Range(
        "spring.rate",
        "N/mm",
        5,
        300,
        "ride frequencies lie between 0.8 and 4 Hz",
        _of("spring.rate"),
        ("spring.rate",),
    ),
    Range(
        "steering.rack_mm_per_rev",
        "mm",
        15,
        150,
        "locks are one to five turns apart",
        _of("steering.rack_mm_per_rev"),
        ("steering.rack_mm_per_rev",),
    ),
    Range("ride_height", "mm", -120, 120, "that is the whole travel of a wheel", _of("ride_height")),
)
"""Wide: they catch a wrong unit or a slip of a digit, not an unusual car."""

BUSHING_STIFFNESS = (1.0, 1e6)
"""N/mm of a bushing: softer than a spring it guides nothing, stiffer than 1000 kN/mm is bolted steel."""
CORNER_SIZE = 1000.0
"""mm between the wheel centre and any hardpoint of its own corner."""
MIDDLE = 50.0
"""mm from the car's middle plane within which no hardpoint of a side lies."""

AMPLITUDES = {
    "vertical": (200.0, "mm", "wheels travel 80 to 120 mm each way"),
    "steer": (1000.0, "deg", "steering wheels turn 1 to 1.8 times each way"),
    "lateral": (3.0, "static loads", "a tyre's grip is about its load"),
    "lateral_opposite": (3.0, "static loads", "a tyre's grip is about its load"),
    "lateral_offset": (3.0, "static loads", "a tyre's grip is about its load"),
    "drive": (3.0, "static loads", "a tyre's grip is about its load"),
    "brake": (3.0, "static loads", "a tyre's grip is about its load"),
}
"""Largest plausible amplitude of a load case; of roll by its unit, below."""
ROLL = {"deg": (15.0, "cars roll by 2 to 6 deg"), "mm": (200.0, "wheels travel 80 to 120 mm each way")}
RACK_TRAVEL = 120.0
"""mm each way; racks travel 60 to 90 mm."""


def axle_warnings(axle: Axle) -> tuple[str, ...]:
    """Sentences on what lies outside the ranges of passenger cars; none for a plausible axle.

    Of a symmetric axle those of the left side alone. Nothing is refused: the axle can be solved, or its
    failure says why not.
    """
    return tuple(dict.fromkeys([*_hardpoints(axle), *_ranges(axle), *_bushings(axle), *_sweeps(axle)]))


def _sides(axle: Axle) -> tuple[str, ...]:
    same = all(axle.values.get(f"{n[:-2]}@R", v) == v for n, v in axle.values.items() if n.endswith("@L"))
    return ("L",) if same else ("L", "R")


def _hardpoints(axle: Axle) -> Iterator[str]:
    for side in _sides(axle):
        centre = point(axle, "WLC", side)
        for name in axle.topology.structure.points:
            at = point(axle, name, side)
            where = f"hardpoint {name} ({SIDE_WORDS[side]}) at ({', '.join(f'{v:g}' for v in at)}) mm"
            if at[1] == 0.0:
                continue  # a point that both sides share
            if -at[1] < MIDDLE:
                yield (
                    f"{where} is within {MIDDLE:g} mm of the car's middle, where no part of one wheel's "
                    "suspension is. Check its unit: coordinates are in mm."
                )
            elif np.linalg.norm(at - centre) > CORNER_SIZE:
                yield (
                    f"{where} is {np.linalg.norm(at - centre):.0f} mm from the wheel centre; "
                    f"a suspension reaches {CORNER_SIZE:g} mm at most. Check value and unit."
                )


def _ranges(axle: Axle) -> Iterator[str]:
    for side in _sides(axle):
        for entry in RANGES:
            if entry.applies(axle) and (sentence := entry.warning(axle, side)):
                yield sentence


def _bushings(axle: Axle) -> Iterator[str]:
    lower, upper = BUSHING_STIFFNESS
    tables = {(name, axis) for name, axis, _ in axle.topology.tables}
    for side in _sides(axle):
        for name in [bush.name for bush in axle.topology.structure.bushings if not bush.single]:
            for axis in BUSHING_AXES[:3]:
                rate = axle.values[f"{name}.{axis}@{side}"] * axle.values[f"{name}.stiffness.{axis}@{side}"]
                if (name, axis) not in tables and not lower <= rate <= upper:
                    yield (
                        f"bushing {name} ({SIDE_WORDS[side]}) has {rate:.4g} N/mm along {axis}, outside "
                        f"{lower:g} to {upper:g}: softer guides nothing, stiffer is bolted steel. "
                        "Check value and unit."
                    )


def _sweeps(axle: Axle) -> Iterator[str]:
    for ident, case in axle.load_cases.items():
        limit, unit, reason = AMPLITUDES.get(ident, (np.inf, "", ""))
        if ident == "roll":
            (limit, reason), unit = ROLL[case.unit], case.unit
        size = case.amplitude / axle.values["tyre.static_load"] if unit == "static loads" else case.amplitude
        if size > limit:
            yield (
                f"load case {ident} goes to {case.amplitude:g} {case.unit}; "
                f"plausible are {limit:g} {unit} at most: {reason}."
            )
        if ident == "steer" and (rack := case.amplitude * axle.rack_mm_per_rev / 360.0) > RACK_TRAVEL:
            yield (
                f"load case steer moves the rack by {rack:.4g} mm each way; racks travel 60 to 90 mm, "
                f"{RACK_TRAVEL:g} mm at most."
            )
