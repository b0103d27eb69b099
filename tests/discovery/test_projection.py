"""Projection: what tuning can do is taken out, as with the marginal covariance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.jacobian import Jacobian
from tests.discovery.cases import model


@pytest.fixture(scope="module")
def tuned() -> Fit:
    nominal = model("none")
    return fit(nominal, nominal.centre)


def test_inner_products_are_those_of_the_marginal_covariance(tuned: Fit) -> None:
    few = tuned.jacobian.dense[::20]
    fit = replace(tuned, jacobian=Jacobian(few))
    rows = np.random.default_rng(1).standard_normal((few.shape[0], 2))
    own = fit.changes(rows)
    prior = tuned.model.prior_sd
    inverse = np.linalg.inv(np.eye(rows.shape[0]) + (few * prior**2) @ few.T)
    exact = rows.T @ inverse @ rows
    assert np.allclose(fit.projection.gram_of(own), exact, rtol=1e-6)
    assert np.allclose(fit.projection.squares(own), np.diag(exact), rtol=1e-6)
    one, other = own.columns(slice(1)), own.columns(slice(1, 2))
    assert np.allclose(fit.projection.inner(one, other), exact[:1, 1:], rtol=1e-6, atol=1e-9)
    both = fit.changes(rows @ np.array([[1.0], [-2.0]]))
    assert np.allclose(fit.projection.squares(both), exact[0, 0] - 4.0 * exact[0, 1] + 4.0 * exact[1, 1])


def test_what_is_left_and_what_follows_are_the_two_parts_of_a_length(tuned: Fit) -> None:
    """Squares of the data's rows and of the prior's add up to the projected length."""
    rows = np.random.default_rng(3).standard_normal((tuned.residual.size, 1))
    own, seen = tuned.changes(rows), tuned.projection
    left, moved = seen.remaining(own), seen.moves(own)
    assert float(np.sum(left**2) + np.sum(moved**2)) == pytest.approx(float(seen.squares(own)[0]), rel=1e-9)


def test_a_column_that_a_parameter_makes_is_absorbed(tuned: Fit) -> None:
    columns = tuned.jacobian.dense[:, : tuned.model.parameters]
    column = columns[:, int(np.argmax(np.linalg.norm(columns, axis=0)))]
    assert tuned.projection.squares(tuned.changes(column))[0] < 1e-3 * (column @ column)


def test_the_residual_of_the_minimum_keeps_its_cost(tuned: Fit) -> None:
    assert tuned.misfit_left == pytest.approx(tuned.cost, rel=1e-3)


def test_products_of_sparse_rows_are_those_of_the_projected_rows(tuned: Fit) -> None:
    rows = tuned.model.contrasts.rows
    own = tuned.changes(rows.toarray())
    gram, products = tuned.projection.products(rows, tuned.remainder)
    assert np.allclose(gram, tuned.projection.gram_of(own), atol=1e-9)
    assert np.allclose(products, tuned.projection.inner(own, tuned.remainder)[:, 0], atol=1e-6)
