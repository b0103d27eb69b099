"""Which hypotheses of a screening are refitted."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.leaders import overlooked
from doe_kc.discovery.screen import Screened
from tests.discovery.cases import library


def screened(absorbed: float, detectability: float, failed: str = "") -> Screened:
    (hypothesis,) = library("tie_rod_compliance")
    none: Any = np.zeros(1)
    return Screened(
        hypothesis, none, none, -3.5, 0.0, none[:, None], none, detectability, absorbed, none, failed
    )


@pytest.mark.parametrize(
    ("candidate", "refitted"),
    [
        (screened(0.98, 10.9), True),
        (screened(0.6, 10.9), False),
        (screened(0.98, 3.0), False),
        (screened(0.98, 10.9, "no equilibrium"), False),
    ],
    ids=["hidden almost wholly", "hardly hidden", "not seen at typical size", "without an equilibrium"],
)
def test_what_a_screening_may_have_missed(candidate: Screened, refitted: bool) -> None:
    assert overlooked([candidate], 9.1) == ([candidate] if refitted else [])
