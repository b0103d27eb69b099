"""Gaussians cut at zero against the same by quadrature."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from doe_kc.discovery.half_lines import half_line_limit, half_line_moments


@pytest.mark.parametrize("centre", [-1.0, 0.0, 0.4, 1.0, 3.0, 40.0])
def test_moments_are_those_of_the_half_line(centre: float) -> None:
    sd = 0.5
    density = norm(centre, sd)
    ends = max(0.0, centre - 12.0 * sd), centre + 12.0 * sd

    def moment(power: int, about: float) -> float:
        return float(quad(lambda x: (x - about) ** power * density.pdf(x), *ends)[0] / density.sf(0.0))

    mean, own = half_line_moments(centre, sd)
    assert mean == pytest.approx(moment(1, 0.0), rel=1e-8)
    assert own**2 == pytest.approx(moment(2, mean), rel=1e-8)


def test_of_one_that_the_data_do_not_see_it_is_the_half_normal() -> None:
    assert half_line_moments(0.0, 1.0) == pytest.approx((np.sqrt(2.0 / np.pi), np.sqrt(1.0 - 2.0 / np.pi)))


@pytest.mark.parametrize("centre", [0.0, 1.0, 2.0, 30.0])
def test_a_limit_keeps_its_share_of_the_half_line(centre: float) -> None:
    limit = half_line_limit(centre, 2.0, 1.645)
    above = norm.sf(limit, centre, 2.0) / norm.sf(0.0, centre, 2.0)
    assert above == pytest.approx(norm.sf(1.645), rel=1e-6)
