"""Effects that give bushings a value along each of their axes: LLR = [x, y, z], mirrored on the right."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import FORCE_AXES, Axle
from doe_kc.axle.places import Places, places_of
from doe_kc.axle.structure import of_side
from doe_kc.effects._base import Effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects._tables import checked_flag, per_bushing
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.errors import InputError


class BushingValues(Effect):
    """`added = true` puts the values on top of the bushing's own; by default they replace them.

    quantity: middle part of the axle values, as in `llr.preload.Fx`. usual: size of most bushings; typical:
    of others. most: largest size that is believed, in typical ones.
    """

    quantity: ClassVar[str]
    unit: ClassVar[str]
    signed: ClassVar[bool]
    usual: ClassVar[float]
    typical: ClassVar[Mapping[str, float]] = {}
    most: ClassVar[float] = 3.0

    @abstractmethod
    def default(self) -> dict[str, list[float]]:
        """Values of an empty table."""

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        out = []
        for name in places.all_bushings:
            value = self.typical.get(name, self.usual)
            key = name.upper()
            sizes = [
                Size(key, value, self.unit, index=i, signed=self.signed, most=self.most) for i in range(3)
            ]
            out.append(Hypothesis(self.id, key, tuple(sizes), {"added": True}))
        return tuple(out)

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        """What the axle has in the bushings that either names, as values that replace the file's own."""
        places = places_of(axle)
        named = {**self.read(before, axle.name, places), **self.read(after, axle.name, places)}
        return {
            bushing.upper(): [self._own(axle, places, bushing, axis) for axis in FORCE_AXES]
            for bushing in named
            if bushing != "added"
        }

    def _own(self, axle: Axle, places: Places, bushing: str, axis: str) -> float:
        """What the axle has in a bushing, of its left side where there are two."""
        return axle.values[of_side(f"{bushing}.{self.quantity}.{axis}", places.sides(bushing)[0])]

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        table = {key: value for key, value in options.items() if key != "added"}
        added = checked_flag(options.get("added", False), f"{source}: effect {self.id}: added")
        if not table and not set(self.default()) <= {name.upper() for name in places.all_bushings}:
            raise InputError(
                f"{source}: effect {self.id}: names no bushing; expected a list of three numbers for one of "
                f"{', '.join(name.upper() for name in places.all_bushings)}."
            )
        return {
            "added": added,
            **per_bushing(table or self.default(), places.all_bushings, len(FORCE_AXES), source),
        }

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values: dict[str, float] = {}
        places = places_of(axle)
        for bushing in set(options) - {"added"}:
            for axis, value in zip(FORCE_AXES, options[bushing], strict=True):
                for side in places.sides(bushing):
                    name = of_side(f"{bushing}.{self.quantity}.{axis}", side)
                    values[name] = value + (axle.values[name] if options["added"] else 0.0)
        return axle.changed(values)
