"""The eight K&C load cases; `LOAD_CASES` maps id to definition."""

from __future__ import annotations

import sys

from doe_kc.ground.registry import import_members
from doe_kc.load_cases._base import LOAD_CASES, Controls, Datum, LoadCase, load_case

import_members(sys.modules[__name__])

CASE_ORDER = (
    "vertical",
    "roll",
    "lateral",
    "lateral_opposite",
    "lateral_offset",
    "drive",
    "brake",
    "steer",
)


def case_label(load_case: str) -> str:
    """Name of a load case; Static for what needs none."""
    return LOAD_CASES[load_case].label if load_case in LOAD_CASES else load_case.capitalize()


__all__ = ["CASE_ORDER", "LOAD_CASES", "Controls", "Datum", "LoadCase", "case_label", "load_case"]
