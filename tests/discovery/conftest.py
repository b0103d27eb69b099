"""Fits that several modules of tests begin with."""

from __future__ import annotations

import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from tests.discovery.cases import library, model


@pytest.fixture(scope="session")
def with_hub() -> Fit:
    """The car with a hub compliance, fitted with it."""
    (hub,) = library("hub_compliance")
    extended = model("named").extended(hub)
    return fit(extended, extended.centre)
