"""Projection: what tuning can do is taken out, as with the marginal covariance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit, fit
from tests.discovery.cases import model


@pytest.fixture(scope="module")
def tuned() -> Fit:
    nominal = model("none")
    return fit(nominal, nominal.centre)


def test_inner_products_are_those_of_the_marginal_covariance(tuned: Fit) -> None:
    few = replace(tuned, jacobian=tuned.jacobian[::20])
    rows = np.random.default_rng(1).standard_normal((few.jacobian.shape[0], 2))
    seen = few.projection(rows)
    prior = tuned.model.prior_sd
    inverse = np.linalg.inv(np.eye(rows.shape[0]) + (few.jacobian * prior**2) @ few.jacobian.T)
    assert np.allclose(seen.T @ seen, rows.T @ inverse @ rows, rtol=1e-6)


def test_a_column_that_a_parameter_makes_is_absorbed(tuned: Fit) -> None:
    visible = int(np.argmax(np.linalg.norm(tuned.jacobian[:, : tuned.model.parameters], axis=0)))
    column = tuned.jacobian[:, visible]
    seen = tuned.projection(column)
    assert seen @ seen < 1e-3 * (column @ column)


def test_the_residual_of_the_minimum_keeps_its_cost(tuned: Fit) -> None:
    seen = tuned.projection.residual(tuned.residual)
    assert float(seen @ seen) == pytest.approx(tuned.cost, rel=1e-3)


def test_products_of_sparse_rows_are_those_of_the_projected_rows(tuned: Fit) -> None:
    rows = tuned.model.contrasts.rows
    seen, left = tuned.projection(rows.toarray()), tuned.remainder
    gram, products = tuned.projection.products(rows, tuned.residual)
    assert np.allclose(gram, seen.T @ seen, atol=1e-9)
    assert np.allclose(products, seen.T @ left, atol=1e-6)
