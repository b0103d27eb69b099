"""Static angles of the bench that contradict the records, the model, or each other."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from doe_kc.curves import SIDE_WORDS, SIDES
from doe_kc.measurement.checks._base import RecordFinding, RigTest, rig_check
from doe_kc.measurement.checks.identity.slopes import column, measured_slopes, row

CASTER_OFF = 1.0
"""deg between the stated caster and that of camber over toe in steer, which agree within 2 % on any axle."""
MODEL_OFF = {"toe": 0.5, "camber": 1.5, "spin": 2.5}
"""deg between bench and model beyond which one of them is of another car, or in another unit."""
SIDES_OFF = {"toe": 0.5, "camber": 0.8, "spin": 1.5}
"""deg between left and right beyond which no axle is set."""
_KEYS = {"toe": "toe_deg", "camber": "camber_deg", "spin": "caster_deg"}


@rig_check
def alignment(test: RigTest) -> Iterator[RecordFinding]:
    """Of each angle: against steer, then the other wheel, then the model; the first that fails."""
    if test.manifest.alignment is None:
        return
    leaning = steering_casters(test)
    for response, key in _KEYS.items():
        values = stated(test, key)
        if not np.isfinite(values).any():
            continue
        fault = (_against_steer(values, leaning) if response == "spin" else None) or (
            _against_model(test, response, values) or _against_each_other(response, values)
        )
        if fault is not None:
            yield RecordFinding(
                kind="alignment",
                severity="warning",
                case="static",
                channel=key.removesuffix("_deg"),
                where=str(test.source),
                evidence=f"[alignment] {key} {fault}",
                cure="check its sign (toe-in, top outwards, top rearwards +), unit and sides",
            )


def stated(test: RigTest, key: str) -> np.ndarray:
    """(2,) of the bench, left and right, deg; nan where it gave none."""
    bench = test.manifest.alignment
    sides = (None, None) if bench is None else (bench.left, bench.right)
    values = [None if side is None else getattr(side, key) for side in sides]
    return np.array([np.nan if v is None else v for v in values])


def steering_casters(test: RigTest) -> np.ndarray:
    """(2,) caster by the lean of the steering axis: -d camber / d toe = tan(caster), deg; nan without
    steer."""
    slope = measured_slopes(test).slope[row("steer")]
    with np.errstate(divide="ignore", invalid="ignore"):
        lean = -slope[column("camber")] / slope[column("toe")]
    return np.asarray(np.degrees(np.arctan(lean)))


def _against_steer(values: np.ndarray, leaning: np.ndarray) -> str | None:
    for side, (value, lean) in enumerate(zip(values, leaning, strict=True)):
        if math.isfinite(value) and abs(value - lean) > CASTER_OFF:
            where = SIDE_WORDS[SIDES[side]]
            return f"is {value:g} on the {where}, the steer records show {lean:.2f} (camber over toe)"
    return None


def _against_model(test: RigTest, response: str, values: np.ndarray) -> str | None:
    if test.model is None or test.model.static is None or response not in test.model.static:
        return None
    for side, value in enumerate(values):
        ours = float(test.model.static[response][side])
        if math.isfinite(value) and abs(value - ours) > MODEL_OFF[response]:
            return f"is {value:g} on the {SIDE_WORDS[SIDES[side]]}, the axle's {ours:.2f}"
    return None


def _against_each_other(response: str, values: np.ndarray) -> str | None:
    if abs(values[0] - values[1]) > SIDES_OFF[response]:
        return f"is {values[0]:g} on the left and {values[1]:g} on the right"
    return None
