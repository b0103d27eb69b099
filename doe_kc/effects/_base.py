"""The contract of an optional effect: options in, a changed axle out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal

from doe_kc.axle.model import Axle
from doe_kc.axle.places import BALL_JOINT, Places, places_of
from doe_kc.curves import CurveSet
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects._tables import checked_number
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.errors import InputError, nearest


@dataclass(frozen=True)
class Option:
    """One key of an effect. unit: as in the key's suffix. positive: must be > 0 (numbers only)."""

    default: Any
    unit: str = ""
    positive: bool = True
    choices: tuple[str, ...] = ()


Part = Literal[
    "axle", "rack", "rods", "damper", "subframe", "bar", "balls", "ball_joint", "strut", "steer_arm"
]
"""axle: what every type has. rods: that the rack steers by. damper: one that is no strut. balls: ball joints
but `ball_joint`."""


class Effect(ABC):
    """Absent by default and free then; `apply` returns the axle that has it."""

    id: ClassVar[str]
    label: ClassVar[str]
    options: ClassVar[Mapping[str, Option]] = {}
    table: ClassVar[str] = ""
    """Other name under which files give the effect."""
    counterpart: ClassVar[str] = ""
    """Id of the same effect on axles that have another part; files may give either name on either axle."""
    physics: ClassVar[str]
    """One sentence: what happens in the car."""
    mistaken_for: ClassVar[tuple[str, ...]] = ()
    """Ids of effects, or paths of parameters, that look alike on a rig."""
    shown_by: ClassVar[str]
    """The component test or extra load case that would show it by itself."""
    sizes: ClassVar[tuple[Size, ...]] = ()
    """Numbers by which the effect grows, where it has one place only."""
    laws: ClassVar[Mapping[str, tuple[Size, ...]]] = {}
    """Values of the option `law`, the default first, each with the sizes that it has beside `sizes`: numbers
    of its shape. Empty for an effect of one law."""
    frictional: ClassVar[bool] = False
    """Whether it makes loops, so that the path of a load case matters."""
    replaces: ClassVar[tuple[str, ...]] = ()
    """Parameter paths that are this effect in other words: held while it is looked for."""
    part: ClassVar[Part] = "axle"
    """What an axle must have for the effect to be possible."""
    odds: ClassVar[float] = 1.0
    """How much likelier than other effects it is before any measurement."""
    spring: ClassVar[tuple[str, ...]] = ()
    """Paths of parameters whose product, N/mm, is the stiffness of a spring that stands, with the frictions
    of the part, on the compliance that the effect is; the last one is tuned. Empty where none does."""
    on_rig: ClassVar[bool] = False
    """True for a fault of the measurement: the axle stays as it is, `observe` changes what is read (and
    `extend` at most how a load case is run). Axle files do not hold such effects."""

    def possible(self, places: Places) -> bool:
        """Whether the axle has the part that the effect is of."""
        structure = places.structure
        having: Mapping[Part, bool] = {
            "axle": True,
            "rack": structure.rack is not None,
            "rods": structure.rack is not None and bool(structure.rack.rods),
            "damper": structure.damper is not None and structure.strut is None,
            "subframe": structure.subframe is not None,
            "bar": structure.bar is not None,
            "balls": bool(places.balls),
            "ball_joint": any(ball.name == BALL_JOINT for ball in structure.balls),
            "strut": structure.strut is not None,
            "steer_arm": structure.steer_arm is not None,
        }
        return having[self.part]

    def present(self, axle: Axle) -> bool:
        """Whether the axle has the effect already, so that it is not looked for."""
        return self.id in axle.effects

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        """The places and sizes in which the effect is looked for on an axle with these places."""
        del places
        return (Hypothesis(self.id, None, self.sizes),)

    def consequence(self, options: Mapping[str, Any]) -> str:
        """A sentence on what the effect means at its options beyond the axle; empty for most."""
        del options
        return ""

    def variants(self, hypothesis: Hypothesis) -> tuple[Hypothesis, ...]:
        """The hypothesis by each law that the effect can follow, the default one, itself, first."""
        others = list(self.laws.items())[1:]
        return (
            hypothesis,
            *(replace(hypothesis, law=law, sizes=(*hypothesis.sizes, *more)) for law, more in others),
        )

    def numbers_by(self, law: str, options: Mapping[str, Any]) -> Mapping[str, Any]:
        """Options with which the effect does by another law nearly what it does at some; without those that
        stay what they are, and those of the law that begin at typical."""
        del law, options
        return {}

    def observe(self, curves: CurveSet, options: Mapping[str, Any]) -> CurveSet:
        """What the rig reads of an axle's curves; the curves themselves unless `on_rig`."""
        del options
        return curves

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        """Options that give at once what the effect gave twice. axle: with both.

        By default the later ones replace the earlier.
        """
        del before, axle
        return dict(after)

    def reading_gains(self, options: Mapping[str, Any]) -> Mapping[str, float]:
        """Response -> factor by which `observe` multiplies its curves, and so their derivatives; 1 for a
        response that is not named."""
        del options
        return {}

    def apply(self, axle: Axle, options: Mapping[str, Any], source: str) -> Axle:
        """The axle with this effect; InputError for an unknown key or a value out of range."""
        places = places_of(axle)
        if not self.possible(places):
            raise InputError(
                f"{source}: effect {self.id}: the axle has nothing that it is an effect of; remove it."
            )
        return self.extend(axle, self.read(options, source, places))

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        """Checked options, defaults filled in. places: of the axle."""
        for key in options:
            if key not in self.options:
                raise InputError(
                    f"{source}: effect {self.id} has no key {key!r}; "
                    f"its keys are {', '.join(self.options) or 'none'}.{nearest(key, self.options)}"
                )
        return {
            key: self._checked(key, options.get(key, o.default), source) for key, o in self.options.items()
        }

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


