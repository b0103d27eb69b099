"""The Gaussian process against scikit-learn, brute force, and what is asked of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, DotProduct

from doe_kc.ground.errors import InputError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.cholesky import inverse_roots, inverses
from doe_kc.surrogate_models.kernel import CovarianceKernel, training_covariance
from doe_kc.surrogate_models.learning import Learning, Sample, even_kernel, learn
from doe_kc.surrogate_models.models.gp import FirstOrderTrend, FittedGaussianProcess, GaussianProcess
from doe_kc.surrogate_models.posterior import condition
from tests.surrogate_models.problems import differences, points, problem

P = problem()
KEEP = Learning(steps=0)


def fit(**options: Any) -> FittedGaussianProcess:
    fitted = GaussianProcess(**options).fit(P.x, P.y)
    assert isinstance(fitted, FittedGaussianProcess)
    return fitted


def test_mean_variance_and_likelihood_agree_with_scikit_learn() -> None:
    """Points scaled by the relevances make the linear kernel the library's dot product."""
    fitted = fit()
    for j in range(3):
        kernel = fitted.kernel
        scale, lengths = np.sqrt(kernel.relevance[j]), 1.0 / np.sqrt(kernel.curvature[j])
        theirs = ConstantKernel(kernel.bend[j]) * RBF(lengths * scale) + DotProduct(
            np.sqrt(kernel.constant[j])
        )
        model = GaussianProcessRegressor(theirs, alpha=kernel.nugget[j], optimizer=None)
        shift, size = fitted.scaling.shift[j], fitted.scaling.scale[j]
        model.fit((P.x - fitted.centre) * scale, (P.y[:, j] - shift) / size)
        mean, sd = model.predict((P.test - fitted.centre) * scale, return_std=True)
        np.testing.assert_allclose(fitted.predict(P.test)[:, j], shift + size * mean, rtol=1e-8)
        np.testing.assert_allclose(
            fitted.variance(P.test)[:, j], (size * sd) ** 2, rtol=1e-8, atol=1e-8 * size**2
        )
        likelihood = model.log_marginal_likelihood_value_
        assert fitted.posterior.evidence[j] == pytest.approx(likelihood, rel=1e-8)


def test_left_out_rows_are_those_of_a_fit_without_them() -> None:
    fitted, held = fit(), fit().cross_validate()
    z, values = P.x - fitted.centre, fitted.scaling.standardise(P.y)
    for i in (0, 17, 39):
        rest = np.delete(np.arange(len(z)), i)
        posterior = condition(fitted.kernel, z[rest], values[rest])
        alone = replace(fitted, posterior=posterior)
        np.testing.assert_allclose(
            held.residual[i], P.y[i] - alone.predict(P.x[[i]])[0], rtol=1e-6, atol=1e-9
        )
        noise = fitted.kernel.nugget * fitted.scaling.scale**2
        np.testing.assert_allclose(held.variance[i], alone.variance(P.x[[i]])[0] + noise, rtol=1e-6)


def test_learning_raises_the_likelihood() -> None:
    sample = Sample(P.x - P.x.mean(axis=0), (P.y - P.y.mean(axis=0)) / P.y.std(axis=0))
    before = even_kernel(sample, Learning())
    with one_thread():
        after = learn(before, sample, Learning())
    likelihoods = [condition(k, sample.z, sample.values).evidence for k in (before, after)]
    assert (likelihoods[1] > likelihoods[0] + 1.0).all()


def test_the_slope_of_the_likelihood_is_exact() -> None:
    from doe_kc.surrogate_models.learning import _curvature_slope

    sample = Sample(P.x - 0.5, (P.y - P.y.mean(axis=0)) / P.y.std(axis=0))
    for pinned in (False, True):
        kernel = replace(even_kernel(sample, Learning(nugget=1e-3)), pinned=pinned)
        total, curved = training_covariance(kernel, sample.z)
        inverse = inverses(total)
        alpha = (inverse @ sample.values.T[:, :, None])[:, :, 0]
        found = _curvature_slope(kernel, sample.z, inverse, alpha, curved)
        for k in range(5):
            assert found[:, k] == pytest.approx(by_difference(kernel, sample, k), rel=1e-5, abs=1e-7)


def by_difference(kernel: CovarianceKernel, sample: Sample, k: int) -> FloatArray:
    def evidence(step: float) -> FloatArray:
        curvature = kernel.curvature.copy()
        curvature[:, k] *= np.exp(step)
        return condition(replace(kernel, curvature=curvature), sample.z, sample.values).evidence

    return (evidence(1e-4) - evidence(-1e-4)) / 2e-4


def test_few_designs_find_the_few_variables_that_matter() -> None:
    """Thirty designs of sixty variables, of which each output follows three."""
    rng = np.random.default_rng(5)
    weight = np.zeros((8, 60))
    for row in weight:
        row[rng.choice(60, 3, replace=False)] = rng.uniform(1.0, 3.0, 3)
    x, test = points(30, 7, 60), points(200, 8, 60)
    fitted = GaussianProcess().fit(x, x @ weight.T)
    error = fitted.predict(test) - test @ weight.T
    q2 = 1.0 - np.square(error).mean(axis=0) / (test @ weight.T).var(axis=0)
    assert np.median(q2) > 0.95
    difference = fitted.gradient(np.full((1, 60), 0.5))[0] - weight
    assert np.linalg.norm(difference) < 0.2 * np.linalg.norm(weight)


