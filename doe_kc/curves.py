"""K&C curves of one axle, simulated or measured: the common currency of the package.

Angles in deg, positions in mm, loads in N; row 0 is the left wheel, row 1 the right.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from doe_kc.ground.typing import FloatArray

SIDE_WORDS = {"L": "left", "R": "right"}

SIDES = ("L", "R")

ANGLES = ("toe", "camber", "caster", "spin")
"""Responses whose static value is an alignment figure; curves hold their change from static."""

WHEEL_CENTRE = ("wc_x", "wc_y", "wc_z")
TYRE_LOAD = "tyre_load"
RIG_RESPONSES = ("toe", "camber", "spin", "wc_x", "wc_y", "wc_z", "tyre_load")
"""What a K&C rig sees of each wheel (the rig's caster channel is `spin`)."""

RESPONSE_UNITS: Mapping[str, str] = {
    "toe": "deg",
    "camber": "deg",
    "caster": "deg",
    "spin": "deg",
    "wc_x": "mm",
    "wc_y": "mm",
    "wc_z": "mm",
    "tyre_load": "N",
}
RESPONSE_NAMES: Mapping[str, str] = {
    "spin": "caster (knuckle)",
    "wc_x": "wheel centre x",
    "wc_y": "wheel centre y",
    "wc_z": "wheel centre z",
    "tyre_load": "tyre load",
}
"""Within a sentence, where that is not the identifier."""
RESPONSE_LABELS: Mapping[str, str] = {
    "toe": "Toe angle (toe-in +)",
    "camber": "Camber angle (top outwards +)",
    "caster": "Caster angle, kingpin",
    "spin": "Caster angle, knuckle",
    "wc_x": "Wheel centre x (rearwards +)",
    "wc_y": "Wheel centre y (right +)",
    "wc_z": "Wheel centre z (up +)",
    "tyre_load": "Tyre load",
}


@dataclass(frozen=True)
class CaseCurves:
    """One load case: mean curve and half-width (hysteresis) curve of every response.

    input: (n,) load-case input in its unit, strictly increasing, contains 0.
    mean: response -> (2, n); change from static for angles and wheel centre, absolute for tyre_load.
    half_width: response -> (2, n), (value with falling input - value with rising input) / 2;
        zero without friction.
    """

    load_case: str
    input_unit: str
    input: FloatArray
    mean: Mapping[str, FloatArray]
    half_width: Mapping[str, FloatArray]


@dataclass(frozen=True)
class CurveSet:
    """All load cases of one axle.

    static: response -> (2,) absolute static angles in deg; None when no alignment is known, then only
        changes are compared.
    half_track: |y| of the design wheel centre in mm, turns body roll into pad travel.
    """

    source: str
    cases: Mapping[str, CaseCurves]
    static: Mapping[str, FloatArray] | None
    half_track: float


@dataclass(frozen=True)
class CurveBatch:
    """Curves of d designs of one axle: as in `CurveSet`, with an axis of designs.

    cases: mean and half_width (2, d, n); static: (2, d); half_track: (d, 1).
    """

    source: str
    cases: Mapping[str, CaseCurves]
    static: Mapping[str, FloatArray]
    half_track: FloatArray

    def design(self, i: int) -> CurveSet:
        """Curves of one design."""
        cases = {
            ident: CaseCurves(
                case.load_case,
                case.input_unit,
                case.input,
                {name: curve[:, i] for name, curve in case.mean.items()},
                {name: curve[:, i] for name, curve in case.half_width.items()},
            )
            for ident, case in self.cases.items()
        }
        static = {name: angles[:, i] for name, angles in self.static.items()}
        return CurveSet(self.source, cases, static, float(self.half_track[i, 0]))


def response_name(response: str) -> str:
    """Short name of a response within a sentence or an axis."""
    return RESPONSE_NAMES.get(response, response)
