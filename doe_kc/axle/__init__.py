"""The axle as data: its parameters, and how to change them."""

from __future__ import annotations

from doe_kc.axle.design_parameters import Parameter, design_parameters
from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import parameter_value, with_values
from doe_kc.axle.plausibility import axle_warnings

__all__ = [
    "Axle",
    "Parameter",
    "axle_warnings",
    "design_parameters",
    "parameter_value",
    "with_values",
]
