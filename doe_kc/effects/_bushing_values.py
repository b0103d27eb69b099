"""Effects that give bushings a value along each of their axes: LLR = [x, y, z], mirrored on the right."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import BUSHINGS, FORCE_AXES, Axle
from doe_kc.curves import SIDES
from doe_kc.effects._base import Effect
from doe_kc.effects._tables import checked_flag, per_bushing
from doe_kc.effects.hypothesis import Hypothesis, Size


class BushingValues(Effect):
    """`added = true` puts the values on top of the bushing's own; by default they replace them.

    quantity: middle part of the axle values, as in `llr.preload.Fx`. typical: size by bushing. most:
    largest size that is believed, in typical ones.
    """

    quantity: ClassVar[str]
    unit: ClassVar[str]
    signed: ClassVar[bool]
    typical: ClassVar[Mapping[str, float]]
    most: ClassVar[float] = 3.0

    @abstractmethod
    def default(self) -> dict[str, list[float]]:
        """Values of an empty table."""

    def hypotheses(self) -> tuple[Hypothesis, ...]:
        out = []
        for name, value in self.typical.items():
            key = name.upper()
            sizes = [
                Size(key, value, self.unit, index=i, signed=self.signed, most=self.most) for i in range(3)
            ]
            out.append(Hypothesis(self.id, key, tuple(sizes), {"added": True}))
        return tuple(out)

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        """What the axle has in the bushings that either names, as values that replace the file's own."""
        named = {**self.read(before, axle.name), **self.read(after, axle.name)}
        return {
            bushing.upper(): [axle.values[f"{bushing}.{self.quantity}.{axis}@L"] for axis in FORCE_AXES]
            for bushing in named
            if bushing != "added"
        }

    def read(self, options: Mapping[str, Any], source: str) -> dict[str, Any]:
        table = {key: value for key, value in options.items() if key != "added"}
        added = checked_flag(options.get("added", False), f"{source}: effect {self.id}: added")
        return {"added": added, **per_bushing(table or self.default(), BUSHINGS, len(FORCE_AXES), source)}

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values: dict[str, float] = {}
        for bushing in set(options) - {"added"}:
            for axis, value in zip(FORCE_AXES, options[bushing], strict=True):
                for side in SIDES:
                    name = f"{bushing}.{self.quantity}.{axis}@{side}"
                    values[name] = value + (axle.values[name] if options["added"] else 0.0)
        return axle.changed(values)
