"""Friction inside the rubber of bushings, beside their elastic law along each translational axis."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from doe_kc.axle.model import BUSHINGS, Axle
from doe_kc.axle.places import Places, places_of
from doe_kc.axle.sliders import yield_ratios
from doe_kc.axle.structure import of_side
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects._friction import SPREAD
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects._tables import checked_number, named_numbers
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.errors import InputError, nearest


@dataclass(frozen=True)
class DynamicStiffness:
    """ratio: secant stiffness, peak force over peak travel, over the elastic stiffness at zero; >= 1.
    loss_angle: deg, its sine the work of a loop over pi times peak force times peak travel."""

    ratio: float
    loss_angle: float


def dynamic_stiffness(
    share: float, yield_mm: float, spread: float, amplitude: float, *, elastic: float = 1.0
) -> DynamicStiffness:
    """Of a steady loop of +-amplitude, mm, > 0, of one axis. elastic: secant stiffness of the elastic law
    there over that at zero.

    Slider j takes 4 k y (a - y) a loop beyond its yield distance y, nothing before.
    """
    yields = yield_mm * yield_ratios(spread)
    strength = share * yield_mm / yields.size
    ratio = elastic + float(np.sum(strength * np.minimum(1.0, amplitude / yields))) / amplitude
    work = 4.0 * strength * float(np.sum(np.maximum(amplitude - yields, 0.0)))
    return DynamicStiffness(ratio, float(np.degrees(np.arcsin(work / (np.pi * ratio * amplitude**2)))))


SPREAD_LOG_SD = 0.5
"""From 0.3, an almost sharp yield, to 2.2 within two standard deviations."""
SPREAD_STARTS = (-2.0, -1.0, 0.0, 1.0, 2.0)
"""Standard deviations of its logarithm: 0.29 to 2.2. Of a car of 0.5 fits from 0.29 and 1.3 ended there,
those from 0.38, 0.49, 0.8 and 2.2 at 0.60 and 0.73, 13 and 20 of ln evidence behind."""
FACTORS = {"share_factors": "share", "yield_factors": "yield_mm"}
"""Key of the factors of law each -> number that they multiply."""
UNLIKE_LOG_SD = 0.4
"""Of such a factor: bushings of one car are of like compounds in unlike shapes. A choice."""
NUMBERS = {"share": "share", "yield_mm": "yield", "spread": "spread"}
"""Key of the table -> last part of the axle value, as in `llr.rubber.share`."""
BENCH_TRAVELS = (0.05, 0.5, 2.0)
"""mm, of benches for dynamic stiffness, and of a K&C rig."""
REAR = ("LLR",)
"""The compliance bushing of the lower arm: the loops of drive and brake are its own."""
REST = "REST"
"""Location of all other bushings."""


@effect
class RubberHysteresis(Effect):
    """Sliders beside the elastic law along each local axis: on a first loading they add the stiffness
    share k, and they hold at most the force share k yield_mm, k the axis's stiffness at zero.

    bushings: those that have it. share, yield_mm, spread: a number for all of them, or a table such as
    { LLR = 0.3, UPB = 0.1 } that names each. law: alike, or each, by which share and yield_mm are times
    share_factors and yield_factors, lists of one for every bushing, in the order of the axle's. Per axis:
    which two axes of a bushing are its radial plane, in which one vector law would hold less on a diagonal
    path (by up to 1 - 1/sqrt(2)), no axle file says. Rotations have none: they would add about a newton to
    the wheel load.
    """

    id: ClassVar[str] = "rubber_hysteresis"
    label: ClassVar[str] = "Rubber hysteresis"
    part: ClassVar[Part] = "axle"
    frictional: ClassVar[bool] = True
    options: ClassVar[Mapping[str, Option]] = {
        "bushings": Option([b.upper() for b in BUSHINGS]),
        "share": Option(0.2, "-"),
        "yield_mm": Option(0.2, "mm"),
        "spread": Option(SPREAD, "-"),
        "law": Option("alike", choices=("alike", "each")),
        "share_factors": Option(None, "-"),
        "yield_factors": Option(None, "-"),
    }

    physics: ClassVar[str] = (
        "Filled rubber rubs inside, so that every bushing holds back a little on either way and is stiffer "
        "over a small travel than over a large one."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = (
        "steering_friction",
        "strut_friction",
        "damper_friction",
        "llr.Fy",
    )
    shown_by: ClassVar[str] = (
        "a slow force loop of the bushing on a test bench, at the rig's travel and at a tenth of it"
    )
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("share", 0.2, "-"),
        Size("yield_mm", 0.2, "mm", "shape"),
        Size("spread", SPREAD, "-", "shape", log_sd=SPREAD_LOG_SD, starts=SPREAD_STARTS),
    )

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        """All bushings by one share, and the two groups whose loops a rig tells apart."""
        names = [name.upper() for name in places.all_bushings]
        usual = names == self.options["bushings"].default
        everywhere = Hypothesis(self.id, None, self.sizes, {} if usual else {"bushings": names})
        if not set(REAR) <= set(names):
            return (everywhere,)
        rest = [name for name in names if name not in REAR]
        return (
            everywhere,
            Hypothesis(self.id, *REAR, self.sizes, {"bushings": list(REAR)}),
            Hypothesis(self.id, REST, self.sizes, {"bushings": rest}),
        )

    def variants(self, hypothesis: Hypothesis) -> tuple[Hypothesis, ...]:
        """The bushings alike, or each by factors of its own."""
        bushings = hypothesis.fixed.get("bushings", self.options["bushings"].default)
        if len(bushings) < 2:
            return (hypothesis,)
        factors = [
            Size(key, 1.0, "-", "shape", index=i, log_sd=UNLIKE_LOG_SD)
            for key in FACTORS
            for i in range(len(bushings))
        ]
        return hypothesis, replace(hypothesis, law="each", sizes=(*hypothesis.sizes, *factors))

    def consequence(self, options: Mapping[str, Any]) -> str:
        """What it makes of a supplier's dynamic stiffness; of the first bushing where they differ."""
        numbers = {k: options.get(k, o.default) for k, o in self.options.items() if k in NUMBERS}
        first = {k: next(iter(v.values())) if isinstance(v, Mapping) else v for k, v in numbers.items()}
        at = [dynamic_stiffness(**first, amplitude=amplitude) for amplitude in BENCH_TRAVELS]
        travels = ", ".join(f"{amplitude:g}" for amplitude in BENCH_TRAVELS)
        ratios = ", ".join(f"{each.ratio:.2f}" for each in at)
        angles = ", ".join(f"{each.loss_angle:.1f}" for each in at)
        return (
            f"Over ±{travels} mm such a bushing is {ratios} times as stiff as its elastic law, its loss "
            f"angle {angles} deg: a supplier's dynamic stiffness, measured over a small travel, is not "
            "the stiffness that the rig sees."
        )

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        """What every bushing that either names has now."""
        del before, after
        places = places_of(axle)  # law: alike, the numbers are those of each bushing
        own = {name: places.sides(name)[0] for name in axle.topology.rubber}
        return {
            "bushings": [name.upper() for name in own],
            **{
                key: {n.upper(): axle.values[of_side(f"{n}.rubber.{value}", side)] for n, side in own.items()}
                for key, value in NUMBERS.items()
            },
        }

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read({k: v for k, v in options.items() if k not in NUMBERS}, source, places)
        where = f"{source}: effect {self.id}"
        names = checked["bushings"] if "bushings" in options else [n.upper() for n in places.all_bushings]
        bushings = _bushings(names, where, places)
        numbers = {
            key: _numbers(key, options.get(key, self.options[key].default), bushings, where)
            for key in NUMBERS
        }
        factors = {key: _factors(key, checked[key], bushings, where) for key in FACTORS}
        return {"bushings": bushings, **numbers, "law": checked["law"], **factors}

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values: dict[str, float] = {}
        places = places_of(axle)
        for i, bushing in enumerate(options["bushings"]):
            factors = {n: options[k][i] for k, n in FACTORS.items()} if options["law"] == "each" else {}
            for key, value in NUMBERS.items():
                number = options[key]
                own = (number[bushing] if isinstance(number, Mapping) else number) * factors.get(key, 1.0)
                name = bushing.lower()
                values |= {of_side(f"{name}.rubber.{value}", s): own for s in places.sides(name)}
        there = {*axle.topology.rubber, *(name.lower() for name in options["bushings"])}
        rubber = tuple(name for name in places.all_bushings if name in there)
        return replace(axle.changed(values), topology=replace(axle.topology, rubber=rubber))


