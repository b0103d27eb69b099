"""K&C tables of an axle as vehicle models ask for them: kinematic tables, compliance coefficients.

Frame of these tables: ISO 8855, X forwards, Y to the left, Z up; toe and camber by wheel, toe-in and top
outwards positive. Keys are those by which CarSim names the quantity; CarMaker asks for the same ones as
translations (t) and rotations (r) of the wheel carrier.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.characteristics.reduction import fit_window, pad_travel, slope
from doe_kc.curves import SIDES, CaseCurves, CurveSet
from doe_kc.ground.output import Columns
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases.force import LateralOffset

LEFTWARDS = {"L": -1.0, "R": 1.0}
"""Sign of toe-in as a steer angle to the left, and of camber as an inclination to the right."""


@dataclass(frozen=True)
class KinematicQuantity:
    """A column of a kinematic table. key: CarSim's name; carrier: CarMaker's; positive: what + means."""

    column: str
    key: str
    carrier: str
    unit: str
    positive: str
    response: str
    sign: float = 1.0
    sided: bool = False
    """Whether the sign is the other one on the right."""


KINEMATIC_QUANTITIES = (
    KinematicQuantity("jounce_mm", "jounce", "tz", "mm", "wheel centre up", "wc_z"),
    KinematicQuantity("toe_deg", "TOE_TABLE", "rz", "deg", "toe-in", "toe"),
    KinematicQuantity("camber_deg", "CAMBER_TABLE", "rx", "deg", "top outwards", "camber"),
    KinematicQuantity(
        "dive_deg", "SUSP_DIVE_AXLE_TABLE", "ry", "deg", "carrier's top forwards", "spin", -1.0
    ),
    KinematicQuantity("x_mm", "SUSP_X", "tx", "mm", "wheel centre forwards", "wc_x", -1.0),
    KinematicQuantity("y_mm", "SUSP_LAT_TABLE", "ty", "mm", "wheel centre outwards", "wc_y", 1.0, sided=True),
    KinematicQuantity("load_N", "FS", "Fz", "N", "tyre load, compression", "tyre_load"),
)


@dataclass(frozen=True, kw_only=True)
class ComplianceCoefficient:
    """One slope near rest. key: CarSim's name. value: in `unit`. positive: what + of the response and of the
    load mean. source: load cases that it comes from, with the half-width of their fit windows."""

    key: str
    label: str
    side: str
    value: float
    unit: str
    positive: str
    source: str


def kinematic_columns(curves: CurveSet, load_case: str) -> Columns:
    """Rows by side and input of `vertical` or `steer`: changes from static, the tyre load absolute."""
    case = curves.cases[load_case]
    parts: dict[str, list[Any]] = {"side": [], f"input_{case.input_unit}": []}
    parts |= {q.column: [] for q in KINEMATIC_QUANTITIES}
    for row, side in enumerate(SIDES):
        parts["side"] += [side] * case.input.size
        parts[f"input_{case.input_unit}"] += case.input.tolist()
        for q in KINEMATIC_QUANTITIES:
            sign = q.sign * (LEFTWARDS[side] if q.sided else 1.0)
            parts[q.column] += (sign * case.mean[q.response][row] + 0.0).tolist()
    return parts


def compliance_coefficients(axle: Axle, curves: CurveSet, radius: float) -> Iterator[ComplianceCoefficient]:
    """Coefficients of both wheels from the force cases, pads held; those whose case is missing are left out.

    radius: of the wheel centre above the contact point, mm. A moment about the wheel's axle is brake at the
    ground less the same force at the wheel centre; an aligning moment is the lateral force behind the contact
    point less that in it.
    """
    for row, side in enumerate(SIDES):
        slopes = _Slopes(curves, row)
        if slopes.has("drive"):
            yield from _longitudinal(slopes, side)
        if slopes.has("drive", "brake"):
            yield from _axle_moment(slopes, side, radius)
        if slopes.has("lateral"):
            yield from _lateral(slopes, side)
        if slopes.has("lateral", "lateral_offset"):
            yield from _aligning(slopes, side, _offset(axle))
    if {"vertical", "roll"} <= curves.cases.keys():
        yield _auxiliary_roll(axle, curves)


def _offset(axle: Axle) -> float:
    """mm behind the contact point."""
    case = axle.load_cases["lateral_offset"]
    assert isinstance(case, LateralOffset)
    return case.offset


@dataclass(frozen=True)
class _Slopes:
    """Slopes of one wheel's curves near rest."""

    curves: CurveSet
    row: int

    def has(self, *cases: str) -> bool:
        return all(case in self.curves.cases for case in cases)

    def __call__(self, case: str, response: str) -> float:
        c = self.curves.cases[case]
        inside = fit_window(c)
        return slope(c.input[inside], c.mean[response][self.row][inside])

    def source(self, *cases: str) -> str:
        return ", ".join(
            f"{c} +-{np.abs(self.curves.cases[c].input[fit_window(self.curves.cases[c])]).max():g} N"
            for c in cases
        )


