from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.characteristics import CHARACTERISTICS, reduce_all
from doe_kc.curves import RIG_RESPONSES
from doe_kc.measurement import Measurement, reduce_measurement
from doe_kc.measurement.gradients import slope_weights
from tests.measurement.synthetic import reference, write_rig


def test_slope_weights_are_those_of_a_line() -> None:
    x = np.array([0.0, 1.0, 2.0, 5.0])
    assert slope_weights(x) @ (3.0 + 2.0 * x) == pytest.approx(2.0)


def test_every_curve_has_a_gradient_with_error_unit_and_window(car_a: Measurement) -> None:
    assert len(car_a.gradients) == 8 * 7 * 2
    by_name = {(g.load_case, g.response, g.side): g for g in car_a.gradients}
    rate = by_name["vertical", "tyre_load", "L"]
    assert rate.unit == "N/mm" and rate.window == 20.0
    assert rate.value == pytest.approx(26.26, abs=0.01) and 0.02 < rate.sd < 0.08
    assert all(g.sd > 0.0 for g in car_a.gradients)


GRADIENTS = {i for i, c in CHARACTERISTICS.items() if c.kind == "gradient" and c.response in RIG_RESPONSES}


def test_standard_errors_cover_the_truth(tmp_path: Path) -> None:
    """Pulls (value - truth) / sd over simulated tests have about unit spread."""
    pulls = []
    for seed in range(4):
        folder = tmp_path / str(seed)
        folder.mkdir()
        m = reduce_measurement(write_rig(folder, cases=("vertical", "lateral"), seed=100 + seed))
        expected = reduce_all(reference("nominal"))
        for ident, estimate in m.characteristics.items():
            if ident.startswith(("vertical", "lateral.")) and ident in GRADIENTS:
                pulls.append((estimate.value - expected[ident]) / estimate.sd)
    assert 0.5 < float(np.std(pulls)) < 1.6
    assert abs(float(np.mean(pulls))) < 0.8
