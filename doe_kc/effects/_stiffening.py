"""Rotation springs that are stiffer, or softer, under load: one law for hub and strut clamp.

The moment is k phi (1 + (f - 1) q / (1 + q)), q = (k phi / M0)^2: stiffness k at rest, f k where its linear
part k phi is far beyond M0, half way between the two at M0.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from doe_kc.effects._base import Option
from doe_kc.effects.hypothesis import Size
from doe_kc.ground.errors import InputError

LINEAR, STIFFENING = "linear", "stiffening"
LEAST_FACTOR = 0.12
"""Factor f at which the slope of the moment, at least k (1 - 9/8 (1 - f)), is nearly zero."""
LOG_SD = 0.25
"""Of the factor: bearings and clamps are a quarter stiffer or softer under the loads of a rig. A choice."""
HALF_MOMENT = 300.0
"""Nm, M0: half of what 2 kN at the contact patch make at the wheel centre."""

LAW_OPTIONS: Mapping[str, Option] = {
    "law": Option(LINEAR, choices=(LINEAR, STIFFENING)),
    "loaded_factor": Option(1.0, "-"),
    "reference_Nm": Option(HALF_MOMENT, "Nm"),
}
STIFFENING_LAWS: Mapping[str, tuple[Size, ...]] = {
    LINEAR: (),
    STIFFENING: (
        Size("loaded_factor", 1.0, "-", "shape", log_sd=LOG_SD),
        Size("reference_Nm", HALF_MOMENT, "Nm", "shape"),
    ),
}


def check_factor(options: Mapping[str, Any], where: str) -> None:
    """InputError where the moment would fall while the spring turns further; where: file and effect."""
    factor = options["loaded_factor"]
    if factor <= LEAST_FACTOR:
        raise InputError(
            f"{where}: loaded_factor = {factor:g}, expected more than {LEAST_FACTOR}: "
            "the moment would fall while the part turns further."
        )


def law_values(prefix: str, options: Mapping[str, Any]) -> dict[str, float]:
    """Axle values of the law by their names without side; none of a linear spring."""
    if options["law"] == LINEAR:
        return {}
    return {
        f"{prefix}.loaded_factor": options["loaded_factor"],
        f"{prefix}.reference": options["reference_Nm"],
    }
