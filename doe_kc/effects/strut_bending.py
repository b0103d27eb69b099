"""Rotation springs between knuckle and damper tube at the strut clamp."""

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
class StrutBending(Effect):
    """law: linear, or stiffening. By that alone the stiffness goes to loaded_factor times what it is at rest,
    half of the way where the bending moment is reference_Nm off that at rest. Below 1 it softens."""

    id: ClassVar[str] = "strut_bending"
    part: ClassVar[Part] = "strut"
    label: ClassVar[str] = "Strut bending at the clamp"
    options: ClassVar[Mapping[str, Option]] = {
        "k_Nm_deg": Option(8000.0, "Nm/deg"),
        "torsion_Nm_deg": Option(30000.0, "Nm/deg"),
        **_stiffening.LAW_OPTIONS,
    }

    physics: ClassVar[str] = (
        "The damper bends and twists in its clamp, so that the wheel tilts and steers against the top mount."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("strut.flexibility", "hub_compliance", "upb.Fy", "upb.Fx")
    shown_by: ClassVar[str] = "a target on the damper tube above the clamp and one on the knuckle below it"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("k_Nm_deg", 8000.0, "Nm/deg", "compliance"),
        Size("torsion_Nm_deg", 30000.0, "Nm/deg", "compliance"),
    )
    laws: ClassVar[Mapping[str, tuple[Size, ...]]] = _stiffening.STIFFENING_LAWS
    replaces: ClassVar[tuple[str, ...]] = ("strut.flexibility",)

    def present(self, axle: Axle) -> bool:
        return axle.topology.strut_bending

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read(options, source, places)
        _stiffening.check_factor(checked, f"{source}: effect {self.id}")
        return checked

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values = both("strut.flexibility", 1.0)
        values |= both("strut.bending", options["k_Nm_deg"])
        values |= both("strut.torsion", options["torsion_Nm_deg"])
        law = _stiffening.law_values("strut", options)
        for name, value in law.items():
            values |= both(name, value)
        topology = replace(axle.topology, strut_bending=True, strut_stiffens=bool(law))
        return replace(axle.changed(values), topology=topology)
