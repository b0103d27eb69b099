"""The suites: what is hidden in a car of each, and what the analyser is told."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from benchmarks.discovery.catalogue import CATALOGUE, REFERENCE
from benchmarks.discovery.chance import log_uniform, stream
from benchmarks.discovery.further import FURTHER
from benchmarks.discovery.hidden import Hidden
from benchmarks.discovery.other_laws import OTHER_LAWS, STEERING_LAWS, friction_on_mount, rubber
from benchmarks.discovery.outside import OUTSIDE, Outside
from benchmarks.discovery.scatter import Spread
from doe_kc.axle import Axle
from doe_kc.axle.places import places_of
from doe_kc.effects import EFFECTS

FULL = (0.5, 2.0)
"""Sizes, in typical ones."""
WEAK = (0.1, 0.3)
BOTH = (0.7, 2.0)
MANY = (3, 6)
"""Effects in a car of several."""
ALIKE = (
    ("hub_compliance", "strut_bending"),
    ("rack_mount_compliance", "tie_rod_compliance"),
    ("hub_compliance", "ball_joint_compliance"),
    ("bushing_preload", "ride_height_offset"),
    ("steering_friction", "tie_rod_free_play"),
    ("subframe_flexibility", "rack_mount_compliance"),
    ("bushing_progression", "bushing_preload"),
    ("subframe_flexibility", "ball_joint_compliance"),
)
"""Pairs that a rig hardly tells apart; one of each is hidden, if the library has both."""
WITHOUT_PLACE = (
    "hub_compliance",
    "strut_friction",
    "damper_friction",
    "subframe_flexibility",
    "tyre_horizontal_compliance",
    "ride_height_offset",
    "rack_mount_compliance",
    "steering_friction",
)
"""Effects of any axle type that are there or not, as far as it has the part."""
NOT_REMOVABLE = ("left_right_asymmetry", "ride_height_offset", "roll_technique")
"""Tunable parameters say the same, so that without them nothing is missing."""


@dataclass(frozen=True)
class Content:
    """What a suite puts into one car. exclude: effects that the analyser's library has to do without."""

    hidden: tuple[Hidden, ...] = ()
    outside: Outside | None = None
    exclude: tuple[str, ...] = ()
    spread: Spread = field(default_factory=Spread)
    pair: tuple[str, ...] = ()


Fill = Callable[[int, np.random.Generator, Axle], Content]


def _pick(items: Sequence[str], seed: int, suite: str) -> str:
    """Every item once in each run of as many seeds, in an order that seeds do not tell."""
    block, at = divmod(seed, len(items))
    return items[int(stream(block, "order", suite).permutation(len(items))[at])]


def _hide(ident: str, sizes: tuple[float, float], rng: np.random.Generator, axle: Axle) -> Hidden:
    return CATALOGUE[ident](rng, log_uniform(rng, *sizes), axle)


def null(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    return Content()


def single(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    return Content((_hide(_pick(REFERENCE, seed, "single"), FULL, rng, axle),))


def further(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    return Content((_hide(_pick(FURTHER, seed, "further"), FULL, rng, axle),))


def weak(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    sized = [e for e in REFERENCE if e != "roll_technique"]
    return Content((_hide(_pick(sized, seed, "weak"), WEAK, rng, axle),))


def confounded(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    pairs = [p for p in ALIKE if all(e in CATALOGUE for e in p)]
    chosen = pairs[seed % len(pairs)]
    return Content((_hide(chosen[int(rng.integers(2))], FULL, rng, axle),), pair=chosen)


def two(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    """Any two, but not two of which one hides the other by construction."""
    first = _pick(REFERENCE, seed, "two")
    rivals = {e for p in ALIKE if first in p for e in p} | {first}
    second = str(rng.choice([e for e in REFERENCE if e not in rivals]))
    return Content(tuple(_hide(e, BOTH, rng, axle) for e in (first, second)))


def library_deleted(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    listed = [e for e in REFERENCE if e not in NOT_REMOVABLE]
    ident = _pick(listed, seed, "library_deleted")
    return Content((_hide(ident, BOTH, rng, axle),), exclude=(ident,))


def outside(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    return Content(outside=OUTSIDE[_pick(list(OUTSIDE), seed, "outside")](rng))


def wrong_priors(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    """A single effect in a car of a series that is off nominal as a whole, and scatters more or less."""
    width = 0.5 if rng.random() < 0.5 else 2.0
    hidden = _hide(_pick(REFERENCE, seed, "wrong_priors"), FULL, rng, axle)
    return Content((hidden,), spread=Spread(shift=1.0, width=width))


def many(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    """Three to six effects, no two of which one hides the other by construction."""
    count = int(rng.integers(MANY[0], MANY[1] + 1))
    chosen = [_pick(REFERENCE, seed, "many")]
    for ident in rng.permutation([e for e in REFERENCE if e not in chosen]):
        rivals = {e for p in ALIKE for e in p if set(p) & set(chosen)}
        if len(chosen) < count and str(ident) not in rivals:
            chosen.append(str(ident))
    return Content(tuple(_hide(e, BOTH, rng, axle) for e in chosen))


def many_rubber(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    """The same in a car whose bushings all have rubber hysteresis."""
    return Content((*many(seed, rng, axle).hidden, rubber(rng, log_uniform(rng, *BOTH), axle)))


def rubber_alone(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    return Content((rubber(rng, log_uniform(rng, *BOTH), axle),))


def other_law(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    """A single effect by a law that the analyser's default does not have."""
    draw = OTHER_LAWS[_pick(list(OTHER_LAWS), seed, "other_law")]
    return Content((draw(rng, log_uniform(rng, *BOTH), axle),))


def on_mount(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    """A steering friction by any of several laws on a mount of the rack that yields."""
    law = int(_pick([str(i) for i in range(len(STEERING_LAWS))], seed, "friction_on_mount"))
    return Content(friction_on_mount(law, BOTH, rng, axle))


def of_type(seed: int, rng: np.random.Generator, axle: Axle) -> Content:
    """One effect in every other car, two in the rest, of those that have no place on the axle to choose."""
    possible = [e for e in WITHOUT_PLACE if EFFECTS[e].possible(places_of(axle))]
    first = _pick(possible, seed // 2, "type")
    if seed % 2 == 0:
        return Content((_hide(first, FULL, rng, axle),))
    rivals = {e for p in ALIKE if first in p for e in p} | {first}
    second = str(rng.choice([e for e in possible if e not in rivals]))
    return Content(tuple(_hide(e, BOTH, rng, axle) for e in (first, second)))


SUITES: dict[str, Fill] = {
    "null": null,
    "single": single,
    "further": further,
    "weak": weak,
    "confounded": confounded,
    "two": two,
    "library_deleted": library_deleted,
    "outside": outside,
    "wrong_priors": wrong_priors,
    "many": many,
    "many_rubber": many_rubber,
    "rubber": rubber_alone,
    "other_law": other_law,
    "friction_on_mount": on_mount,
}
TYPE_SUITES: dict[str, Fill] = {"null": null, "type": of_type}
"""Suites of the bases that are other axle types."""
ALL_SUITES = SUITES | TYPE_SUITES
