"""Each of the other models against its library, a refit, or a function that it can represent."""

from __future__ import annotations

import numpy as np
import pytest
from smt.surrogate_models import KPLS, KRG, RBF

from doe_kc.ground.threads import one_thread
from doe_kc.surrogate_models.interface import SurrogateModel
from doe_kc.surrogate_models.legendre import all_terms, features, jacobian
from doe_kc.surrogate_models.models import make
from doe_kc.surrogate_models.models.kpls import PartialLeastSquaresKriging
from doe_kc.surrogate_models.models.kriging import Kriging
from doe_kc.surrogate_models.models.linear import Linear
from doe_kc.surrogate_models.models.rbf import FittedRadialBasis, RadialBasis
from doe_kc.surrogate_models.ordinary_kriging import OrdinaryKriging, ordinary_kriging
from doe_kc.surrogate_models.ridge import FittedLinear
from tests.surrogate_models.problems import differences, points, problem

P = problem()
ROUGH = np.sin(9.0 * P.x[:, :1]) + P.x[:, 1:2] * P.x[:, 2:3] + np.cos(7.0 * P.x[:, 3:4])
"""Uneven enough for a correlation matrix that both sides can invert."""


def trained(model):  # type: ignore[no-untyped-def]
    model.set_training_values(P.x[:, :3], ROUGH)
    with one_thread():
        model.train()
    return model


@pytest.mark.parametrize(
    ("ours", "theirs"),
    [
        (Kriging(), KRG(n_start=1, seed=3, print_global=False)),
        (PartialLeastSquaresKriging(2, 2), KPLS(n_comp=2, n_start=2, seed=3, print_global=False)),
    ],
    ids=["kriging", "kpls"],
)
def test_kriging_is_that_of_smt(ours: SurrogateModel, theirs: KRG) -> None:
    x, test = P.x[:, :3], P.test[:, :3]
    model, reference = ours.fit(x, ROUGH, seed=3), trained(theirs)
    np.testing.assert_allclose(model.predict(test), reference.predict_values(test), rtol=1e-5)
    np.testing.assert_allclose(model.variance(test), reference.predict_variances(test), rtol=1e-4)


def test_the_radial_basis_is_that_of_smt() -> None:
    for n, tail in ((40, 1), (6, 0)):
        model = RadialBasis(width=0.7).fit(P.x[:n], ROUGH[:n])
        theirs = RBF(d0=0.7, poly_degree=tail, print_global=False)
        theirs.set_training_values(P.x[:n], ROUGH[:n])
        theirs.train()
        assert isinstance(model, FittedRadialBasis)
        assert model.linear_tail == bool(tail)
        np.testing.assert_allclose(model.predict(P.test), theirs.predict_values(P.test), rtol=1e-8)


def test_left_out_kriging_rows_are_those_of_a_fit_without_them() -> None:
    theta = np.array([[8.0, 1.0, 1.0, 6.0, 0.2]])
    held = ordinary_kriging(P.x, ROUGH, theta).cross_validate()
    for i in (0, 21):
        rest = np.delete(np.arange(len(P.x)), i)
        alone = ordinary_kriging(P.x[rest], ROUGH[rest], theta)
        assert isinstance(alone, OrdinaryKriging)
        assert held.residual[i] == pytest.approx(ROUGH[i] - alone.predict(P.x[[i]])[0], rel=1e-6)


def test_left_out_radial_rows_are_those_of_a_fit_without_them() -> None:
    held = RadialBasis(width=0.7).fit(P.x, ROUGH).cross_validate()
    for i in (3, 30):
        rest = np.delete(np.arange(len(P.x)), i)
        alone = RadialBasis(width=0.7).fit(P.x[rest], ROUGH[rest])
        assert held.residual[i] == pytest.approx(ROUGH[i] - alone.predict(P.x[[i]])[0], rel=1e-5)


def test_left_out_linear_rows_are_those_of_a_fit_without_them() -> None:
    whole = Linear().fit(P.x, P.y)
    assert isinstance(whole, FittedLinear)
    for j in range(3):
        model = Linear(penalty=float(whole.penalty[j]))
        for i in (0, 12):
            rest = np.delete(np.arange(len(P.x)), i)
            alone = model.fit(P.x[rest], P.y[rest])
            expected = P.y[i, j] - alone.predict(P.x[[i]])[0, j]
            assert whole.cross_validate().residual[i, j] == pytest.approx(expected, rel=1e-8)


def test_linear_finds_a_plane_and_quadratic_a_sparse_polynomial() -> None:
    plane = 2.0 + P.x @ np.array([[1.0], [0.0], [-3.0], [0.5], [0.0]])
    np.testing.assert_allclose(make("linear").fit(P.x, plane).predict(P.test), 2.0 + (P.test @ np.array(
        [[1.0], [0.0], [-3.0], [0.5], [0.0]])), atol=1e-4)  # fmt: skip
    x, test = points(80, 4, 30), points(50, 5, 30)

    def bent(u):  # type: ignore[no-untyped-def]
        return (3.0 * u[:, 0] - 2.0 * u[:, 7] + 4.0 * u[:, 0] * u[:, 3] + 2.0 * u[:, 9] ** 2)[:, None]

    error = make("quadratic").fit(x, bent(x)).predict(test) - bent(test)
    assert 1.0 - error.var() / bent(test).var() > 0.99


def test_the_polynomials_are_orthonormal_and_their_slopes_exact() -> None:
    terms = all_terms(3)
    x = points(200_000, 1, 3)
    values = features(terms, x)
    np.testing.assert_allclose(values.T @ values / len(x), np.eye(len(terms)), atol=0.03)
    found = jacobian(terms, P.x[:4, :3])
    wanted = differences(lambda u: features(terms, u), P.x[:4, :3], 1e-5)
    np.testing.assert_allclose(found, wanted, atol=1e-8)


def test_a_steep_penalty_leaves_the_quadratic_its_strongest_term() -> None:
    noise = np.random.default_rng(1).normal(size=(30, 1))
    model = make("quadratic").fit(points(30, 2, 6), noise)
    assert np.isfinite(model.predict(P.x @ np.ones((5, 6)) / 5.0)).all()
