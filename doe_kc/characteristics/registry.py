"""The registry of characteristics: what each is read from, and what Appendices B and C ask of it.

A rig sees caster only as the rotation of the wheel, so the entry that is compared with a measurement
(Appendix B, caster compensation) reads the kingpin line carried by the knuckle; the caster columns of
Appendix C are those of the kingpin axis itself, LWB to UPB, which only a model knows: with it the
published column correlates to 0.99, with the carried line to 0.88.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Flag, auto
from typing import Literal

CharacteristicKind = Literal["static", "gradient"]
Abscissa = Literal["input", "wheel_travel", "pad_travel"]


@dataclass(frozen=True, kw_only=True)
class Characteristic:
    """A scalar read off the curves of the left wheel.

    id: `load_case.name`, unique; equals the column name of Appendix C where it is one.
    response: curve that it is read from (`doe_kc.curves.RESPONSE_UNITS`).
    kind: "static" = absolute static angle; "gradient" = slope of the least-squares line through the
        mean curve inside the load case's fit window, at the static state.
    abscissa: what the slope is taken over: the load-case input, the wheel centre's travel in the
        chassis frame, or the vertical travel of the pad under the wheel.
    scale: factor from (response unit / abscissa unit) to `unit`.
    objective, constraint: defaults of Appendix B; both False outside it.
    """

    id: str
    label: str
    symbol: str
    unit: str
    load_case: str
    response: str
    kind: CharacteristicKind = "gradient"
    abscissa: Abscissa = "input"
    scale: float = 1.0
    objective: bool = False
    constraint: bool = False
    in_appendix_b: bool = False
    in_appendix_c: bool = False


class Use(Flag):
    """What the thesis uses a characteristic for: Appendix B (objective, constraint), column of Appendix C."""

    B = auto()
    C = auto()
    OBJECTIVE = auto()
    CONSTRAINT = auto()


B, C = Use.B, Use.C
OB, OKB = B | Use.OBJECTIVE, B | Use.OBJECTIVE | Use.CONSTRAINT

READING: dict[str, tuple[CharacteristicKind, Abscissa, float]] = {
    "deg": ("static", "input", 1.0),
    "deg/deg": ("gradient", "input", 1.0),
    "deg/kN": ("gradient", "input", 1000.0),
    "mm/kN": ("gradient", "input", 1000.0),
    "%": ("gradient", "input", 100.0),
    "deg/m": ("gradient", "wheel_travel", 1000.0),
    "mm/m": ("gradient", "wheel_travel", 1000.0),
    "N/mm": ("gradient", "pad_travel", 1.0),
}
"""Unit -> kind, abscissa and scale, which it settles for every characteristic of the rig."""

# id, label, symbol, unit, response, use. The order is that of every array of all characteristics, such as
# `Outcome.characteristics`, and of the rows of the reports.
CHARACTERISTIC_TABLE: tuple[tuple[str, str, str, str, str, Use], ...] = (
    ("brake.brake_steer", "Brake steer", "d delta / d F_x", "deg/kN", "toe", OKB | C),
    ("brake.wind_up", "Wind-up", "d tau / d F_x", "deg/kN", "spin", OKB | C),
    ("brake.anti_dive", "Load transfer (anti-dive)", "d F_z / d F_x", "%", "tyre_load", OB | C),
    ("brake.wc_longitudinal_disp", "WC longitudinal displacement", "d x / d F_x", "mm/kN", "wc_x", OKB | C),
    ("drive.drive_steer", "Drive steer", "d delta / d F_x", "deg/kN", "toe", OKB | C),
    ("drive.anti_lift", "Load transfer (anti-lift)", "d F_z / d F_x", "%", "tyre_load", OB | C),
    ("drive.wc_longitudinal_disp", "WC longitudinal displacement", "d x / d F_x", "mm/kN", "wc_x", OKB | C),
    ("lateral.camber_change", "Camber change", "d gamma / d F_y", "deg/kN", "camber", OKB | C),
    ("lateral.toe_change", "Toe change", "d delta / d F_y", "deg/kN", "toe", B | C),
    ("lateral.wc_lateral_disp", "WC lateral displacement", "d y / d F_y", "mm/kN", "wc_y", OKB | C),
    ("lateral_offset.camber_change", "Camber change", "d gamma / d F_y", "deg/kN", "camber", OKB | C),
    ("lateral_offset.toe_change", "Toe change", "d delta / d F_y", "deg/kN", "toe", B | C),
    ("lateral_offset.wc_lateral_disp", "WC lateral displacement", "d y / d F_y", "mm/kN", "wc_y", OKB | C),
    ("lateral_opposite.camber_change", "Camber change", "d gamma / d F_y", "deg/kN", "camber", OKB),
    ("lateral_opposite.toe_change", "Toe change", "d delta / d F_y", "deg/kN", "toe", OKB),
    ("lateral_opposite.wc_lateral_disp", "WC lateral displacement", "d y / d F_y", "mm/kN", "wc_y", OKB),
    ("roll.camber_change", "Camber change", "d gamma / d z", "deg/m", "camber", B | C),
    ("roll.roll_steer", "Roll steer", "d delta / d z", "deg/m", "toe", B | C),
    ("roll.wc_lateral_disp", "WC lateral displacement", "d y / d z", "mm/m", "wc_y", C),
    ("roll.roll_rate", "Roll rate", "d F_z / d z_pad", "N/mm", "tyre_load", B),
    ("static.toe", "Static toe", "delta_0", "deg", "toe", OKB),
    ("static.camber", "Static camber", "gamma_0", "deg", "camber", OKB),
    ("static.caster", "Static caster", "tau_0", "deg", "spin", OKB),
    ("steer.steering_ratio", "Steering ratio", "d delta / d delta_H", "deg/deg", "toe", OB | C),
    ("vertical.camber_change", "Camber change", "d gamma / d z", "deg/m", "camber", OKB | C),
    ("vertical.bump_steer", "Bump steer", "d delta / d z", "deg/m", "toe", OKB | C),
    ("vertical.static_caster", "Static caster, kingpin", "tau_k0", "deg", "caster", C),
    ("vertical.caster_change", "Caster change, kingpin", "d tau_k / d z", "deg/m", "caster", C),
    ("vertical.caster_compensation", "Caster compensation", "d tau / d z", "deg/m", "spin", OB),
    ("vertical.ride_rate", "Ride rate", "d F_z / d z_pad", "N/mm", "tyre_load", OB),
)

APPENDIX_C_ORDER = (
    *("vertical.camber_change", "vertical.bump_steer", "vertical.static_caster", "vertical.caster_change"),
    *("roll.camber_change", "roll.roll_steer", "roll.wc_lateral_disp"),
    "steer.steering_ratio",
    *("lateral.camber_change", "lateral.toe_change", "lateral.wc_lateral_disp"),
    *("lateral_offset.camber_change", "lateral_offset.toe_change", "lateral_offset.wc_lateral_disp"),
    *("drive.drive_steer", "drive.anti_lift", "drive.wc_longitudinal_disp"),
    *("brake.brake_steer", "brake.wind_up", "brake.anti_dive", "brake.wc_longitudinal_disp"),
)


def _entry(ident: str, label: str, symbol: str, unit: str, response: str, use: Use) -> Characteristic:
    kind, abscissa, scale = READING[unit]
    return Characteristic(
        id=ident,
        label=label,
        symbol=symbol,
        unit=unit,
        load_case=ident.split(".")[0],
        response=response,
        kind=kind,
        abscissa=abscissa,
        scale=scale,
        objective=Use.OBJECTIVE in use,
        constraint=Use.CONSTRAINT in use,
        in_appendix_b=Use.B in use,
        in_appendix_c=Use.C in use,
    )


def by_id(entries: Iterable[Characteristic]) -> dict[str, Characteristic]:
    """Id -> characteristic, in order; ValueError for an id that occurs twice."""
    out: dict[str, Characteristic] = {}
    for entry in entries:
        if entry.id in out:
            raise ValueError(f"characteristic {entry.id} is registered twice")
        out[entry.id] = entry
    return out


CHARACTERISTICS = by_id(_entry(*row) for row in CHARACTERISTIC_TABLE)


def appendix_c() -> list[Characteristic]:
    """The 21 columns of Appendix C, in their order."""
    return [CHARACTERISTICS[i] for i in APPENDIX_C_ORDER]
