"""The curves of the records as data: errors at corners, models at their inputs."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.correlation.curve_data import _interpolated_rows, corner_error
from doe_kc.measurement.branches import local_weights


def test_corners_are_granted_an_error() -> None:
    x = np.linspace(-10.0, 10.0, 21)
    sd = np.full(21, 0.05)
    error = corner_error(np.maximum(x, 0.0) * 8.0, sd)
    assert error[10] == error[9] == error[11] == pytest.approx(1.0)
    assert np.all(error[:8] == 0.0)
    for smooth in (0.1 * x, x**2, 3.0 * x**2 + 0.002 * x**3):
        assert np.all(corner_error(smooth, sd) == 0.0)


@pytest.mark.parametrize("width", [0.3, 0.6, 1.0, 30.0])
def test_what_the_reduction_makes_of_a_corner_is_within_the_error(width: float) -> None:
    """Free play that is taken up over `width` steps of the grid; the widest is one bend."""
    grid, samples = np.arange(-10.0, 11.0), np.linspace(-10.0, 10.0, 256)
    weights = local_weights(samples, grid, 1.5)
    for start in np.linspace(-0.5, 0.5, 11):
        reduced = weights @ np.clip((samples - start) / width, 0.0, 1.0)
        missed = np.abs(reduced - np.clip((grid - start) / width, 0.0, 1.0))
        error = corner_error(reduced, np.full(21, 1e-4))
        assert np.all(missed[2:-2] <= 1.5 * error[2:-2] + 1e-3)


def test_curves_are_interpolated_together_as_one_by_one() -> None:
    rng = np.random.default_rng(4)
    for points in (2, 3, 17):
        grid, rows = np.sort(rng.standard_normal(points)), rng.standard_normal((5, points))
        at = np.concatenate([2.0 * rng.standard_normal(20), grid])
        one_by_one = np.array([np.interp(at, grid, row) for row in rows])
        np.testing.assert_array_equal(_interpolated_rows(at, grid, rows), one_by_one)
