"""The score test at another model: least squares over sizes and parameters within their priors."""

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
    scaled = np.hstack([tuned.jacobian.dense * tuned.model.prior_sd, found.columns])
    rows = np.vstack([scaled, np.eye(scaled.shape[1])])
    offset = tuned.residual - tuned.jacobian.dense @ (tuned.z - tuned.model.centre)
    wanted = np.concatenate([-offset, np.zeros(scaled.shape[1])])
    expected = np.linalg.lstsq(rows, wanted)[0][-2:]
    assert np.allclose(again.amplitudes, expected, rtol=1e-5, atol=1e-6)
