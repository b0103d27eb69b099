"""The score test at another model: the closed form, by derivatives known from a screening."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screening.score_test import score_tests
from doe_kc.discovery.screening.screen import screen
from tests.discovery.cases import library


def test_to_first_order_it_is_the_score_test(tuned: Fit) -> None:
    (hub,) = library("hub_compliance")
    found = screen(tuned, hub)
    unseen = replace(found, failed="no equilibrium")
    again, failed = score_tests(tuned, [found, replace(unseen, hypothesis=library("strut_friction")[0])])
    assert failed.failed and failed.gain == found.gain
    prior = tuned.model.prior_sd
    jacobian = tuned.jacobian.dense
    marginal = np.eye(tuned.residual.size) + (jacobian * prior**2) @ jacobian.T
    weighted = np.linalg.solve(marginal, found.columns)
    hessian = found.columns.T @ weighted + np.eye(2)
    offset = tuned.residual - jacobian @ (tuned.z - tuned.model.centre)
    expected = -np.linalg.solve(hessian, weighted.T @ offset)
    assert np.allclose(again.amplitudes, expected, rtol=1e-5, atol=1e-6)
