"""The reduction on synthetic curves whose slopes are known by construction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.characteristics import (
    CHARACTERISTICS,
    reduce_all,
    reduce_batch,
    reduce_one,
    reduction_gradient,
)
from doe_kc.characteristics.reduction import fit_window, pad_travel, slope
from doe_kc.curves import RESPONSE_UNITS, CaseCurves, CurveBatch, CurveSet
from doe_kc.load_cases import LOAD_CASES

HALF_TRACK = 790.0
GRADIENTS = [i for i, c in CHARACTERISTICS.items() if c.kind == "gradient"]
STATIC = [i for i, c in CHARACTERISTICS.items() if c.kind == "static"]


def case_curves(
    case: str, slopes: dict[str, float], *, unit: str | None = None, bend: float = 0.0
) -> CaseCurves:
    """response = slope * input (+ bend * input^2) on the left; nonsense on the right."""
    grid, own = LOAD_CASES[case].inputs(), LOAD_CASES[case]
    mean = {}
    for name in RESPONSE_UNITS:
        left = slopes.get(name, 0.0) * grid + bend * grid**2 + (4300.0 if name == "tyre_load" else 0.0)
        mean[name] = np.array([left, 7.0 - 3.0 * grid])
    return CaseCurves(case, unit or own.unit, grid, mean, {n: np.zeros_like(m) for n, m in mean.items()})


def curve_set(cases: dict[str, CaseCurves], static: object = None) -> CurveSet:
    return CurveSet("test", cases, static, HALF_TRACK)  # type: ignore[arg-type]


SCALES = {
    "deg/m": 1000.0,
    "mm/m": 1000.0,
    "deg/kN": 1000.0,
    "mm/kN": 1000.0,
    "%": 100.0,
    "N/mm": 1.0,
    "deg/deg": 1.0,
}
"""Response unit per mm, N or deg of the abscissa, in the characteristic's unit."""


@pytest.mark.parametrize("ident", GRADIENTS)
def test_a_known_slope_comes_back_in_the_unit(ident: str) -> None:
    entry = CHARACTERISTICS[ident]
    slopes = {entry.response: 0.0123}
    expected = 0.0123
    if entry.abscissa == "wheel_travel":
        slopes["wc_z"] = -2.5
        expected /= -2.5
    case = case_curves(entry.load_case, slopes)
    if entry.abscissa == "pad_travel" and entry.load_case == "roll":
        travel = -HALF_TRACK * np.tan(np.radians(case.input))
        case.mean[entry.response][0] = 4300.0 + 0.0123 * travel
    value = reduce_one(entry, curve_set({entry.load_case: case}))
    assert value == pytest.approx(SCALES[entry.unit] * expected, rel=1e-9)


@pytest.mark.parametrize("ident", STATIC)
def test_static_values_are_those_of_the_left_wheel(ident: str) -> None:
    entry = CHARACTERISTICS[ident]
    static = {n: np.array([1.5, -9.0]) for n in ("toe", "camber", "caster", "spin")}
    assert reduce_one(entry, curve_set({}, static)) == 1.5
    assert np.isnan(reduce_one(entry, curve_set({}, None)))
    assert np.isnan(reduce_one(entry, curve_set({}, {})))


def test_what_is_not_measured_is_nan() -> None:
    assert all(np.isnan(v) for v in reduce_all(curve_set({})).values())
    assert set(reduce_all(curve_set({}))) == set(CHARACTERISTICS)


@pytest.mark.parametrize("case", LOAD_CASES)
def test_the_ends_of_the_window_belong_to_it(case: str) -> None:
    curves = case_curves(case, {})
    limit = LOAD_CASES[case].window
    grid = np.array([-limit * 1.01, -limit, 0.0, 0.3 * limit, limit, limit * 1.01])
    shifted = CaseCurves(case, curves.input_unit, grid, {}, {})
    np.testing.assert_array_equal(fit_window(shifted), [False, True, True, True, True, False])
    np.testing.assert_array_equal(fit_window(shifted, 0.5 * limit), [False, False, True, True, False, False])


def test_default_windows_are_physical() -> None:
    windows = {i: c.window for i, c in LOAD_CASES.items()}
    assert windows.pop("vertical") == 20.0
    assert windows.pop("roll") == 1.0
    assert windows.pop("steer") == 100.0
    assert set(windows.values()) == {1000.0}


