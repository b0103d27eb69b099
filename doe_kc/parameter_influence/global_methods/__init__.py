"""Methods of global sensitivity, one module each, registered by its id; imported when it is asked for."""

from __future__ import annotations

from doe_kc.parameter_influence.global_methods._base import (
    GLOBAL_METHODS,
    GlobalIndex,
    GlobalMethod,
    find_global_method,
)

__all__ = ["GLOBAL_METHODS", "GlobalIndex", "GlobalMethod", "find_global_method"]
