"""What slopes must be: laws of any suspension, the model's slopes, how far a sound car may be from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.curves import RIG_RESPONSES, WHEEL_CENTRE
from doe_kc.ground.typing import FloatArray, IntArray
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES
from doe_kc.measurement.checks.identity.slopes import SlopeTable, column, mirror_signs, row

SLOPE_LAWS: Mapping[tuple[str, str], tuple[float, float]] = {
    ("vertical", "wc_z"): (0.7, 1.0),
    ("vertical", "tyre_load"): (8.0, 80.0),
    ("roll", "wc_z"): (-14.0, -7.0),
    ("roll", "tyre_load"): (-2500.0, -150.0),
    ("lateral", "camber"): (1e-5, 5e-4),
    ("lateral", "tyre_load"): (0.01, 0.3),
    ("lateral_opposite", "camber"): (5e-6, 5e-4),
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
(McPherson, double wishbone, five-link, semi-trailing, twist beam, rigid), widened.
"""
CONTACT_LAWS: Mapping[str, tuple[float, float]] = {
    "lateral": (2e-4, 4e-3),
    "lateral_opposite": (1e-4, 3e-3),
    "lateral_offset": (2e-4, 4e-3),
}
"""Load case -> slopes of the left wheel's contact point along y, mm/N, as `SLOPE_LAWS`.

Positive work is that of the contact point, where a lateral force acts. The wheel centre, which rigs measure,
may go the other way: with 4900 Nm/deg between hub and strut by 0.02 to 0.05 mm/kN.
"""
CENTRE_LEAST = {"lateral": 5e-5, "lateral_opposite": 2e-5, "lateral_offset": 5e-5}
"""Load case -> slope of a wheel centre that goes the other way, mm/N, from which it costs `AGAINST_FORCE`."""
AGAINST_FORCE = 10.0
"""-2 ln of how often a wheel centre does, 1 in 150: three load cases stay below what is told as an error."""
CONTACT_HEIGHT = 300.0
"""Of the wheel centre above the road, mm; 270 to 370 of passenger cars."""
OBEYED = 2.0
"""Of the least slope by a law: a model below it is no case of the law."""
CAP = 25.0
"""Of one term: what is wrong by five standard deviations is wrong."""
_MODEL_SHARE = 0.5
"""Of the model's slope: what parameters and unknown effects change."""
_STEER_SHARE = 0.25
"""The same of the steer case, whose slopes geometry alone sets."""
_OFFSET_SCALE = 1e-5
"""deg/N; what the toe that a lateral force makes by its offset alone differs by in sound cars, beside its
share."""
_COMPLIANCE_RATIO = 0.8
"""Of the logarithm of a slope over the model's, where forces act: compliances that the model lacks make it
several times as large (a soft sub-frame 4 times in lateral forces that oppose each other)."""
_MIRROR_SHARE = 0.12
"""Of the slope: difference of the sides from production and left-right asymmetry."""
_SCALES: Mapping[str, tuple[float, float, float, float]] = {
    "vertical": (2e-3, 1.5e-2, 1.5e-2, 3.0),
    "roll": (0.03, 0.08, 0.08, 60.0),
    "force": (6e-5, 8e-5, 2e-4, 0.04),
    "steer": (2e-3, 4e-3, 4e-3, 0.3),
}
"""Load case -> slopes of angle (deg), horizontal position, height (mm) and load (N) per input unit that sound
cars differ by. With forces, height and load follow the angle of their support, 0.04 N/N, over the tyre's
rate."""


