"""The gap of the axle handed over, the rig's nuisances those that are most probable beside it."""

from __future__ import annotations

import numpy as np

from doe_kc.workflow.gap import beside_nuisances
from tests.discovery.cases import discovery


def test_calibrations_that_were_taken_wrong_are_estimated_anew() -> None:
    fit = discovery("named").fitted
    moved = fit.z.copy()
    moved[fit.model.calibrations] += 2.0
    wrong = fit.model.residual(moved)
    own, anew = (beside_nuisances(fit, r, z) for r, z in ((fit.residual, fit.z), (wrong, moved)))
    assert np.linalg.norm(wrong - fit.residual) > 10.0
    assert np.linalg.norm(anew - own) < 0.05 * np.linalg.norm(wrong - fit.residual)
    assert np.linalg.norm(own - fit.residual) < 0.1


def test_their_priors_are_kept() -> None:
    """What nuisances could explain only by many standard deviations stays."""
    fit = discovery("named").fitted
    column = fit.jacobian.rows(slice(None))[:, fit.model.calibrations.start]
    size = np.linalg.norm(column)
    left = beside_nuisances(fit, 100.0 * column, np.zeros_like(fit.z))
    assert np.linalg.norm(left) < 100.0 * size / (1.0 + size**2) * 1.01
    faint = column / size**2
    kept = beside_nuisances(fit, faint, np.zeros_like(fit.z))
    assert 0.0 < faint @ kept <= faint @ faint
