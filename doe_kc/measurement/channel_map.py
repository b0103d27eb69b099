"""Rig channels to the quantities of a load case: which column, in which unit, with which sign."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES, SIDES
from doe_kc.ground.errors import InputError, nearest
from doe_kc.load_cases import LOAD_CASES, LoadCase
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.measurement.channels import RIG_NAMES, TIME, TIME_UNIT, Heading
from doe_kc.measurement.map_file import Frame, MapEntry, MapFile, read_map
from doe_kc.measurement.units import known_units, likely_unit, unit_factor

FRAME_SIGNS: Mapping[Frame, tuple[float, float, float]] = {
    "doe_kc": (1.0, 1.0, 1.0),
    "adams": (1.0, 1.0, 1.0),
    "iso_8855": (-1.0, -1.0, 1.0),
    "sae_j670": (-1.0, 1.0, -1.0),
}
"""Rig's axes -> factors of x, y, z to those of this package (docs/conventions.md)."""
INPUT_ROLE = "input"
INPUT_UNITS: Mapping[str, str] = {
    "pad_z": "mm",
    "roll": "deg",
    "force_x": "N",
    "force_y": "N",
    "steering_wheel": "deg",
}
QUANTITY_UNITS: Mapping[str, str] = {
    TIME: TIME_UNIT,
    **INPUT_UNITS,
    **{RIG_NAMES[r]: RESPONSE_UNITS[r] for r in RIG_RESPONSES},
}
"""Quantity of a map -> its unit in this package."""
Slot = tuple[str, str | None]
"""Quantity and side, None for what both wheels share."""
_AXES = {"wc_x": 0, "wc_y": 1, "wc_z": 2, "pad_z": 2, "force_x": 0, "force_y": 1}
_WHEEL_SHARES: Mapping[str, tuple[float, float]] = {
    "vertical": (0.5, 0.5),
    "roll": (-0.5, 0.5),
    "lateral": (0.5, 0.5),
    "lateral_offset": (0.5, 0.5),
    "lateral_opposite": (0.5, -0.5),
    "drive": (-0.5, -0.5),
    "brake": (0.5, 0.5),
}
"""Load case -> shares of the left and right wheel's own pad travel or force, chassis frame, in its input."""
_WHEEL_ROLES: dict[str, list[tuple[Slot, float]]] = {
    TIME: [((TIME, None), 1.0)],
    **{f"{r}_{s}": [((RIG_NAMES[r], s), 1.0)] for s in SIDES for r in RIG_RESPONSES},
}


@dataclass(frozen=True)
class MappedChannel:
    """A rig channel by its full name; `unit` None: that of the heading. own: from the test's own map, not
    from a preset."""

    name: str
    entry: MapEntry
    side: str | None
    own: bool

    @property
    def slot(self) -> Slot:
        """Quantity and side."""
        return self.entry.quantity, self.side


@dataclass(frozen=True)
class ColumnTerm:
    """A column's part in a quantity: factor * (recorded - offset)."""

    column: int
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class RecordColumns:
    """Where a record's quantities are. terms: role (`time`, `input`, `toe_L` ... by response) -> its columns.

    ignored: headings that nothing is read from.
    """

    case: LoadCase
    terms: Mapping[str, tuple[ColumnTerm, ...]]
    ignored: tuple[str, ...]


