from __future__ import annotations

import pytest

from doe_kc.measurement import Measurement, reduce_measurement
from tests.measurement.synthetic import EXAMPLE


@pytest.fixture(scope="session")
def car_a() -> Measurement:
    """The shipped example, reduced."""
    return reduce_measurement(EXAMPLE / "test.toml")
