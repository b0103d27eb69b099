"""The method `pareto`: a front of trade-offs."""

from __future__ import annotations

from doe_kc.correlation.methods.pareto.method import Pareto

__all__ = ["Pareto"]