EFFECTS: dict[str, Effect] = {}


def effect(cls: type[Effect]) -> type[Effect]:
    """Class decorator: register an effect."""
    EFFECTS[cls.id] = cls()
    return cls


def observed(axle: Axle, curves: CurveSet) -> CurveSet:
    """What the rig reads of the axle's own curves, with the faults that it has among its effects."""
    for ident, options in axle.effects.items():
        effect = EFFECTS[ident]
        if effect.on_rig:
            curves = effect.observe(curves, effect.read(options, axle.name))
    return curves


def reading_gains(axle: Axle) -> dict[str, float]:
    """Response -> factor between its curves and what the rig reads of them; 1 for one that is not named."""
    gains: dict[str, float] = {}
    for ident, options in axle.effects.items():
        effect = EFFECTS[ident]
        own = effect.reading_gains(effect.read(options, axle.name)) if effect.on_rig else {}
        gains |= {name: gains.get(name, 1.0) * gain for name, gain in own.items()}
    return gains


def effect_id(name: str, places: Places) -> str:
    """Id of the effect that the name of a table stands for on an axle with these places; the name itself
    where no effect has it."""
    ident = next((e.id for e in EFFECTS.values() if name and name in (e.id, e.table)), name)
    effect = EFFECTS.get(ident)
    if effect is None or not effect.counterpart or effect.possible(places):
        return ident
    return effect.counterpart


def apply_effect(axle: Axle, ident: str, options: Mapping[str, Any], *, source: str) -> Axle:
    """The axle with the effect `ident`; InputError when there is none of that name."""
    ident = effect_id(ident, places_of(axle))
    if ident not in EFFECTS:
        raise InputError(
            f"{source}: unknown effect {ident!r}; known are {', '.join(EFFECTS)}.{nearest(ident, EFFECTS)}"
        )
    effect = EFFECTS[ident]
    changed = effect.apply(axle, options, source)
    before = axle.effects.get(ident)
    all_options = dict(options) if before is None else effect.combined(before, options, changed)
    return replace(changed, effects={**axle.effects, ident: all_options})


def refuse_on_rig(ident: str, source: str) -> None:
    """InputError for a fault of the measurement in an axle file."""
    effect = EFFECTS.get(ident)
    if effect is not None and effect.on_rig:
        raise InputError(
            f"{source}: [effects.{ident}] is a fault of the measurement, but an axle file describes an axle; "
            "expected an effect in the car. Remove the table and correct the records instead."
        )
