"""In which places and sizes an effect is looked for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

Growth = Literal["amount", "compliance", "factor", "shape", "bend"]

ABSENT = 1e-4
"""Smallest amplitude of a size that cannot be negative: so small that it stands for none (rigid, no gap)."""
SHAPE_LOG_SD = 0.7
"""Standard deviation of the logarithm of a shape, such as a presliding distance: a factor of two."""


@dataclass(frozen=True)
class Size:
    """One number of a hypothesis, searched as an amplitude a: 0 without the effect, 1 at its typical size.

    key: option of the effect's table; index: place in it where the option is a list. typical: value at
    a = 1, in `unit`. growth: amount, value = typical a; compliance, value = typical a^(-1/power), rigid at
    0 (power 4 for a bar's radius); factor, value = typical^a; shape, value = typical exp(log_sd a), a
    number that says how and not how much, so that a = 0 is typical and a = 1 a standard deviation off; bend,
    value = typical a, a shape that may go either way and is none at 0.
    signed: whether a may be negative (shapes always may). most: largest |a| that such a part is believed to
    have. needed: whether without it what is left is another effect. present: whether every car has a little
    of it that nothing else of a model stands for, so that its trace has a mean. starts:
    amplitudes that fits begin from as well, where the cost along the number has several optima.
    """

    key: str
    typical: float
    unit: str
    growth: Growth = "amount"
    index: int | None = None
    signed: bool = False
    power: float = 1.0
    most: float = 3.0
    needed: bool = False
    present: bool = False
    log_sd: float = SHAPE_LOG_SD
    starts: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        """Unique in its hypothesis, e.g. `LLR[1]`."""
        return self.key if self.index is None else f"{self.key}[{self.index}]"

    @property
    def shape(self) -> bool:
        """Whether the number says how and not how much."""
        return self.growth in ("shape", "bend")

    @property
    def any_sign(self) -> bool:
        """Whether its amplitude may be negative."""
        return self.signed or self.shape

    def beside(self, amplitude: float, step: float) -> float:
        """An amplitude larger by a step; of one that stands for none, larger than the smallest that does not,
        to which it has the same value."""
        clipped = self.growth == "compliance" or (self.growth == "amount" and not self.signed)
        return (max(amplitude, ABSENT) if clipped else amplitude) + step

    def value(self, amplitude: float) -> float:
        """The option's number, in `unit`."""
        if self.growth == "bend":
            return self.typical * amplitude
        if self.growth == "amount":
            return self.typical * (amplitude if self.signed else max(amplitude, ABSENT))
        if self.growth == "compliance":
            return float(self.typical * max(amplitude, ABSENT) ** (-1.0 / self.power))
        if self.growth == "factor":
            return float(self.typical**amplitude)
        return float(self.typical * 2.718281828459045 ** (self.log_sd * amplitude))

    def amplitude(self, value: float) -> float:
        """The amplitude at which the option's number is a value, in `unit`; > 0 but of an amount or a
        bend."""
        if self.growth == "shape":
            return math.log(value / self.typical) / self.log_sd
        return self.over_typical(value)

    def over_typical(self, value: float) -> float:
        """How much of the effect a value, in `unit`, is over its typical size: of a stiffness, > 0, by its
        compliance, of a factor, > 0, by its logarithm."""
        if self.growth == "compliance":
            return float((self.typical / value) ** self.power)
        if self.growth == "factor":
            return math.log(value) / math.log(self.typical)
        return value / self.typical


@dataclass(frozen=True)
class Hypothesis:
    """An effect in one place. location: bushing or joint, with _L or _R for one side; None: no choice.

    sizes: none for an effect that is there or not. fixed: further options, as in the effect's table. law:
    option of that name, for a variant of the effect by another law than its default (see `Effect.variants`);
    a variant has the name of its effect, since a car has one of them.
    """

    effect: str
    location: str | None
    sizes: tuple[Size, ...]
    fixed: Mapping[str, Any] = field(default_factory=dict)
    law: str = ""

    @property
    def name(self) -> str:
        """Unique in the library, e.g. `bushing_preload LLR`; without a location by the words fixed."""
        words = [v for v in self.fixed.values() if isinstance(v, str)]
        where = words if self.location is None else [self.location]
        return " ".join([self.effect, *where])

    def options(self, amplitudes: Mapping[str, float]) -> dict[str, Any]:
        """The effect's table at the amplitudes, by `Size.name`."""
        out: dict[str, Any] = dict(self.fixed) | ({"law": self.law} if self.law else {})
        for size in self.sizes:
            value = size.value(amplitudes[size.name])
            if size.index is None:
                out[size.key] = value
            else:
                out.setdefault(size.key, [0.0] * (1 + max(s.index or 0 for s in self.sizes)))[size.index] = (
                    value
                )
        return out
