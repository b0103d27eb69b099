"""Choice, calibration, validation, constants, folds and shares."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtr

from doe_kc.axle.design_parameters import Parameter
from doe_kc.ground.errors import InputError
from doe_kc.surrogate_models.calibration import (
    DEPENDENCE,
    MODEL_ERROR,
    Calibrated,
    calibration_factors,
    coverage_after,
    coverage_interval,
    scaled,
    widening,
)
from doe_kc.surrogate_models.folds import fold_rows, refit_folds
from doe_kc.surrogate_models.interface import LeftOut
from doe_kc.surrogate_models.models import make
from doe_kc.surrogate_models.selection import Chosen, choose, join
from doe_kc.surrogate_models.shares import total_shares
from doe_kc.surrogate_models.study import default_models, fit_study, number_of_tasks
from doe_kc.surrogate_models.validation import quality, quality_on
from doe_kc.surrogate_models.varying import fit_varying
from doe_kc.variables import Space, Variable
from tests.surrogate_models.problems import outputs, points, problem

P = problem()
ORDER = {"linear": 0, "rbf": 2, "gp": 3}
ROUNDING = 1e-8
"""Of a variance: the small difference between the prior's and what the rows explain."""


def test_the_simplest_of_the_nearly_best_is_chosen() -> None:
    q2 = {
        "gp": np.array([0.99, 0.9999999, np.nan]),
        "linear": np.array([0.9895, 0.9999995, np.nan]),
        "rbf": np.array([0.985, 0.9999999, np.nan]),
    }
    assert choose(q2, ORDER) == ("linear", "linear", "linear")
    assert choose({k: v[:1] for k, v in q2.items()}, ORDER) == ("linear",)


def test_what_other_outputs_tell_of_a_model_counts() -> None:
    """1 - Q2 of 0.010 and 0.013 in one output, 0.010 and 0.001 in eight others."""
    q2 = {"linear": np.full(9, 0.990), "gp": np.r_[0.987, np.full(8, 0.999)]}
    assert choose({k: v[:1] for k, v in q2.items()}, ORDER) == ("linear",)
    assert choose(q2, ORDER) == ("gp",) * 9


@pytest.mark.parametrize("some", [[2, 0], [1], [3], [3, 1, 0], [2, 3]])
def test_some_outputs_of_a_joined_calibrated_model_with_a_constant_are_predicted_alike(
    some: list[int],
) -> None:
    y = np.column_stack([P.y, np.full(len(P.y), 7.0)])
    models = {n: Calibrated(fit_varying(make(n), P.x, y), np.arange(1.0, 5.0)) for n in ("linear", "gp")}
    joined = join(models, ["gp", "linear", "gp", "linear"])
    part = joined.of(np.array(some))
    assert part.outputs == len(some)
    for ask in ("predict", "variance", "gradient", "variance_gradient"):
        ours, all_of_them = (getattr(m, ask)(P.test) for m in (part, joined))
        np.testing.assert_allclose(ours, all_of_them[:, some], rtol=ROUNDING, atol=1e-12)
    residual = joined.cross_validate().residual[:, some]
    np.testing.assert_allclose(part.cross_validate().residual, residual, rtol=1e-12, atol=1e-14)


def test_joined_models_predict_each_its_own() -> None:
    models = {name: make(name).fit(P.x, P.y) for name in ("linear", "gp")}
    joined = join(models, ["gp", "linear", "gp"])
    assert isinstance(joined, Chosen)
    gp, linear = models["gp"], models["linear"]
    for ask in ("predict", "variance", "gradient", "variance_gradient"):
        found, a, b = (getattr(m, ask)(P.test) for m in (joined, gp, linear))
        np.testing.assert_allclose(found[:, [0, 2]], a[:, [0, 2]], rtol=ROUNDING)
        np.testing.assert_allclose(found[:, 1], b[:, 1], rtol=ROUNDING)
    assert joined.cross_validate().residual[:, 1] == pytest.approx(linear.cross_validate().residual[:, 1])
    assert join(models, ["gp", "gp", "gp"]) is gp


ROWS = 400


