"""Registered correlation methods, one module each."""

from __future__ import annotations

from doe_kc.correlation.methods._base import METHODS, Method, MethodSettings, check_method, method_class

__all__ = ["METHODS", "Method", "MethodSettings", "check_method", "method_class"]
