"""Dry friction along the damper, with state: Dahl or Prandtl-Iwan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, effect


@effect
class StrutFriction(Effect):
    """Strut friction."""

    id: ClassVar[str] = "strut_friction"
    label: ClassVar[str] = "Strut friction"
    options: ClassVar[Mapping[str, Option]] = {
        "force_N": Option(120.0, "N"),
        "presliding_mm": Option(0.3, "mm"),
        "law": Option("dahl", choices=("dahl", "iwan")),
    }

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            both("strut_friction.force", options["force_N"])
            | both("strut_friction.presliding", options["presliding_mm"])
        )
        return replace(changed, topology=replace(axle.topology, strut_friction=options["law"]))
