"""The contract of an optional effect: options in, a changed axle out."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.errors import InputError, nearest


@dataclass(frozen=True)
class Option:
    """One key of an effect. unit: as in the key's suffix. positive: must be > 0 (numbers only)."""

    default: Any
    unit: str = ""
    positive: bool = True
    choices: tuple[str, ...] = ()


class Effect(ABC):
    """Absent by default and free then; `apply` returns the axle that has it."""

    id: ClassVar[str]
    label: ClassVar[str]
    options: ClassVar[Mapping[str, Option]] = {}
    table: ClassVar[str] = ""
    """Other name under which files give the effect."""

    def apply(self, axle: Axle, given: Mapping[str, Any], source: str) -> Axle:
        """The axle with this effect; InputError for an unknown key or a value out of range."""
        return self.extend(axle, self.read(given, source))

    def read(self, given: Mapping[str, Any], source: str) -> dict[str, Any]:
        """Checked options, defaults filled in."""
        for key in given:
            if key not in self.options:
                raise InputError(
                    f"{source}: effect {self.id} has no key {key!r}; "
                    f"its keys are {', '.join(self.options) or 'none'}.{nearest(key, self.options)}"
                )
        return {key: self._checked(key, given.get(key, o.default), source) for key, o in self.options.items()}

    def _checked(self, key: str, value: Any, source: str) -> Any:
        option = self.options[key]
        name = f"{source}: effect {self.id}: {key} = {value!r}"
        if option.choices:
            if value not in option.choices:
                raise InputError(f"{name}, expected one of {', '.join(option.choices)}.")
            return value
        if isinstance(option.default, float):
            return checked_number(value, name, positive=option.positive)
        return value

    @abstractmethod
    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        """The changed axle, from checked options."""


def checked_number(value: Any, name: str, *, positive: bool = False) -> float:
    """The value as a float; InputError unless it is a finite (positive) number."""
    try:
        number = math.nan if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise InputError(f"{name}, expected a finite number.")
    if positive and number <= 0:
        raise InputError(f"{name}, expected a number > 0.")
    return number


EFFECTS: dict[str, Effect] = {}


def effect(cls: type[Effect]) -> type[Effect]:
    """Class decorator: register an effect."""
    EFFECTS[cls.id] = cls()
    return cls


def apply_effect(axle: Axle, ident: str, options: Mapping[str, Any], *, source: str) -> Axle:
    """The axle with the effect `ident`; InputError when there is none of that name."""
    ident = next((e.id for e in EFFECTS.values() if ident and e.table == ident), ident)
    if ident not in EFFECTS:
        raise InputError(
            f"{source}: unknown effect {ident!r}; known are {', '.join(EFFECTS)}.{nearest(ident, EFFECTS)}"
        )
    changed = EFFECTS[ident].apply(axle, options, source)
    return replace(changed, effects={**axle.effects, ident: dict(options)})


def per_bushing(
    given: Mapping[str, Any], known: Mapping[str, str], length: int, source: str
) -> dict[str, list[float]]:
    """Options of the form LLR = [x, y, z], keyed by the lower-case bushing name."""
    out = {}
    for key, value in given.items():
        if key.lower() not in known:
            raise InputError(
                f"{source}: {key!r} is not a bushing; known are {', '.join(k.upper() for k in known)}."
                f"{nearest(key.lower(), known)}"
            )
        if not isinstance(value, list | tuple) or len(value) != length:
            raise InputError(f"{source}: {key} = {value!r}, expected a list of {length} numbers.")
        out[key.lower()] = [checked_number(v, f"{source}: {key} = {value!r}") for v in value]
    return out
