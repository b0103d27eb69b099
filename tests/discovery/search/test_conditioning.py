"""Loops before the record: which other one is tried, and what stands without friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.conditioning import with_conditioning
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import discovery


class Asked(DiscoveryWorkers):
    """Notes which axles are to be fitted, and fits none."""

    def __init__(self) -> None:
        super().__init__()
        self.loops: list[int] = []

    def fits(self, starts: Sequence[FitStart], what: str) -> list[Fit | None]:
        self.loops += [s.model.axle.conditioning for s in starts]
        return [None for _ in starts]


@pytest.mark.parametrize(("own", "other"), [(0, 1), (1, 0), (2, 0)])
def test_the_other_loop_is_one_that_an_axle_file_can_say(own: int, other: int) -> None:
    found = discovery("friction").search.with_law_discrepancy
    model = replace(found.model, axle=found.model.axle.conditioned(own))
    asked = Asked()
    current = replace(found, model=model)
    refit, sure = with_conditioning(current, model.axle, asked)
    assert refit is current and not sure
    assert asked.loops == [other]


def test_without_friction_the_loops_are_those_of_the_file() -> None:
    found = discovery("named").search.with_law_discrepancy
    assert not found.model.with_effects(found.z).topology.frictional
    looped = replace(found, model=replace(found.model, axle=found.model.axle.conditioned(1)))
    again, sure = with_conditioning(looped, found.model.axle, Asked())
    assert not sure
    assert again.model.axle.conditioning == 0
    np.testing.assert_allclose(again.model.residual(again.z), looped.residual, atol=1e-9)
