"""Dry friction along a damper that is no strut, with state: Dahl, Prandtl-Iwan, or a backbone of its own."""

from __future__ import annotations

from typing import ClassVar

from doe_kc.effects._base import Part, effect
from doe_kc.effects.strut_friction import StrutFriction


@effect
class DamperFriction(StrutFriction):
    """As that of a strut, between the ends of the damper."""

    id: ClassVar[str] = "damper_friction"
    label: ClassVar[str] = "Damper friction"
    counterpart: ClassVar[str] = "strut_friction"
    part: ClassVar[Part] = "damper"
