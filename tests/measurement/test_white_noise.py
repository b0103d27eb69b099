from __future__ import annotations

import numpy as np
import pytest

from doe_kc.measurement.white_noise import pooled_white_sd, white_sd
from tests.measurement.synthetic import triangle


@pytest.mark.parametrize("sd", [0.001, 0.02, 3.0])
def test_white_noise_is_found_under_a_large_slow_signal(sd: float) -> None:
    rng = np.random.default_rng(1)
    signal = 1e3 * sd * np.cos(2.0 * triangle(512))
    runs = [signal + sd * rng.normal(size=(2, 512)) for _ in range(3)]
    assert pooled_white_sd(runs) == pytest.approx(sd, rel=0.06)


def test_a_clean_curve_has_none() -> None:
    assert white_sd(triangle(512)[None, :]) < 1e-12


def test_coarse_quantisation_still_shows() -> None:
    rng = np.random.default_rng(2)
    values = np.round(0.2 * rng.normal(size=(2, 512)))
    assert 0.0 < white_sd(values) < 0.3
