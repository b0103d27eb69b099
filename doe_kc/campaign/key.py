"""The name of a design in the store: the same for the same numbers, however they were computed."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping

from doe_kc.ground.errors import InputError

KEY_DIGITS = 12
"""Significant digits that tell two designs apart: 0.1 + 0.2 is 0.3."""


def rounded(value: float) -> float:
    """The value with twelve significant digits; -0 is 0."""
    return float(f"{value:.{KEY_DIGITS}g}") + 0.0


def design_key(values: Mapping[str, float]) -> str:
    """SHA-256 of the sorted path/value pairs, 64 hex digits; InputError for a value that is not finite."""
    for path, value in values.items():
        if not math.isfinite(value):
            raise InputError(f"design: {path} = {value}, expected a finite number.")
    pairs = [(path, repr(rounded(float(value)))) for path, value in sorted(values.items())]
    return hashlib.sha256(json.dumps(pairs).encode()).hexdigest()
