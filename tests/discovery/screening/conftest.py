"""The fit that hypotheses are screened at."""

from __future__ import annotations

import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from tests.discovery.cases import model


@pytest.fixture(scope="session")
def tuned() -> Fit:
    """The car with a hub compliance, re-tuned without it."""
    car = model("named")
    return fit(car, car.centre)