def test_calibration_repairs_variances_that_are_too_small() -> None:
    rng = np.random.default_rng(0)
    sd = np.array([1.0, 4.0])
    held = LeftOut(sd * rng.normal(size=(ROWS, 2)), np.full((ROWS, 2), 1.0))
    factors = calibration_factors(held, ROWS)
    assert factors == pytest.approx([1.0, 16.0], rel=0.25)
    before, after = quality(np.zeros((ROWS, 2)), held), scaled(held, factors)
    assert before.coverage[1] < 0.5
    assert (np.abs(after.residual) <= 1.96 * np.sqrt(after.variance)).mean(axis=0) == pytest.approx(
        0.95, abs=0.02
    )
    assert coverage_after(held, ROWS) == pytest.approx(0.95, abs=0.03)


def test_residuals_of_folds_count_as_those_of_a_model_with_all_rows() -> None:
    held = LeftOut(np.random.default_rng(1).standard_normal((50, 3)), np.ones((50, 3)))
    single, five = calibration_factors(held, 50), calibration_factors(held, 5)
    assert five / single == pytest.approx(np.full(3, (1.0 - 1.0 / 5.0) / (1.0 - 1.0 / 50.0)))


@pytest.mark.parametrize("rows", [50, 200])
def test_widened_intervals_cover_95_percent_in_the_mean(rows: int) -> None:
    """The scale of each interval off by an error of the size that the widening is made for."""
    error = np.hypot(MODEL_ERROR, DEPENDENCE * np.sqrt(0.5 / rows))
    off = np.exp(error * np.random.default_rng(2).standard_normal(200_000))
    covered = 2.0 * ndtr(1.959964 * widening(rows) * off) - 1.0
    assert covered.mean() == pytest.approx(0.95, abs=0.003)
    assert (2.0 * ndtr(1.959964 * off) - 1.0).mean() < 0.942


def test_limits_of_the_coverage_hold_it() -> None:
    """2000 outputs of 40 independent Gaussian errors each: their true coverage is known."""
    held = LeftOut(np.random.default_rng(5).standard_normal((40, 2000)), np.ones((40, 2000)))
    low, high = coverage_interval(held, 40)
    true = 2.0 * ndtr(1.959964 * np.sqrt(calibration_factors(held, 40))) - 1.0
    assert ((low <= true) & (true <= high)).mean() > 0.95
    assert (low < 0.95).all()
    assert (high > 0.95).all()


def test_limits_are_wider_where_the_errors_have_tails() -> None:
    rng = np.random.default_rng(6)
    held = LeftOut(np.column_stack([rng.standard_normal(60), rng.standard_t(2.5, 60)]), np.ones((60, 2)))
    low, high = coverage_interval(held, 60)
    assert low[1] < low[0]
    assert high[1] > high[0]


def test_an_exactly_known_output_keeps_its_variance() -> None:
    known = LeftOut(np.zeros((9, 1)), np.zeros((9, 1)))
    assert calibration_factors(known, 9) == pytest.approx([widening(9) ** 2])


def test_a_calibrated_model_differs_in_variance_alone() -> None:
    model = make("gp").fit(P.x, P.y)
    wide = Calibrated(model, np.array([1.0, 4.0, 9.0]))
    np.testing.assert_array_equal(wide.predict(P.test), model.predict(P.test))
    np.testing.assert_array_equal(wide.gradient(P.test), model.gradient(P.test))
    np.testing.assert_allclose(wide.variance(P.test), model.variance(P.test) * [1.0, 4.0, 9.0])
    slopes = model.variance_gradient(P.test) * np.array([1.0, 4.0, 9.0])[:, None]
    np.testing.assert_allclose(wide.variance_gradient(P.test), slopes)


def test_quality_of_perfect_useless_and_constant() -> None:
    y = np.column_stack([np.arange(10.0), np.arange(10.0), np.full(10, 2.0)])
    residual = np.column_stack([np.zeros(10), y[:, 1] - 4.5, np.zeros(10)])
    q = quality(y, LeftOut(residual, np.ones((10, 3))))
    assert q.q2[:2] == pytest.approx([1.0, 0.0])
    assert np.isnan(q.q2[2])
    assert q.rmse[1] == pytest.approx(y[:, 1].std())
    assert q.coverage == pytest.approx([1.0, 0.2 * 2.0, 1.0], abs=0.21)
    assert q.sharpness[0] == pytest.approx(1.96 / y[:, 0].std(), rel=1e-3)


