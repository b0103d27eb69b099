"""Rotation springs between knuckle and wheel at the wheel centre, about the knuckle's X and Z."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.axle.places import Places
from doe_kc.effects import _stiffening
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects.hypothesis import Size


@effect
class HubCompliance(Effect):
    """law: linear, or stiffening, about either axis for itself. By that alone the stiffness goes to
    loaded_factor times what it is at rest, half of the way at the moment reference_Nm. Below 1 it softens."""

    id: ClassVar[str] = "hub_compliance"
    label: ClassVar[str] = "Hub and wheel-bearing compliance"
    part: ClassVar[Part] = "axle"
    table: ClassVar[str] = "hub"
    options: ClassVar[Mapping[str, Option]] = {
        "camber_Nm_deg": Option(6000.0, "Nm/deg"),
        "toe_Nm_deg": Option(9000.0, "Nm/deg"),
        **_stiffening.LAW_OPTIONS,
    }

    physics: ClassVar[str] = (
        "Wheel bearing and knuckle yield, so that the wheel tilts and turns against its carrier under load."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = (
        *("strut_bending", "ball_joint_compliance", "ball_compliance", "upb.Fy"),
    )
    shown_by: ClassVar[str] = (
        "camber at the hub against a target on the knuckle under lateral force; a pure overturning moment"
    )
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("camber_Nm_deg", 6000.0, "Nm/deg", "compliance"),
        Size("toe_Nm_deg", 9000.0, "Nm/deg", "compliance"),
    )
    laws: ClassVar[Mapping[str, tuple[Size, ...]]] = _stiffening.STIFFENING_LAWS

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read(options, source, places)
        _stiffening.check_factor(checked, f"{source}: effect {self.id}")
        return checked

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values = both("hub.camber", options["camber_Nm_deg"]) | both("hub.toe", options["toe_Nm_deg"])
        law = _stiffening.law_values("hub", options)
        for name, value in law.items():
            values |= both(name, value)
        topology = replace(axle.topology, hub=True, hub_stiffens=bool(law))
        return replace(axle.changed(values), topology=topology)