def test_points_outside_the_window_do_not_count() -> None:
    entry = CHARACTERISTICS["drive.drive_steer"]
    case = case_curves("drive", {"toe": 2e-4})
    case.mean["toe"][0, ~fit_window(case)] = 1e6
    assert reduce_one(entry, curve_set({"drive": case})) == pytest.approx(0.2)


def test_the_slope_is_numpy_s_least_squares() -> None:
    rng = np.random.default_rng(0)
    x, y = rng.normal(size=(2, 40))
    assert slope(x, y) == pytest.approx(np.polyfit(x, y, 1)[0])


def test_pad_travel_by_technique() -> None:
    body, pads = case_curves("roll", {}), case_curves("roll", {}, unit="mm")
    # right side down: the left pad goes down in the chassis frame
    np.testing.assert_allclose(pad_travel(body, HALF_TRACK), -HALF_TRACK * np.tan(np.radians(body.input)))
    np.testing.assert_array_equal(pad_travel(pads, HALF_TRACK), -pads.input)
    vertical = case_curves("vertical", {})
    np.testing.assert_array_equal(pad_travel(vertical, HALF_TRACK), vertical.input)


@pytest.mark.parametrize("ident", GRADIENTS)
def test_the_gradient_of_the_reduction_is_the_finite_difference(ident: str) -> None:
    entry = CHARACTERISTICS[ident]
    rng = np.random.default_rng(3)
    case = case_curves(entry.load_case, {entry.response: 0.02, "wc_z": 1.3}, bend=1e-5)
    gradient = reduction_gradient(entry, case, HALF_TRACK)
    assert set(gradient) == {entry.response} | ({"wc_z"} if entry.abscissa == "wheel_travel" else set())
    inside = fit_window(case)
    for name, slopes in gradient.items():
        np.testing.assert_array_equal(slopes[~inside], 0.0)
        h = 1e-5
        for i in rng.choice(len(case.input), 5, replace=False):
            values = []
            for sign in (1.0, -1.0):
                mean = {n: m.copy() for n, m in case.mean.items()}
                mean[name][0, i] += sign * h
                moved = CaseCurves(case.load_case, case.input_unit, case.input, mean, case.half_width)
                values.append(reduce_one(entry, curve_set({case.load_case: moved})))
            found = (values[0] - values[1]) / (2 * h)
            assert slopes[i] == pytest.approx(found, rel=1e-5, abs=1e-6 * np.abs(slopes).max() + 1e-9)


def test_many_designs_are_reduced_as_each_of_them() -> None:
    rng = np.random.default_rng(3)
    shift = {name: rng.normal(size=2) for name in ("toe", "camber", "spin", "caster")}

    def single(factor: float, half_track: float) -> CurveSet:
        slopes = {name: factor * (1.0 + 0.1 * i) for i, name in enumerate(RESPONSE_UNITS)}
        cases = {
            ident: case_curves(ident, slopes, bend=1e-5 * factor) for ident in ("vertical", "roll", "brake")
        }
        return CurveSet("test", cases, {n: factor * v for n, v in shift.items()}, half_track)

    singles = [single(0.3, 780.0), single(0.7, 800.0), single(-0.2, 790.0)]
    cases = {
        ident: replace(
            case,
            mean={n: np.stack([c.cases[ident].mean[n] for c in singles], axis=1) for n in case.mean},
            half_width={
                n: np.stack([c.cases[ident].half_width[n] for c in singles], axis=1) for n in case.mean
            },
        )
        for ident, case in singles[0].cases.items()
    }
    static = {n: np.stack([(c.static or {})[n] for c in singles], axis=1) for n in shift}
    batch = CurveBatch("test", cases, static, np.array([[c.half_track] for c in singles]))
    found = reduce_batch(batch, {"vertical": 12.0})
    assert np.isnan(found).any() and not np.isnan(found).all(axis=0).all()
    for i, (row, curves) in enumerate(zip(found, singles, strict=True)):
        np.testing.assert_allclose(row, list(reduce_all(curves, {"vertical": 12.0}).values()), rtol=1e-12)
        assert float(batch.half_track[i, 0]) == curves.half_track