def test_constant_outputs_are_kept_as_they_are() -> None:
    y = np.column_stack([P.y[:, 0], np.full(len(P.x), 3.0), P.y[:, 1]])
    model = fit_varying(make("gp"), P.x, y)
    alone = make("gp").fit(P.x, y[:, [0, 2]])
    np.testing.assert_array_equal(model.predict(P.test)[:, [0, 2]], alone.predict(P.test))
    assert (model.predict(P.test)[:, 1] == 3.0).all()
    assert (model.variance(P.test)[:, 1] == 0.0).all()
    assert (model.gradient(P.test)[:, 1] == 0.0).all()
    assert (model.cross_validate().residual[:, 1] == 0.0).all()
    with pytest.raises(InputError, match="no output changes"):
        fit_varying(make("gp"), P.x, np.ones((len(P.x), 2)))


def test_folds_hold_every_row_once() -> None:
    folds = fold_rows(23, 5, seed=1)
    assert sorted(np.concatenate(folds)) == list(range(23))
    assert {len(f) for f in folds} == {4, 5}
    assert len(fold_rows(3, 10, seed=1)) == 3


def test_refitted_folds_are_those_of_a_fit_without_them() -> None:
    held = refit_folds(make("linear"), P.x, P.y, folds=4, seed=2)
    left = fold_rows(len(P.x), 4, 2)[1]
    rest = np.setdiff1d(np.arange(len(P.x)), left)
    alone = make("linear").fit(P.x[rest], P.y[rest])
    np.testing.assert_allclose(held.residual[left], P.y[left] - alone.predict(P.x[left]))


def test_a_study_chooses_well_and_says_what_it_left_out() -> None:
    models = ("linear", "gp", "gp_slopes")
    few = fit_study(points(20, 3, 15), points(20, 4, 2), models=models, folds=3, workers=1)
    assert list(few.models) == ["linear", "gp"]
    assert "no exact slopes at the start" in few.skipped["gp_slopes"]
    steps: list[int] = []
    full = fit_study(P.x, P.y, models=("linear", "rbf", "gp"), folds=5, workers=1, progress=steps.append)
    assert sum(steps) == number_of_tasks(("linear", "rbf", "gp"), 40, 5) == 8
    assert full.chosen[0] == "gp"
    test = points(300, 60)
    q = quality_on(full.model, test, outputs(test))
    assert (q.q2 > 0.95).all()
    assert q.coverage.mean() > 0.85


def test_a_study_is_the_same_with_any_number_of_workers() -> None:
    one = fit_study(P.x, P.y, models=("linear", "gp"), folds=3, seed=4, workers=1)
    two = fit_study(P.x, P.y, models=("linear", "gp"), folds=3, seed=4, workers=2)
    np.testing.assert_array_equal(one.models["gp"].held.residual, two.models["gp"].held.residual)
    np.testing.assert_array_equal(one.model.predict(P.test), two.model.predict(P.test))


def test_too_few_designs_and_unknown_models_are_named() -> None:
    with pytest.raises(InputError, match="9 designs, needs at least 10"):
        fit_study(P.x[:9], P.y[:9])
    with pytest.raises(InputError, match="'forest' is no surrogate"):
        fit_study(P.x, P.y, models=("forest",))
    assert default_models(40, 72) == ["gp_ard", "linear", "rbf"]
    assert default_models(60, 6) == ["gp", "gp_ard", "linear", "rbf"]
    assert default_models(401, 72, slopes=True) == ["gp", "gp_slopes", "linear", "rbf"]


def test_shares_of_a_plane_are_its_squared_slopes() -> None:
    weight = np.array([3.0, 1.0, 0.0, 0.0, 2.0])
    model = make("linear").fit(P.x, (P.x @ weight)[:, None])
    shares = total_shares(model, space(5), points=512)
    assert shares[:, 0] == pytest.approx(weight**2 / (weight**2).sum(), abs=0.04)


def test_shares_count_an_interaction_for_both() -> None:
    x = points(60, 2, 3)
    centred = x - 0.5
    model = make("gp").fit(x, (centred[:, 0] * centred[:, 1])[:, None])
    shares = total_shares(model, space(3), points=512)
    assert shares[:2, 0] == pytest.approx([1.0, 1.0], abs=0.15)
    assert shares[2, 0] < 0.05


def space(d: int) -> Space:
    def variable(i: int) -> Variable:
        parameter = Parameter(
            path=f"p{i}", label=f"p{i}", group="OTHER", unit="-", nominal=0.5, lower=0.0, upper=1.0, step=0.1,
            active=True,
        )  # fmt: skip
        return Variable(
            parameter=parameter, lower=0.0, upper=1.0, start=0.5, levels=None, distribution="uniform",
            logarithmic=False,
        )  # fmt: skip

    return Space(tuple(variable(i) for i in range(d)))
