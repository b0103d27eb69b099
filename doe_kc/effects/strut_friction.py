"""Dry friction along the damper, with state: Dahl or Prandtl-Iwan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, effect
from doe_kc.effects.hypothesis import Size


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

    physics: ClassVar[str] = (
        "The damper rod sticks in its guide and seal, so that the tyre load lags behind wheel travel."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("steering_friction", "spring.rate")
    shown_by: ClassVar[str] = "tyre load over slow wheel travel up and down; the damper alone on a test bench"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("force_N", 120.0, "N"),
        Size("presliding_mm", 0.3, "mm", "shape"),
    )

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            both("strut_friction.force", options["force_N"])
            | both("strut_friction.presliding", options["presliding_mm"])
        )
        return replace(changed, topology=replace(axle.topology, strut_friction=options["law"]))
