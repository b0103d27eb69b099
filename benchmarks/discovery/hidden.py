"""What can be hidden: one drawn effect, with what an analyser should find out about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from doe_kc.axle import Axle
from doe_kc.effects import apply_effect

ON_RIG = ("roll_technique", "rig_channel_gain", "rig_input_gain")


@dataclass(frozen=True)
class Hidden:
    """One effect of a car.

    id: as in `doe_kc.effects`. size: in typical sizes, signed where the effect is. location: bushing or
    joint, _L or _R for one side; None where there is no choice. options: of the effect's table.
    parameters: name -> value that an analyser should report, in the option's unit; stiff: options that are
    stiffnesses. stiffening: how much stiffer they are under full load than unloaded, as a fraction.
    tables: (bushing, axis) -> [[d, F], ...], in place of options. approximate: parameters stand for a law of
    another shape, so that their values agree in size only.
    """

    id: str
    size: float
    location: str | None = None
    options: Mapping[str, Any] = field(default_factory=dict)
    parameters: Mapping[str, float] = field(default_factory=dict)
    stiff: tuple[str, ...] = ()
    stiffening: float = 0.0
    tables: Mapping[tuple[str, str], list[list[float]]] = field(default_factory=dict)
    approximate: bool = False

    def applied(self, axle: Axle, load: float) -> Axle:
        """The axle with it; load: -1 unloaded, 1 under full load."""
        if self.id in ON_RIG or self.tables:
            return axle  # see `rig.py` and `Car.true_axle`
        factor = 1.0 + 0.5 * load * self.stiffening
        options = {k: v * factor if k in self.stiff else v for k, v in self.options.items()}
        return apply_effect(axle, self.id, options, source="hidden")
