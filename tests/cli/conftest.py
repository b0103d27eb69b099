from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import pytest

from doe_kc.reports.comparison import figures as comparison_figures
from doe_kc.reports.correlation import figures as correlation_figures
from doe_kc.reports.influence import figures as influence_figures
from doe_kc.reports.measurement import figures as rig_figures
from doe_kc.workflow import write_discovery


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures take seconds; their own tests draw them."""

    def nothing(*_args: object, **_options: object) -> list[Path]:
        return []

    monkeypatch.setattr(rig_figures, "write_rig_figures", nothing)
    monkeypatch.setattr(comparison_figures, "write_comparison_figures", nothing)
    monkeypatch.setattr(influence_figures, "write_influence_figures", nothing)
    monkeypatch.setattr(correlation_figures, "write_correlation_figures", nothing)
    monkeypatch.setattr(write_discovery, "discovery_figures", lambda *_, **__: nullcontext([]))
