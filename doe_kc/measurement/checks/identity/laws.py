"""What slopes must be: laws of any suspension, the model's slopes, how far a sound car may be from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.curves import RIG_RESPONSES, WHEEL_CENTRE
from doe_kc.ground.typing import FloatArray, IntArray
from doe_kc.load_cases import CASE_ORDER
from doe_kc.measurement.checks.identity.slopes import SlopeTable, column, mirror_signs, row

SLOPE_LAWS: Mapping[tuple[str, str], tuple[float, float]] = {
    ("vertical", "wc_z"): (0.7, 1.0),
    ("vertical", "tyre_load"): (8.0, 80.0),
    ("roll", "wc_z"): (-14.0, -7.0),
    ("roll", "tyre_load"): (-2500.0, -150.0),
    ("lateral", "wc_y"): (5e-5, 1e-3),
    ("lateral", "camber"): (1e-5, 5e-4),
    ("lateral", "tyre_load"): (0.01, 0.3),
    ("lateral_opposite", "wc_y"): (2e-5, 1e-3),
    ("lateral_opposite", "camber"): (5e-6, 5e-4),
    ("lateral_offset", "wc_y"): (5e-5, 1e-3),
    ("lateral_offset", "camber"): (1e-5, 5e-4),
    ("lateral_offset", "tyre_load"): (0.01, 0.3),
    ("drive", "wc_x"): (-6e-3, -2e-4),
    ("drive", "spin"): (2e-5, 4e-4),
    ("brake", "wc_x"): (4e-4, 8e-3),
    ("brake", "spin"): (-1.2e-3, -6e-5),
}
"""(load case, response) -> slopes of the left wheel, response per input unit, of independent axles and beams.

Signs follow from positive work of the force, from the load of the pad that is raised, and from the moment of
a force at the ground about the ball joints; sizes are those of measured cars and of reference axles
(McPherson,
double wishbone, five-link, semi-trailing, twist beam, rigid), widened.
"""
CAP = 25.0
"""Of one term: what is wrong by five standard deviations is wrong."""
_MODEL_SHARE = 0.5
"""Of the model's slope: what parameters and unknown effects change."""
_MIRROR_SHARE = 0.12
"""Of the slope: difference of the sides from production and left-right asymmetry."""
_SCALES: Mapping[str, tuple[float, float, float]] = {
    "vertical": (2e-3, 6e-3, 3.0),
    "roll": (0.03, 0.08, 60.0),
    "force": (3e-5, 8e-5, 0.02),
    "steer": (2e-3, 4e-3, 0.3),
}
"""Load case -> slopes of angle (deg), position (mm), load (N) per input unit that sound cars differ by."""


CASTER_TANGENT = 0.087
"""Of 5 deg, the caster of a steered axle; 0.04 is granted either way."""
INDEPENDENT = 5e-3
"""Camber over wheel travel, deg/mm, below which vertical motion and roll have nothing in common: beam
axles."""
_USUAL_NOISE = np.array(
    [4.0 if r == "tyre_load" else 0.02 if r in WHEEL_CENTRE else 3e-3 for r in RIG_RESPONSES]
)


@dataclass(frozen=True)
class Expectation:
    """What a test's slopes are compared with.

    model: (8, 7) slopes of the left wheel, nan where unknown. load: stated wheel load, N, or None.
    """

    model: FloatArray
    load: float | None


def scales() -> FloatArray:
    """(8, 7) slopes that sound cars differ by."""
    out = np.empty((len(CASE_ORDER), len(RIG_RESPONSES)))
    for case in CASE_ORDER:
        angle, position, load = _SCALES.get(case, _SCALES["force"])
        for response in RIG_RESPONSES:
            kind = load if response == "tyre_load" else position if response.startswith("wc") else angle
            out[row(case), column(response)] = kind
    return out


_SCALE = scales()
_MIRROR = mirror_signs()
_LOW = np.full(_SCALE.shape, np.nan)
_HIGH = np.full(_SCALE.shape, np.nan)
for (_case, _response), (_a, _b) in SLOPE_LAWS.items():
    _LOW[row(_case), column(_response)], _HIGH[row(_case), column(_response)] = _a, _b