def expansion(at: FloatArray) -> FirstOrderTrend:
    from tests.surrogate_models.problems import outputs

    slope = differences(outputs, at[None], 1e-5)[0]
    return FirstOrderTrend(at, outputs(at[None])[0], slope)


def test_a_known_expansion_is_kept_where_it_holds() -> None:
    at = np.full(5, 0.45)
    trend = expansion(at)
    fitted = fit(trend=trend)
    np.testing.assert_allclose(fitted.predict(at[None])[0], trend.value, rtol=1e-9)
    np.testing.assert_allclose(fitted.gradient(at[None])[0], trend.slope, rtol=1e-7, atol=1e-7)
    assert fitted.variance(at[None]).max() == 0.0
    assert fitted.variance_gradient(at[None]) == pytest.approx(0.0, abs=1e-12)


def test_a_known_expansion_helps() -> None:
    from tests.surrogate_models.problems import outputs

    x, test = P.x[:12], points(200, 51)
    errors = []
    for trend in (None, expansion(np.full(5, 0.5))):
        fitted = GaussianProcess(trend=trend).fit(x, outputs(x))
        errors.append(np.square((fitted.predict(test) - outputs(test)) / P.y.std(axis=0)).mean(axis=0))
        gradient = fitted.gradient(P.test) / P.y.std(axis=0)[:, None]
        wanted = differences(fitted.predict, P.test, 2e-3) / P.y.std(axis=0)[:, None]
        assert np.abs(gradient - wanted).max() < 1e-5
        slope = fitted.variance_gradient(P.test) / P.y.var(axis=0)[:, None]
        wanted = differences(fitted.variance, P.test, 2e-3) / P.y.var(axis=0)[:, None]
        assert np.abs(slope - wanted).max() < 1e-5
    assert (errors[1] < 0.8 * errors[0]).all()


def test_an_output_that_is_its_expansion_is_predicted_by_it() -> None:
    plane = P.x @ np.arange(1.0, 6.0)[:, None]
    trend = FirstOrderTrend(np.full(5, 0.5), np.array([7.5]), np.arange(1.0, 6.0)[None])
    fitted = GaussianProcess(trend=trend).fit(P.x, plane)
    np.testing.assert_allclose(fitted.predict(P.test)[:, 0], P.test @ np.arange(1.0, 6.0), rtol=1e-9)


def test_learning_goes_on_from_an_earlier_fit() -> None:
    first = fit()
    same = fit(start=first, learning=KEEP)
    np.testing.assert_allclose(same.predict(P.test), first.predict(P.test), rtol=1e-12)
    fewer = GaussianProcess(start=first, learning=KEEP).fit(P.x[:20], P.y[:20])
    assert isinstance(fewer, FittedGaussianProcess)
    for kernel in ("relevance", "bend", "constant"):
        before, after = (getattr(f.kernel, kernel).T * f.scaling.scale**2 for f in (first, fewer))
        np.testing.assert_allclose(after, before, rtol=1e-12)  # the same function, in the outputs' units


def test_an_earlier_fit_of_something_else_is_refused() -> None:
    with pytest.raises(InputError, match="other variables or outputs"):
        GaussianProcess(start=fit()).fit(P.x, P.y[:, :2])
    with pytest.raises(InputError, match="or a trend where this has none"):
        fit(start=fit(trend=expansion(np.full(5, 0.5))))


def test_a_small_box_is_as_good_as_a_large_one() -> None:
    """A trust region shrinks; what is learnt must not depend on its size."""
    weight = np.array([[3.0, 0.0, 1.0, 0.0, 0.2]])
    for size in (1.0, 1e-3):
        x = 0.5 + size * (P.x - 0.5)
        fitted = GaussianProcess().fit(x, 4.0 + x @ weight.T)
        assert fitted.gradient(np.full((1, 5), 0.5))[0] == pytest.approx(weight, abs=0.02)


def test_a_variable_that_never_moves_does_no_harm() -> None:
    x = P.x.copy()
    x[:, 4] = 0.5
    fitted = GaussianProcess().fit(x, P.y[:, :2])
    np.testing.assert_allclose(fitted.predict(x), P.y[:, :2], atol=1e-2)


def test_factors_are_those_of_numpy() -> None:
    rng = np.random.default_rng(2)
    a = rng.normal(size=(3, 7, 7))
    matrices = a @ a.transpose(0, 2, 1) + np.eye(7)
    np.testing.assert_allclose(inverses(matrices), np.linalg.inv(matrices), rtol=1e-9)
    roots = inverse_roots(matrices)
    np.testing.assert_allclose(roots, np.linalg.inv(np.linalg.cholesky(matrices)), rtol=1e-9, atol=1e-12)
