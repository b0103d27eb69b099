"""A hypercube keeps its slices whatever is exchanged: few exchanges where distances are not tested."""

from __future__ import annotations

import pytest


@pytest.fixture
def few_exchanges(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("doe_kc.sampling.maximin.MOST_EXCHANGES", 300)