ROAD_LEAN = np.array([1.0, -1.0])
"""Left and right camber against the body less camber against the road, deg per deg of body roll."""
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

    model: (8, 7, 2) slopes of the left and right wheel, nan where unknown. load: stated wheel load, N, or
    None.
    """

    model: FloatArray
    load: float | None


def scales() -> FloatArray:
    """(8, 7) slopes that sound cars differ by."""
    out = np.empty((len(CASE_ORDER), len(RIG_RESPONSES)))
    for case in CASE_ORDER:
        angle, position, height, load = _SCALES.get(case, _SCALES["force"])
        kinds = {"wc_x": position, "wc_y": position, "wc_z": height, "tyre_load": load}
        out[row(case)] = [kinds.get(response, angle) for response in RIG_RESPONSES]
    return out


_SCALE = scales()
_FORCE = np.array([LOAD_CASES[case].unit == "N" for case in CASE_ORDER])[:, None]
_SHARE = np.array([_STEER_SHARE if case == "steer" else _MODEL_SHARE for case in CASE_ORDER])[:, None]
_MIRROR = mirror_signs()
_LOW = np.full(_SCALE.shape, np.nan)
_HIGH = np.full(_SCALE.shape, np.nan)
for (_case, _response), (_a, _b) in SLOPE_LAWS.items():
    _LOW[row(_case), column(_response)], _HIGH[row(_case), column(_response)] = _a, _b
_CENTRE = np.array([CENTRE_LEAST.get(case, np.nan) for case in CASE_ORDER])
_CONTACT = np.array([CONTACT_LAWS.get(case, (np.nan, np.nan)) for case in CASE_ORDER])


def misfit(table: SlopeTable, expected: Expectation, source: IntArray | None = None) -> FloatArray:
    """(h,) about -2 ln likelihood of h tables: laws, model, mirror, load at rest, noise, relations.

    table: arrays with a leading axis of h. source: (h, 8) row whose expectations hold for each row, by
    default
    its own.
    """
    rows = np.arange(len(CASE_ORDER))[None] if source is None else source
    mirror, scale, model = _MIRROR[rows], _SCALE[rows], expected.model[rows]
    slope = _to_body(table.slope, expected.model)
    left, right = slope[..., 0], mirror * slope[..., 1]
    model_left, model_right = model[..., 0], mirror * model[..., 1]
    mean, model_mean = _of_both(left, right), _of_both(model_left, model_right)
    own = np.nan_to_num(model_left - model_right)  # a Panhard rod, for one, makes the sides of a model differ
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(
            _law_misfit(mean, model_mean, _LOW[rows], _HIGH[rows])
            + _law_misfit(_contact(mean), _contact(model_mean), *np.moveaxis(_CONTACT[rows], -1, 0))
            + _against_force(mean, model_mean, _CENTRE[rows])
            + _model_misfit(mean, model_mean, np.hypot(_SHARE[rows] * model_mean, scale), _FORCE[rows])
            + _offset_misfit(mean, model_mean)
            + _mirror_misfit(left, right, own, scale)
            + _rest_misfit(table.rest, expected.load)
            + _noise_misfit(table.noise)
            + _relation_misfit(slope)
        )


def _to_body(slope: FloatArray, model: FloatArray) -> FloatArray:
    """Camber in body roll against the body, as the model has it, where a rig gave it against the road, which
    leans by 1 deg per deg the other way: a technique, and no error of a channel."""
    at = row("roll"), column("camber")
    own, out = slope[(..., *at, slice(None))], slope.copy()
    to_body = own + ROAD_LEAN
    out[(..., *at, slice(None))] = np.where(
        np.abs(to_body - model[at]) < np.abs(own - model[at]), to_body, own
    )
    return out


def _of_both(left: FloatArray, right: FloatArray) -> FloatArray:
    """The mean, or the side that is known."""
    return np.where(np.isnan(left), right, np.where(np.isnan(right), left, (left + right) / 2.0))


def _total(terms: FloatArray) -> FloatArray:
    """(h,) sum of capped terms, those that are not known left out."""
    return np.asarray(np.nansum(np.minimum(terms, CAP), axis=tuple(range(1, terms.ndim))))


def _law_misfit(mean: FloatArray, model: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Of slopes outside their interval: by their ratio to its nearer end, and by sign. A law that the axle's
    own model hardly obeys, as a rigid axle under lateral forces that oppose each other, does not bind it."""
    small, large = np.minimum(np.abs(low), np.abs(high)), np.maximum(np.abs(low), np.abs(high))
    small = np.where(model * np.sign(low) < OBEYED * small, np.nan, small)
    size = mean * np.sign(low)
    beyond = np.maximum(np.log(small / np.abs(size)), np.log(np.abs(size) / large))
    wrong = np.where(size < 0.0, 2.0 * CAP * np.minimum(np.abs(size) / small, 1.0), 0.0)
    return _total(wrong + (np.maximum(beyond, 0.0) / 0.5) ** 2)


def _contact(mean: FloatArray) -> FloatArray:
    """(..., 8) slopes of the contact point along y, mm per input unit. mean: (..., 8, 7) of wheels."""
    tilt = np.radians(mean[..., column("camber")])
    return np.asarray(mean[..., column("wc_y")] + CONTACT_HEIGHT * tilt)


def _against_force(mean: FloatArray, model: FloatArray, least: FloatArray) -> FloatArray:
    """Of wheel centres that go against a lateral force, which is rare, unless the model's hardly moves."""
    at = column("wc_y")
    back = np.where(model[..., at] < OBEYED * least, 0.0, -mean[..., at] / least)
    return _total(AGAINST_FORCE * np.clip(back, 0.0, 1.0))


def _model_misfit(mean: FloatArray, model: FloatArray, sd: FloatArray, of_force: np.ndarray) -> FloatArray:
    """Of slopes beside the model's: by their difference, or where forces act by their ratio if less."""
    ratio = np.where((mean * model > 0.0) & of_force, mean / model, np.nan)
    by_ratio = (np.log(ratio) / _COMPLIANCE_RATIO) ** 2
    return 2.0 * _total(np.fmin(((mean - model) / sd) ** 2, by_ratio))


def _offset_misfit(mean: FloatArray, model: FloatArray) -> FloatArray:
    """Of the toe that the offset of a lateral force alone makes, which tells the two load cases apart."""
    behind, below = row("lateral_offset"), row("lateral")
    at = column("toe")
    toe, own = (s[:, behind, [at]] - s[:, below, [at]] for s in (mean, model))
    sd = np.hypot(_MODEL_SHARE * own, _OFFSET_SCALE)
    return _model_misfit(toe, own, sd, np.ones(1, bool))


def _mirror_misfit(left: FloatArray, right: FloatArray, own: FloatArray, scale: FloatArray) -> FloatArray:
    """own: difference of the sides that the model has."""
    size = np.maximum(np.abs(left), np.abs(right))
    sd = np.hypot(_MIRROR_SHARE * size, 0.4 * scale)
    return _total(((left - right - own) / 2.0 / sd) ** 2)


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
