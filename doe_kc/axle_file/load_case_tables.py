"""The `[load_cases.ID]` tables of an axle file: the loops that are driven before the one that counts."""

from __future__ import annotations

import tomlkit

from doe_kc.axle.model import Axle

CONDITIONING = "conditioning"


def set_conditioning(document: tomlkit.TOMLDocument, axle: Axle) -> None:
    """The axle's conditioning loops in the document, where they are not what it says already."""
    tables = document.get("load_cases", {})
    for ident, case in axle.load_cases.items():
        if tables.get(ident, {}).get(CONDITIONING, 0) == case.conditioning:
            continue
        if "load_cases" not in document:
            document["load_cases"] = tomlkit.table(is_super_table=True)
        if ident not in document["load_cases"]:
            document["load_cases"][ident] = tomlkit.table()
        document["load_cases"][ident][CONDITIONING] = case.conditioning