def _longitudinal(s: _Slopes, side: str) -> Iterator[ComplianceCoefficient]:
    load, source = "forwards, at the wheel centre", s.source("drive")
    for key, label, response, sign, unit, positive in (
        ("CT_FX", "Toe", "toe", 1.0, "deg/N", "toe-in"),
        ("CC_FX", "Camber", "camber", 1.0, "deg/N", "top outwards"),
        ("CD_FX", "Dive", "spin", -1.0, "deg/N", "carrier's top forwards"),
        ("C_LONG", "Longitudinal", "wc_x", -1.0, "mm/N", "wheel centre forwards"),
    ):
        yield ComplianceCoefficient(
            key=f"{key}_COEFFICIENT",
            label=f"{label} by longitudinal force",
            side=side,
            value=sign * s("drive", response),
            unit=unit,
            positive=f"{positive}; force {load}",
            source=source,
        )


def _axle_moment(s: _Slopes, side: str, radius: float) -> Iterator[ComplianceCoefficient]:
    for key, label, response, sign, positive in (
        ("CT_MY", "Toe", "toe", 1.0, "toe-in"),
        ("CC_MY", "Camber", "camber", 1.0, "top outwards"),
        ("CD_MY", "Dive", "spin", -1.0, "carrier's top forwards"),
    ):
        moment = (s("brake", response) + s("drive", response)) / (radius / 1000.0)
        yield ComplianceCoefficient(
            key=f"{key}_COEFFICIENT",
            label=f"{label} by brake moment",
            side=side,
            value=sign * moment,
            unit="deg/Nm",
            positive=f"{positive}; moment that turns the carrier's top forwards (braking)",
            source=s.source("brake", "drive"),
        )


def _lateral(s: _Slopes, side: str) -> Iterator[ComplianceCoefficient]:
    """The load case's force is to the right; the coefficients are for one to the left."""
    for key, label, response, sign, unit, positive in (
        ("CS_FY", "Steer", "toe", -LEFTWARDS[side], "deg/N", "wheel steers to the left"),
        ("CI_FY", "Inclination", "camber", -LEFTWARDS[side], "deg/N", "wheel's top to the right"),
        ("C_LAT", "Lateral", "wc_y", 1.0, "mm/N", "wheel centre to the left"),
    ):
        yield ComplianceCoefficient(
            key=f"{key}_COEFFICIENT",
            label=f"{label} by lateral force",
            side=side,
            value=sign * s("lateral", response),
            unit=unit,
            positive=f"{positive}; force to the left, at the contact point, on both wheels",
            source=s.source("lateral"),
        )


def _aligning(s: _Slopes, side: str, offset: float) -> Iterator[ComplianceCoefficient]:
    for key, label, response, positive in (
        ("CS_MZ", "Steer", "toe", "wheel steers to the left"),
        ("CI_MZ", "Inclination", "camber", "wheel's top to the right"),
    ):
        moment = (s("lateral_offset", response) - s("lateral", response)) / (offset / 1000.0)
        yield ComplianceCoefficient(
            key=f"{key}_COEFFICIENT",
            label=f"{label} by aligning moment",
            side=side,
            value=LEFTWARDS[side] * moment,
            unit="deg/Nm",
            positive=f"{positive}; moment that steers to the left, on both wheels",
            source=s.source("lateral", "lateral_offset"),
        )


def _auxiliary_roll(axle: Axle, curves: CurveSet) -> ComplianceCoefficient:
    """Roll stiffness that the axle has beside its springs: 2 (k_roll - k_vertical) h^2 of the wheel rates."""
    tyre = axle.values["tyre.rate@L"]
    rates = []
    for case in ("roll", "vertical"):
        rate = _load_rate(curves.cases[case], curves.half_track)
        rates.append(1.0 / (1.0 / rate - 1.0 / tyre))
    moment = 2.0 * (rates[0] - rates[1]) * curves.half_track**2
    return ComplianceCoefficient(
        key="MX_AUX_COEFFICIENT",
        label="Auxiliary roll stiffness",
        side="axle",
        value=math.radians(moment) / 1000.0,
        unit="Nm/deg",
        positive="moment that rights the body",
        source="roll, vertical",
    )


def _load_rate(case: CaseCurves, half_track: float) -> float:
    """N/mm of tyre load per pad travel near rest, left wheel."""
    inside = fit_window(case)
    travel: FloatArray = pad_travel(case, half_track)
    return slope(travel[inside], case.mean["tyre_load"][0][inside])


def vehicle_document(curves: CurveSet, coefficients: list[ComplianceCoefficient]) -> dict[str, Any]:
    """Everything as one JSON document, with units and signs."""
    tables = {case: kinematic_columns(curves, case) for case in ("vertical", "steer") if case in curves.cases}
    return {
        "schema": "doe_kc.vehicle_tables/1",
        "axle": curves.source,
        "frame": "ISO 8855: X forwards, Y to the left, Z up",
        "static": {
            name: dict(zip(SIDES, map(float, values), strict=True))
            for name, values in (curves.static or {}).items()
        },
        "quantities": {
            q.column: {"key": q.key, "carrier": q.carrier, "unit": q.unit, "positive": q.positive}
            for q in KINEMATIC_QUANTITIES
        },
        "kinematics": tables,
        "compliance": [vars(c) for c in coefficients],
    }
