"""Dry friction along the strut, with state: Dahl, Prandtl-Iwan, or a backbone of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.axle.topology import FrictionLaw
from doe_kc.effects._base import Option, Part, effect
from doe_kc.effects._friction import DryFriction, friction_options
from doe_kc.effects.hypothesis import Size


@effect
class StrutFriction(DryFriction):
    """Friction of the damper's rod in a strut that guides the wheel."""

    id: ClassVar[str] = "strut_friction"
    label: ClassVar[str] = "Strut friction"
    counterpart: ClassVar[str] = "damper_friction"
    part: ClassVar[Part] = "strut"
    options: ClassVar[Mapping[str, Option]] = friction_options(120.0, 0.3)

    physics: ClassVar[str] = (
        "The damper rod sticks in its guide and seal, so that the tyre load lags behind wheel travel."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("steering_friction", "spring.rate")
    shown_by: ClassVar[str] = "tyre load over slow wheel travel up and down; the damper alone on a test bench"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("force_N", 120.0, "N"),
        Size("presliding_mm", 0.3, "mm", "shape"),
    )

    def law_values(self, name: str, value: float) -> Mapping[str, float]:
        return both(f"strut_friction.{name}", value)

    def with_law(self, axle: Axle, law: FrictionLaw) -> Axle:
        return replace(axle, topology=replace(axle.topology, strut_friction=law))