@dataclass(frozen=True)
class ChannelMap:
    """source: where it stands, for messages. absent: what the rig does not measure."""

    source: str
    channels: tuple[MappedChannel, ...]
    absent: frozenset[str] = frozenset()
    frame: Frame = "doe_kc"

    def lacks(self, quantity: str, side: str | None = None) -> bool:
        """Whether the map says that it was not measured."""
        return bool({quantity, side, f"{quantity}_{side}"} & self.absent)

    def columns(self, label: str, headings: Sequence[Heading], load_case: str) -> RecordColumns:
        """Columns of a record of `load_case`; InputError for missing, double and wrong-unit ones.

        label: the file (and sheet) for the message.
        """
        mapped = self._present(label, headings, load_case)
        case = _case_as_run(load_case, {slot[0] for slot in mapped})
        roles = _input_role(case, mapped) | _WHEEL_ROLES
        missing = [
            slot
            for role, slots in roles.items()
            for slot, _ in slots
            if slot not in mapped and (slot == (case.channel, None) or not self.lacks(*slot))
        ]
        if missing:
            raise InputError(self._lacking(label, headings, case, missing, mapped))
        for channel, _ in mapped.values():
            _refuse_double(label, channel.name, [h.name for h in headings])
        terms = {
            role: tuple(
                self._term(label, headings, *mapped[slot], share) for slot, share in slots if slot in mapped
            )
            for role, slots in roles.items()
        }
        used = {t.column for ts in terms.values() for t in ts}
        ignored = tuple(str(h) for i, h in enumerate(headings) if i not in used and h.name)
        return RecordColumns(case, {r: t for r, t in terms.items() if t}, ignored)

    def _present(
        self, label: str, headings: Sequence[Heading], load_case: str
    ) -> dict[Slot, tuple[MappedChannel, int]]:
        """Quantity and side -> its channel and column; the test's own entries before those of a preset."""
        names = [h.name for h in headings]
        out: dict[Slot, tuple[MappedChannel, int]] = {}
        for channel in self.channels:
            if channel.name not in names or (channel.entry.cases and load_case not in channel.entry.cases):
                continue
            taken = out.get(channel.slot)
            if taken is not None and taken[0].own and not channel.own:
                continue
            if taken is not None:
                _refuse_two(label, channel, taken[0], self.source)
            out[channel.slot] = channel, names.index(channel.name)
        return out

    def _lacking(
        self,
        label: str,
        headings: Sequence[Heading],
        case: LoadCase,
        missing: Sequence[Slot],
        mapped: Mapping[Slot, tuple[MappedChannel, int]],
    ) -> str:
        used = {column for _, column in mapped.values()}
        spare = [h.name for i, h in enumerate(headings) if h.name and i not in used]
        wanted = ", ".join(f'"{h}"{_taken_for(h.name, spare)}' for h in map(self._heading, missing))
        return (
            f"{label}: the heading row lacks {wanted}, needed for load case {case.id}; export the channel, "
            "map the rig's name for it in [channels] of test.toml (`doe-kc map` proposes a map), or name "
            "there in absent what the rig does not measure."
        )

    def _heading(self, slot: Slot) -> Heading:
        """What the map calls it."""
        quantity, side = slot
        own = quantity if side is None else f"{quantity}_{side}"
        name = next((c.name for c in self.channels if c.slot == slot), own)
        return Heading(name, QUANTITY_UNITS[quantity] if name == own else None)

    def _term(
        self, label: str, headings: Sequence[Heading], mapped: MappedChannel, column: int, share: float
    ) -> ColumnTerm:
        entry = mapped.entry
        factor = entry.sign * entry.scale * _factor(label, headings[column], column, entry)
        axis = _AXES.get(entry.quantity)
        if axis is not None and (mapped.side is not None or entry.quantity == "pad_z"):
            factor *= FRAME_SIGNS[self.frame][axis]
        return ColumnTerm(column, factor * share, entry.offset)


def _input_role(case: LoadCase, mapped: Mapping[Slot, object]) -> dict[str, list[tuple[Slot, float]]]:
    """The input: one channel, else those of both wheels with their shares, or of the one that is there."""
    shares = _WHEEL_SHARES.get(case.id)
    wheels = [(case.channel, side) for side in SIDES if (case.channel, side) in mapped]
    if (case.channel, None) in mapped or not wheels or shares is None:
        return {INPUT_ROLE: [((case.channel, None), 1.0)]}
    both = list(zip([(case.channel, side) for side in SIDES], shares, strict=True))
    kept = both if len(wheels) == len(SIDES) else [(w, np.sign(s)) for w, s in both if w in wheels]
    return {INPUT_ROLE: [(slot, float(share)) for slot, share in kept]}


def _case_as_run(load_case: str, quantities: set[str]) -> LoadCase:
    """Roll counts as counter-phase when the map finds pads in the record and no body roll."""
    if load_case == "roll":
        for technique in ROLL_TECHNIQUES.values():
            if technique.channel in quantities:
                return technique
    return LOAD_CASES[load_case]


