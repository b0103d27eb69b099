"""Registered correlation methods, one module each."""

from __future__ import annotations

import sys

from doe_kc.correlation.methods._base import METHODS, Method, Settings, method_class
from doe_kc.registry import import_members

import_members(sys.modules[__name__])

__all__ = ["METHODS", "Method", "Settings", "method_class"]
