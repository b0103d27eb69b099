"""Dry friction between rack and housing, with state: Dahl, Prandtl-Iwan, or a backbone of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

from doe_kc.axle.model import Axle
from doe_kc.axle.topology import FrictionLaw
from doe_kc.effects._base import Option, Part, effect
from doe_kc.effects._friction import DryFriction, friction_options
from doe_kc.effects.hypothesis import Size


@effect
class SteeringFriction(DryFriction):
    """Steering friction."""

    id: ClassVar[str] = "steering_friction"
    label: ClassVar[str] = "Steering friction"
    part: ClassVar[Part] = "rack"
    options: ClassVar[Mapping[str, Option]] = friction_options(250.0, 0.05)

    physics: ClassVar[str] = (
        "The rack sticks in its housing, so that toe lags behind its load and both ways of a loop differ."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("strut_friction", "damper_friction", "tie_rod_free_play")
    shown_by: ClassVar[str] = "hand-wheel torque over a slow steering sweep with unloaded wheels"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("force_N", 250.0, "N"),
        Size("presliding_mm", 0.05, "mm", "shape"),
    )

    def law_values(self, name: str, value: float) -> Mapping[str, float]:
        return {f"steering_friction.{name}": value}

    def with_law(self, axle: Axle, law: FrictionLaw) -> Axle:
        return replace(axle, topology=replace(axle.topology, steering_friction=law))