def _factor(label: str, heading: Heading, column: int, entry: MapEntry) -> float:
    target = QUANTITY_UNITS[entry.quantity]
    unit = entry.unit if entry.unit is not None else heading.unit
    factor = None if unit is None else unit_factor(unit, target)
    if factor is not None:
        return factor
    have = "no unit" if unit is None else f"the unit [{unit}]"
    hint = "" if unit is None else likely_unit(unit, target)
    raise InputError(
        f'{label}: column {column + 1} "{heading.name}" has {have}, expected [{target}] or one of '
        f"{known_units(target)};{hint} Head the column with its unit in brackets, or give unit = in its "
        "entry of [channels]."
    )


def _refuse_two(label: str, channel: MappedChannel, other: MappedChannel, source: str) -> None:
    what = channel.entry.quantity if channel.side is None else f"{channel.entry.quantity}_{channel.side}"
    raise InputError(
        f'{label}: the columns "{other.name}" and "{channel.name}" are both mapped to {what} ({source}); '
        "expected one, so drop an entry or restrict it with cases = [...]."
    )


def _refuse_double(label: str, name: str, names: Sequence[str]) -> None:
    if names.count(name) > 1:
        at = " and ".join(str(i + 1) for i, n in enumerate(names) if n == name)
        raise InputError(
            f'{label}: columns {at} are both named "{name}"; expected it once, '
            "so rename or delete the one that is not meant."
        )


def _taken_for(name: str, spare: Sequence[str]) -> str:
    """Remark on the present column that was probably meant."""
    hint = nearest(name, spare)
    return "" if not hint else hint.replace(" Did you mean ", " (is it the column ").replace("?", "?)")


def channel_map(file: MapFile, folder: Path, source: str) -> ChannelMap:
    """A map with its preset, every `{side}` written out. folder: that paths are relative to.

    InputError for a preset that is not there, names itself, or an absent thing that is no quantity.
    """
    layers: list[MapFile] = [file]
    place, seen = folder, {source}
    while (name := layers[-1].preset) is not None:
        layer, at = read_map(name, place, source)
        if at in seen:
            raise InputError(f"{source}: preset {name} leads back to itself; drop one of the keys preset.")
        seen.add(at)
        layers.append(layer)
        place = Path(at).parent if not at.startswith("preset ") else place
    _check_absent(file.absent, source)
    channels = [c for i, layer in enumerate(layers) for c in _written_out(layer, i == 0, source)]
    frames: list[Frame] = [layer.frame for layer in layers if layer.frame is not None]
    absent = frozenset(a for layer in layers for a in layer.absent)
    return ChannelMap(source, tuple(channels), absent, frames[0] if frames else "doe_kc")


def named_map(name: str, folder: Path, source: str) -> ChannelMap:
    """A preset, or a map file by its path from `folder`."""
    file, at = read_map(name, folder, source)
    return channel_map(file, folder if at.startswith("preset ") else Path(at).parent, at)


def _written_out(layer: MapFile, own: bool, source: str) -> Iterator[MappedChannel]:
    for name, entries in layer.map.items():
        if "{side}" not in name:
            yield from (MappedChannel(name.strip(), e, e.side, own) for e in entries)
            continue
        for side in SIDES:
            full = name.replace("{side}", getattr(layer.sides, side)).strip()
            for entry in entries:
                if entry.side is not None:
                    raise InputError(
                        f'{source}: channels.map."{name}": says {{side}} and side = "{entry.side}"; drop one.'
                    )
                yield MappedChannel(full, entry, side, own)


def _check_absent(absent: Sequence[str], source: str) -> None:
    responses = [RIG_NAMES[r] for r in RIG_RESPONSES]
    known = [TIME, *SIDES, *responses, *(f"{r}_{s}" for r in responses for s in SIDES)]
    for name in absent:
        if name not in known:
            raise InputError(
                f"{source}: channels.absent: {name} is none of {', '.join(known)}; correct it."
                f"{nearest(name, known)}"
            )
