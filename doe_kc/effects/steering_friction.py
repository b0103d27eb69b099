"""Dry friction between rack and housing, with state: Dahl or Prandtl-Iwan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._base import Effect, Option, effect
from doe_kc.effects.hypothesis import Size


@effect
class SteeringFriction(Effect):
    """Steering friction."""

    id: ClassVar[str] = "steering_friction"
    label: ClassVar[str] = "Steering friction"
    options: ClassVar[Mapping[str, Option]] = {
        "force_N": Option(250.0, "N"),
        "presliding_mm": Option(0.05, "mm"),
        "law": Option("dahl", choices=("dahl", "iwan")),
    }

    physics: ClassVar[str] = (
        "The rack sticks in its housing, so that toe lags behind its load and both ways of a loop differ."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("strut_friction", "tie_rod_free_play")
    shown_by: ClassVar[str] = "hand-wheel torque over a slow steering sweep with unloaded wheels"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("force_N", 250.0, "N"),
        Size("presliding_mm", 0.05, "mm", "shape"),
    )

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            {
                "steering_friction.force": options["force_N"],
                "steering_friction.presliding": options["presliding_mm"],
            }
        )
        return replace(changed, topology=replace(axle.topology, steering_friction=options["law"]))
