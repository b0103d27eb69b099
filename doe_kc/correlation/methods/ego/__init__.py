"""The method `ego`: composite efficient global optimization."""

from __future__ import annotations

from doe_kc.correlation.methods.ego.method import Ego

__all__ = ["Ego"]
