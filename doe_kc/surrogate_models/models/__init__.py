"""Registered surrogates, one module each; `SURROGATES` maps id to class."""

from __future__ import annotations

import sys

from doe_kc.ground.registry import import_members
from doe_kc.surrogate_models.models._base import SURROGATES, make, register

import_members(sys.modules[__name__])

__all__ = ["SURROGATES", "make", "register"]
