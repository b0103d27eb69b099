"""Dry friction along one motion: its limit, the distance over which it builds up, and the law between."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, cast

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places
from doe_kc.axle.sliders import BACKBONE_YIELDS
from doe_kc.axle.topology import FrictionLaw
from doe_kc.effects._backbone import VirginCurve, nearest_backbone, nearest_shape, virgin_curve
from doe_kc.effects._base import Effect, Option
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects._series import on_compliance
from doe_kc.effects._tables import checked_number
from doe_kc.effects.hypothesis import Size
from doe_kc.ground.errors import InputError

EXPONENT = 1.0
"""Of Dahl's law itself."""
SPREAD = 0.8
"""Standard deviation of the logarithm of yield displacements whose virgin curve is nearly exponential, as
Dahl's is: sqrt(trigamma(2)) = 0.803. A measured loop of a bushing, fitted by four sliders, has 0.81."""
BACKBONE_SHARES = (0.04, 0.07, 0.10, 0.13, 0.19, 0.32, 0.15)
"""Shares of the sliders of a free backbone whose virgin curve is nearly exponential: 1 - (1 + y) exp(-y)
between the geometric means of neighbouring yield displacements."""

LIMIT, TRAVEL, SHARES = "force_N", "presliding_mm", "shares"
"""Options of a friction: what it is when it slides, how far it moves before, and of the free backbone, the
shares of its sliders."""
FREE_LAW = "backbone"
"""The law with a backbone of its own."""

SHARE_LOG_SD = 1.5
"""So wide that one slider may hold nearly all: a factor of 4.5 each."""


class DryFriction(Effect):
    """force_N: limit. presliding_mm: limit over initial stiffness. law: see `laws`. exponent: of law duhem
    only; spread: of law lognormal only; shares: of law backbone only, of each slider in the limit, in
    proportion."""

    frictional: ClassVar[bool] = True
    laws: ClassVar[Mapping[str, tuple[Size, ...]]] = {
        "dahl": (),
        "iwan": (),
        "duhem": (Size("exponent", EXPONENT, "-", "shape"),),
        "lognormal": (Size("spread", SPREAD, "-", "shape"),),
        "backbone": tuple(
            Size("shares", share, "-", "shape", index=i, log_sd=SHARE_LOG_SD)
            for i, share in enumerate(BACKBONE_SHARES)
        ),
    }

    @abstractmethod
    def law_values(self, name: str, value: float) -> Mapping[str, float]:
        """Axle values of one number of the law, such as `spread`."""

    @abstractmethod
    def with_law(self, axle: Axle, law: FrictionLaw) -> Axle:
        """The axle whose equations have the law."""

    def numbers_by(self, law: str, options: Mapping[str, Any]) -> Mapping[str, Any]:
        own = self.read(options, self.label)
        if (law == FREE_LAW) == (own["law"] == FREE_LAW):
            return {}
        if law == FREE_LAW:
            return _free_numbers(_curve(own), own[LIMIT], own[TRAVEL])
        return self._closed_numbers(_curve(own), own[LIMIT], own[TRAVEL], law)

    def on_compliance(
        self, law: str, options: Mapping[str, Any], spring: float, ratio: float
    ) -> Mapping[str, Any]:
        """Options by a law with which the friction, on a compliance in series with it and a spring, makes
        nearly the loops that it makes at some options without.

        spring: N/mm, of that beside it without the compliance. ratio: of the limits, and of the springs;
        below 1 the compliance is taken away. See `_series`.
        """
        own = self.read(options, self.label)
        limit, travel = ratio * own[LIMIT], own[TRAVEL]
        curve = on_compliance(_curve(own), own[LIMIT] / (spring * travel), ratio)
        if law == FREE_LAW:
            return _free_numbers(curve, limit, travel)
        return self._closed_numbers(curve, limit, travel, law)

    def with_travel(self, options: Mapping[str, Any], factor: float) -> Mapping[str, Any]:
        """Options of the free backbone of another travel that does nearly what one does at some options: its
        sliders yield elsewhere. factor: of the travel."""
        own = self.read(options, self.label)
        return _free_numbers(_curve(own), own[LIMIT], own[TRAVEL], factor)

    def _closed_numbers(self, curve: VirginCurve, limit: float, travel: float, law: str) -> Mapping[str, Any]:
        """Options of a closed law near a curve, as `_free_numbers`."""
        name = law or next(iter(self.laws))
        shape = nearest_shape(curve, cast(FrictionLaw, name))
        numbers = {size.key: shape.number for size in self.laws[name]}
        return {LIMIT: limit, TRAVEL: travel * shape.travel, **numbers}

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read(options, source, places)
        shares = checked["shares"]
        own = BACKBONE_SHARES if shares is None else shares
        return checked | {"shares": _shares(own, f"{source}: effect {self.id}")}

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        numbers = {"force": options["force_N"], "presliding": options["presliding_mm"]}
        numbers |= {key: options[key] for key in ("exponent", "spread")}
        numbers |= {f"share{i}": share for i, share in enumerate(options["shares"])}
        values = {k: v for name, number in numbers.items() for k, v in self.law_values(name, number).items()}
        return self.with_law(axle.changed(values), options["law"])


def _curve(options: Mapping[str, Any]) -> VirginCurve:
    """Of checked options."""
    return virgin_curve(options["law"], options["exponent"], options["spread"], options["shares"])


def _free_numbers(
    curve: VirginCurve, limit: float, travel: float, factor: float | None = None
) -> Mapping[str, Any]:
    """Options of the free backbone nearest to a curve whose force and distances are over a limit, N, and a
    travel, mm. factor: of that travel, None for the best."""
    free = nearest_backbone(curve, BACKBONE_SHARES, None if factor is None else np.array([factor]))
    return {LIMIT: free.limit * limit, TRAVEL: free.travel * travel, SHARES: list(free.shares)}


def friction_options(force: float, presliding: float) -> dict[str, Option]:
    """Options of a dry friction, with its default limit in N and distance in mm; shares: BACKBONE_SHARES."""
    return {
        "force_N": Option(force, "N"),
        "presliding_mm": Option(presliding, "mm"),
        "law": Option("dahl", choices=tuple(DryFriction.laws)),
        "exponent": Option(EXPONENT, "-"),
        "spread": Option(SPREAD, "-"),
        "shares": Option(None, "-"),
    }


def _shares(values: Any, where: str) -> list[float]:
    name = f"{where}: shares = {values!r}"
    if not isinstance(values, Sequence) or isinstance(values, str) or len(values) != len(BACKBONE_YIELDS):
        raise InputError(f"{name}, expected a list of {len(BACKBONE_YIELDS)} numbers.")
    return [checked_number(v, name, positive=True) for v in values]
