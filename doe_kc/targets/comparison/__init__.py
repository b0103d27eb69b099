"""Model against measurement: characteristics with their constraint intervals, curves with their RMS."""

from __future__ import annotations

from doe_kc.targets.comparison.compare import (
    CharacteristicComparison,
    Comparison,
    CurveComparison,
    compare,
)

__all__ = ["CharacteristicComparison", "Comparison", "CurveComparison", "compare"]
