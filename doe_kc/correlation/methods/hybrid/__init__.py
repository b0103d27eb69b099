"""The method `hybrid`: several searches on one archive."""

from __future__ import annotations

from doe_kc.correlation.methods.hybrid.method import Hybrid

__all__ = ["Hybrid"]
