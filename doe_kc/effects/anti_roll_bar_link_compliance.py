"""Drop links with rubber ends: a spring at either end of the anti-roll bar, in series with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class AntiRollBarLinkCompliance(Effect):
    """Compliance of the anti-roll bar's drop links.

    A rig cannot tell it from a softer bar: only their series stiffness acts.
    """

    id: ClassVar[str] = "anti_roll_bar_link_compliance"
    label: ClassVar[str] = "Anti-roll bar link compliance"
    part: ClassVar[Part] = "bar"
    options: ClassVar[Mapping[str, Option]] = {"k_N_mm": Option(300.0, "N/mm")}

    physics: ClassVar[str] = (
        "The drop links' bushings yield before the bar twists, so that it resists roll less."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("arb.radius",)
    shown_by: ClassVar[str] = "travel of a drop link's two ends against each other in roll"
    sizes: ClassVar[tuple[Size, ...]] = (Size("k_N_mm", 300.0, "N/mm", "compliance"),)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return axle.changed({"arb.link_flexibility": 1.0 / options["k_N_mm"]})
