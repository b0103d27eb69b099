"""Axle types: which bodies, points and connections an axle has, read from type files."""

from __future__ import annotations

from doe_kc.axle_types.read import BUILT_IN, DEFAULT_TYPE, AxleType, built_in, read_axle_type

__all__ = ["BUILT_IN", "DEFAULT_TYPE", "AxleType", "built_in", "read_axle_type"]
