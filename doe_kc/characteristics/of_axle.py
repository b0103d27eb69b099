"""Which characteristics an axle has."""

from __future__ import annotations

from doe_kc.axle.model import Axle
from doe_kc.characteristics.registry import CHARACTERISTICS, Characteristic

KINGPIN_RESPONSE = "caster"
"""Response of the kingpin's own line; without a kingpin it would be that of the carrier once more."""


def characteristics_of(axle: Axle) -> list[Characteristic]:
    """Those of its load cases in the order of the registry; of the kingpin only where it has one."""
    kingpin = axle.topology.structure.kingpin is not None
    return [
        entry
        for entry in CHARACTERISTICS.values()
        if (entry.kind == "static" or entry.load_case in axle.load_cases)
        and (kingpin or entry.response != KINGPIN_RESPONSE)
    ]
