"""Registered correlation methods, a module or a folder each; none imports from another."""

from __future__ import annotations

from doe_kc.correlation.methods._base import METHODS, Method, MethodSettings, check_method, method_class

__all__ = ["METHODS", "Method", "MethodSettings", "check_method", "method_class"]