def _bushings(names: Any, where: str, places: Places) -> list[str]:
    """Upper-case names, each once."""
    known = [name.upper() for name in places.all_bushings]
    listed = names if isinstance(names, list | tuple) else [names]
    wrong = [name for name in listed if not isinstance(name, str) or name.upper() not in known]
    if wrong or not listed:
        hint = nearest(str(wrong[0]), known) if wrong else ""
        raise InputError(
            f"{where}: bushings = {names!r}, expected a list of some of {', '.join(known)}.{hint}"
        )
    return [name for name in known if name in {each.upper() for each in listed}]


def _numbers(key: str, value: Any, bushings: Iterable[str], where: str) -> float | dict[str, float]:
    """A number for all bushings, or one for each."""
    if not isinstance(value, Mapping) or not value:
        return checked_number(value, f"{where}: {key} = {value!r}", positive=True)
    table = {name.upper(): number for name, number in value.items()}
    checked = named_numbers(table, bushings, f"{where}: {key}", "one of its bushings", positive=True)
    missing = [name for name in bushings if name not in checked]
    if missing:
        raise InputError(
            f"{where}: {key} has no number for {', '.join(missing)}; add it, or give one for all."
        )
    return checked


def _factors(key: str, value: Any, bushings: Sequence[str], where: str) -> list[float]:
    """One for every bushing, 1 where none are given."""
    name = f"{where}: {key} = {value!r}"
    factors = [1.0] * len(bushings) if value is None else value
    if not isinstance(factors, Sequence) or isinstance(factors, str) or len(factors) != len(bushings):
        raise InputError(f"{name}, expected a list of {len(bushings)} numbers, for {', '.join(bushings)}.")
    return [checked_number(v, name, positive=True) for v in factors]
