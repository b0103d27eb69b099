"""The registry entry of one characteristic."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


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
    kind: Literal["static", "gradient"] = "gradient"
    abscissa: Literal["input", "wheel_travel", "pad_travel"] = "input"
    scale: float = 1.0
    objective: bool = False
    constraint: bool = False
    in_appendix_b: bool = False
    in_appendix_c: bool = False


CHARACTERISTICS: dict[str, Characteristic] = {}


def characteristic(entry: Characteristic) -> Characteristic:
    """Register a characteristic; ValueError when the id is taken."""
    if entry.id in CHARACTERISTICS:
        raise ValueError(f"characteristic {entry.id} is registered twice")
    CHARACTERISTICS[entry.id] = entry
    return entry


APPENDIX_C_ORDER = (
    "vertical.camber_change",
    "vertical.bump_steer",
    "vertical.static_caster",
    "vertical.caster_change",
    "roll.camber_change",
    "roll.roll_steer",
    "roll.wc_lateral_disp",
    "steer.steering_ratio",
    "lateral.camber_change",
    "lateral.toe_change",
    "lateral.wc_lateral_disp",
    "lateral_offset.camber_change",
    "lateral_offset.toe_change",
    "lateral_offset.wc_lateral_disp",
    "drive.drive_steer",
    "drive.anti_lift",
    "drive.wc_longitudinal_disp",
    "brake.brake_steer",
    "brake.wind_up",
    "brake.anti_dive",
    "brake.wc_longitudinal_disp",
)


def appendix_c() -> list[Characteristic]:
    """The 21 columns of Appendix C, in their order."""
    return [CHARACTERISTICS[i] for i in APPENDIX_C_ORDER]