def misfit(table: SlopeTable, expected: Expectation, source: IntArray | None = None) -> FloatArray:
    """(h,) about -2 ln likelihood of h tables: laws, model, mirror, load at rest, noise, relations.

    table: arrays with a leading axis of h. source: (h, 8) row whose expectations hold for each row, by
    default
    its own.
    """
    rows = np.arange(len(CASE_ORDER))[None] if source is None else source
    mirror, scale = _MIRROR[rows], _SCALE[rows]
    slope = table.slope
    left, right = slope[..., 0], mirror * slope[..., 1]
    mean = np.where(np.isnan(left), right, np.where(np.isnan(right), left, (left + right) / 2.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(
            _law_misfit(mean, _LOW[rows], _HIGH[rows])
            + _model_misfit(mean, expected.model[rows], scale)
            + _mirror_misfit(left, right, scale)
            + _rest_misfit(table.rest, expected.load)
            + _noise_misfit(table.noise)
            + _relation_misfit(slope)
        )


def _total(terms: FloatArray) -> FloatArray:
    """(h,) sum of capped terms, those that are not known left out."""
    return np.asarray(np.nansum(np.minimum(terms, CAP), axis=tuple(range(1, terms.ndim))))


def _law_misfit(mean: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Of slopes outside their interval: by their ratio to its nearer end, and by sign."""
    small, large = np.minimum(np.abs(low), np.abs(high)), np.maximum(np.abs(low), np.abs(high))
    size = mean * np.sign(low)
    beyond = np.maximum(np.log(small / np.abs(size)), np.log(np.abs(size) / large))
    wrong = np.where(size < 0.0, 2.0 * CAP * np.minimum(np.abs(size) / small, 1.0), 0.0)
    return _total(wrong + (np.maximum(beyond, 0.0) / 0.5) ** 2)


def _model_misfit(mean: FloatArray, model: FloatArray, scale: FloatArray) -> FloatArray:
    sd = np.hypot(_MODEL_SHARE * model, scale)
    return 2.0 * _total(((mean - model) / sd) ** 2)


def _mirror_misfit(left: FloatArray, right: FloatArray, scale: FloatArray) -> FloatArray:
    size = np.maximum(np.abs(left), np.abs(right))
    sd = np.hypot(_MIRROR_SHARE * size, 0.4 * scale)
    return _total(((left - right) / 2.0 / sd) ** 2)


def _rest_misfit(rest: FloatArray, load: float | None) -> FloatArray:
    """Of tyre loads at rest: within 1.6 times the stated one either way, or 1 to 15 kN."""
    low, high = (1000.0, 15000.0) if load is None else (load / 1.6, load * 1.6)
    beyond = np.maximum(np.log(low / rest), np.log(rest / high))
    beyond = np.where(rest <= 0.0, 3.0, np.maximum(beyond, 0.0))
    return _total((beyond / 0.3) ** 2)


def _noise_misfit(noise: FloatArray) -> FloatArray:
    """Of channels whose noise differs by decades from that of the others, each in units of its resolution."""
    if not np.isfinite(noise).any() or not np.nanmin(noise) > 0.0:
        return np.zeros(noise.shape[0])
    decades = np.log10(noise / _USUAL_NOISE[:, None])
    usual = np.nanmedian(decades, axis=(1, 2, 3), keepdims=True)
    return 0.4 * _total(((decades - usual) / 0.6) ** 2)


def _relation_misfit(slope: FloatArray) -> FloatArray:
    """Of angles over wheel travel, alike in vertical motion and roll of independent wheels, and of camber
    over
    toe in steer, -tan(caster)."""
    vertical, roll, steer = (slope[:, row(c)] for c in ("vertical", "roll", "steer"))
    travel, camber = column("wc_z"), column("camber")
    over = vertical / vertical[:, travel : travel + 1]
    over_roll = roll / roll[:, travel : travel + 1]
    independent = np.abs(over[:, camber].mean(axis=-1, keepdims=True)) > INDEPENDENT
    terms = []
    for response, least in (("camber", 3e-3), ("spin", 5e-3), ("toe", 6e-3)):
        at = column(response)
        sd = np.hypot(0.25 * over[:, at], least)
        terms.append(np.where(independent, ((over_roll[:, at] - over[:, at]) / sd) ** 2, 0.0))
    lean = -steer[:, camber] / steer[:, column("toe")]
    terms.append(((lean - CASTER_TANGENT) / 0.04) ** 2)
    return _total(np.stack(terms, axis=1))
