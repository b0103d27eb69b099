"""Rotation springs between knuckle and wheel at the wheel centre, about the knuckle's X and Z.

By the law `stiffening` the moment about either axis is k phi (1 + (f - 1) q / (1 + q)), q = (k phi / M0)^2:
stiffness k at rest, f k where its linear part k phi is far beyond M0, half way between the two at M0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.axle.places import Places
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects.hypothesis import Size
from doe_kc.ground.errors import InputError

LINEAR, STIFFENING = "linear", "stiffening"
LEAST_FACTOR = 0.12
"""Factor f at which the slope of the moment, at least k (1 - 9/8 (1 - f)), is nearly zero."""
LOG_SD = 0.25
"""Of the factor: bearings are a quarter stiffer or softer under the loads of a rig. A choice."""
HALF_MOMENT = 300.0
"""Nm, M0: half of what 2 kN at the contact patch make at the wheel centre."""


@effect
class HubCompliance(Effect):
    """law: linear, or stiffening. By that alone the stiffness goes to loaded_factor times what it is at rest,
    half of the way at the moment reference_Nm. Below 1 it softens."""

    id: ClassVar[str] = "hub_compliance"
    label: ClassVar[str] = "Hub and wheel-bearing compliance"
    part: ClassVar[Part] = "axle"
    table: ClassVar[str] = "hub"
    options: ClassVar[Mapping[str, Option]] = {
        "camber_Nm_deg": Option(6000.0, "Nm/deg"),
        "toe_Nm_deg": Option(9000.0, "Nm/deg"),
        "law": Option(LINEAR, choices=(LINEAR, STIFFENING)),
        "loaded_factor": Option(1.0, "-"),
        "reference_Nm": Option(HALF_MOMENT, "Nm"),
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
    laws: ClassVar[Mapping[str, tuple[Size, ...]]] = {
        LINEAR: (),
        STIFFENING: (
            Size("loaded_factor", 1.0, "-", "shape", log_sd=LOG_SD),
            Size("reference_Nm", HALF_MOMENT, "Nm", "shape"),
        ),
    }

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read(options, source, places)
        factor = checked["loaded_factor"]
        if factor <= LEAST_FACTOR:
            raise InputError(
                f"{source}: effect {self.id}: loaded_factor = {factor:g}, expected more than {LEAST_FACTOR}: "
                "the moment would fall while the hub turns further."
            )
        return checked

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values = both("hub.camber", options["camber_Nm_deg"]) | both("hub.toe", options["toe_Nm_deg"])
        stiffens = options["law"] == STIFFENING
        if stiffens:
            values |= both("hub.loaded_factor", options["loaded_factor"])
            values |= both("hub.reference", options["reference_Nm"])
        topology = replace(axle.topology, hub=True, hub_stiffens=stiffens)
        return replace(axle.changed(values), topology=topology)
