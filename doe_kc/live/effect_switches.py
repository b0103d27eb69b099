"""Effects as switches of a live page: those that the axle can be given, and those that its file has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from doe_kc.axle.model import Axle
from doe_kc.axle.places import places_of
from doe_kc.axle_file import axle_from_document
from doe_kc.effects import EFFECTS, apply_effect
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.effects.words import effect_label, hypothesis_label
from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_toml
from doe_kc.reports.discovery.effect_words import size_name
from doe_kc.study import Study

EffectSizes = Mapping[str, Mapping[str, float] | None]
"""Name of a switch -> name of a size -> value in its unit: effects that are on beside those of the axle file,
or in other sizes than there. None: an effect of the file that is switched off."""
Place = tuple[str | int, ...]
"""Keys and indices that lead to a number of an effect's table."""


@dataclass(frozen=True)
class SwitchSize:
    """One number of a switch. value: typical, of an effect of the file that of the file."""

    name: str
    label: str
    unit: str
    value: float
    place: Place

    def number_in(self, table: Mapping[str, Any]) -> float:
        """The size of an effect's table that has it."""
        inner: Any = table
        for key in self.place:
            inner = inner[key]
        return float(inner)


@dataclass(frozen=True)
class EffectSwitch:
    """name: unique on the page. effect: its id. of_file: whether the axle file has it. table: the effect's
    options with every size at its value. law: of a variant by another law than the effect's own, else empty.
    """

    name: str
    effect: str
    label: str
    of_file: bool
    table: Mapping[str, Any]
    sizes: tuple[SwitchSize, ...]
    law: str = ""

    def options(self, sizes: Mapping[str, float]) -> dict[str, Any]:
        """The effect's table at sizes in their units; InputError for one that it has not."""
        places = {s.name: s.place for s in self.sizes}
        out = _copied(self.table)
        for name, value in sizes.items():
            if name not in places:
                raise InputError(f"effect {self.name!r}: has no size {name!r}.")
            _put(out, places[name], value)
        return dict(out)


def effect_switches(study: Study) -> dict[str, EffectSwitch]:
    """By name: the effects of the axle file, those in the car that it can be given, and these by their other
    laws. None for an outside solver: its model has the effects that it has.

    Faults of a measurement are none: they say nothing of the axle.
    """
    if study.solver.command:
        return {}
    axle, places = study.axle, places_of(study.axle)
    own = [_of_file(ident, table) for ident, table in axle.effects.items()]
    possible = [e for e in EFFECTS.values() if not e.on_rig and not e.present(axle) and e.possible(places)]
    library = [_of_library(v) for e in possible for h in e.hypotheses(places) for v in e.variants(h)]
    return {s.name: s for s in (*own, *library)}


def variant_name(hypothesis: Hypothesis) -> str:
    """Name of its switch."""
    return f"{hypothesis.name}, {hypothesis.law}" if hypothesis.law else hypothesis.name


def _of_library(hypothesis: Hypothesis) -> EffectSwitch:
    table = hypothesis.options({s.name: 0.0 if s.shape else 1.0 for s in hypothesis.sizes})
    sizes = []
    for size in hypothesis.sizes:
        place: Place = (size.key,) if size.index is None else (size.key, size.index)
        _put(table, place, size.typical)
        label = size_name(size, hypothesis.location)
        sizes.append(SwitchSize(size.name, label, size.unit, size.typical, place))
    law = hypothesis.law
    return EffectSwitch(
        name=variant_name(hypothesis),
        effect=hypothesis.effect,
        label=hypothesis_label(hypothesis) + (f", law {law}" if law else ""),
        of_file=False,
        table=table,
        sizes=tuple(sizes),
        law=law,
    )


def _of_file(ident: str, table: Mapping[str, Any]) -> EffectSwitch:
    """Its sizes: every number of its table, and those that the table leaves at their defaults."""
    effect = EFFECTS[ident]
    defaults = {s.key: effect.options[s.key].default for s in effect.sizes if s.key in effect.options}
    every = {**{k: v for k, v in defaults.items() if isinstance(v, float)}, **_copied(table)}
    units = {key: option.unit for key, option in effect.options.items()}
    fallback = str(getattr(effect, "unit", "-"))
    sizes = []
    for place, value in _numbers(every):
        key = str(place[0])
        unit = units.get(key, fallback)
        index = place[1] if len(place) == 2 and isinstance(place[1], int) else None
        label = size_name(Size(key, 1.0, unit, "amount" if key.isupper() else "shape", index))
        if len(place) > 1 and index is None:
            label = str(place[-1])
        name = key + "".join(f"[{part}]" for part in place[1:])
        sizes.append(SwitchSize(name, label, unit, value, place))
    law = table.get("law", "")
    label = effect_label(ident) + (f", law {law}" if law else "")
    return EffectSwitch(ident, ident, label, True, every, tuple(sizes))


def _numbers(table: Any, place: Place = ()) -> Iterator[tuple[Place, float]]:
    if isinstance(table, Mapping):
        items: Any = table.items()
    elif isinstance(table, list | tuple):
        items = enumerate(table)
    else:
        if isinstance(table, int | float) and not isinstance(table, bool):
            yield place, float(table)
        return
    for key, value in items:
        yield from _numbers(value, (*place, key))


def _copied(table: Any) -> Any:
    """With lists in place of tuples, so that numbers can be set."""
    if isinstance(table, Mapping):
        return {key: _copied(value) for key, value in table.items()}
    return [_copied(value) for value in table] if isinstance(table, list | tuple) else table


def _put(table: Any, place: Place, value: float) -> None:
    *way, last = place
    for key in way:
        table = table[key]
    table[last] = value


def effective_axle(study: Study, effects: EffectSizes) -> Axle:
    """The study's axle with its effects switched and sized; InputError naming the effect for what it cannot
    have."""
    known = effect_switches(study)
    for name, sizes in effects.items():
        if name not in known:
            raise InputError(f"effect {name!r}: is none that this axle can be given; choose one of the list.")
        if sizes is None and not known[name].of_file:
            raise InputError(f"effect {name!r}: is not in the axle file, so it is off without a word.")
    _check_once([known[name] for name, sizes in effects.items() if sizes is not None])
    axle = _with_file_effects(study, effects, known)
    for name, sizes in effects.items():
        if sizes is not None and not known[name].of_file:
            axle = apply_effect(axle, known[name].effect, known[name].options(sizes), source="live")
    return axle


def _check_once(switches: list[EffectSwitch]) -> None:
    """InputError where an effect is on by two laws: the later one would replace the other."""
    places: dict[str, str] = {}
    for switch in switches:
        place = switch.name.removesuffix(f", {switch.law}") if switch.law else switch.name
        if place in places:
            raise InputError(f"effect {switch.name!r}: is on as {places[place]!r} already; switch that off.")
        places[place] = switch.name


def _with_file_effects(study: Study, effects: EffectSizes, known: Mapping[str, EffectSwitch]) -> Axle:
    """The study's axle with the effects of its file in the sizes set; from the file anew where they differ,
    for an effect cannot be taken off an axle."""
    if not any(known[name].of_file for name in effects):
        return study.axle
    document = read_toml(study.axle_path)
    document = {key: value for key, value in document.items() if key != "effects"}
    bare = axle_from_document(document, source=str(study.axle_path), folder=study.axle_path.parent)
    axle = study.as_measured(bare)
    for name, switch in known.items():
        sizes = effects.get(name, {})
        if switch.of_file and sizes is not None:
            axle = apply_effect(axle, switch.effect, switch.options(sizes), source="live")
    return axle
