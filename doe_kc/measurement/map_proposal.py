"""What a rig's channel and file names say: quantity, side, unit, load case; nothing where they say two
things."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from doe_kc.measurement.channel_map import INPUT_UNITS, QUANTITY_UNITS
from doe_kc.measurement.channels import Heading
from doe_kc.measurement.units import UNIT_FACTORS, plain_unit, unit_factor

_WORDS: Sequence[tuple[str, str]] = (
    ("time", r"^(time|zeit|timesec|t|times)$|^time|^zeit"),
    (
        "",
        r"track|spurweite|ackermann|ratio|rollcent|rollzentrum|scrub|trail|velocity|speed|temperatur|temp$|pressure|druck",
    ),
    ("steering_wheel", r"steeringwheel|handwheel|lenkrad|lenkwinkel|^swa|steerangle"),
    ("roll", r"bodyroll|rollangle|^roll$|wank"),
    ("camber", r"camber|sturz"),
    ("caster", r"caster|castor|nachlauf|spin"),
    ("toe", r"toe|spur"),
    ("tyre_load", r"(force|kraft).?z|tyreload|tireload|wheelload|radlast|aufstand|fz(?![a-z])|verticalforce"),
    (
        "force_x",
        r"(force|kraft).?x|fx(?![a-z])|l(ä|ae)ngskraft|longitudinalforce|brakeforce|driveforce|bremskraft",
    ),
    ("force_y", r"(force|kraft).?y|fy(?![a-z])|seitenkraft|querkraft|lateralforce"),
    ("pad_z", r"pad|table|platform|platte|stempel|postz"),
    (
        "wc_x",
        r"(wheelcent(re|er)|radmitte|radmittelpunkt|wc|centre|wheeltobody|hub|rad).?(disp)?x(?![a-z]*y)",
    ),
    ("wc_y", r"(wheelcent(re|er)|radmitte|radmittelpunkt|wc|centre|wheeltobody|hub|rad).?(disp)?y"),
    (
        "wc_z",
        r"(wheelcent(re|er)|radmitte|radmittelpunkt|wc|centre|wheeltobody|hub|rad).?(disp)?z|wheeltravel|einfeder",
    ),
)
"""Quantity and what names it: English and German; the first that fits. Without a quantity: channels of
others."""
_SIDES: Mapping[str, re.Pattern[str]] = {
    "L": re.compile(
        r"(?:^|[^A-Za-z])(?:LH|L|FL|VL|RL|HL|LF|LR|left|links|Left|Links|li)(?=$|[^a-z])|[FR]?LH(?=[a-zA-Z])|Left|Links"
    ),
    "R": re.compile(
        r"(?:^|[^A-Za-z])(?:RH|R|FR|VR|RR|HR|RF|right|rechts|Right|Rechts|re)(?=$|[^a-z])|[FR]?RH(?=[a-zA-Z])|Right|Rechts"
    ),
}
_CASES: Sequence[tuple[str, str]] = (
    (
        "lateral_opposite",
        r"(lateral|quer|seiten).*(oppos|anti|gegen)|(oppos|anti|gegen).*(lateral|quer|seiten)",
    ),
    ("lateral_offset", r"(lateral|quer|seiten).*(offset|30|trail|versatz)"),
    ("lateral", r"lateral|quer|seiten"),
    ("drive", r"drive|accel|traction|antrieb|beschl|strapped"),
    ("brake", r"brak|brems"),
    ("steer", r"steer|lenk"),
    ("roll", r"roll|wank"),
    ("vertical", r"vertical|bounce|heave|bump|hub|einfeder|parallel"),
)
_SUFFIX = re.compile(r"(?:^|[^A-Za-z]|(?<=[a-z])|(?<=[XYZ]))(deg|mm|kN|N|rad|min|sec|s|m)$")


@dataclass(frozen=True)
class ChannelGuess:
    """name: of the rig. quantity, side, unit: what it is; unit None where neither heading nor name tells it.
    reason: in words. sign: +1 or -1."""

    name: str
    quantity: str
    side: str | None
    unit: str | None
    reason: str
    sign: int = 1

    @property
    def slot(self) -> tuple[str, str | None]:
        """Quantity and side."""
        return self.quantity, self.side


def guess_channel(heading: Heading) -> ChannelGuess | None:
    """By its name and unit; None where they tell no quantity, or a unit of something else."""
    name, suffix = _bare(heading.name)
    for words in _SIDES.values():
        name = words.sub(" ", name) if len(words.sub("", name)) > 1 else name
    plain = re.sub(r"[^a-zäöü0-9]", "", name.lower())
    quantity = next((q for q, words in _WORDS if re.search(words, plain)), "")
    if not quantity:
        return None
    target = QUANTITY_UNITS[quantity]
    stated = heading.unit or suffix
    if stated is not None and unit_factor(stated, target) is None:
        return None
    side = guess_side(heading.name)
    if side is None and quantity not in INPUT_UNITS and quantity != "time":
        return None
    reason = "name" if stated is None else f"name, {'unit' if heading.unit else 'end of the name'} {stated}"
    return ChannelGuess(
        heading.name, quantity, side if quantity not in ("time", "roll") else None, stated, reason
    )


def guess_side(name: str) -> str | None:
    """L or R, None where the name says neither or both."""
    sides = [side for side, words in _SIDES.items() if words.search(name)]
    return sides[0] if len(sides) == 1 else None


def guess_case(text: str) -> str | None:
    """Load case by a file's or sheet's name."""
    plain = re.sub(r"[^a-zäöü0-9]", "", text.lower())
    return next((case for case, words in _CASES if re.search(words, plain)), None)


def _bare(name: str) -> tuple[str, str | None]:
    """A name without the unit at its end, and that unit."""
    match = _SUFFIX.search(name)
    if match is None or len(name) <= len(match[1]) + 1:
        return name, None
    known = any(plain_unit(match[1]) in factors for factors in UNIT_FACTORS.values())
    return (name[: -len(match[1])], match[1]) if known else (name, None)


def distinct(guesses: Sequence[ChannelGuess]) -> tuple[list[ChannelGuess], list[str]]:
    """Those whose quantity and side no other channel claims; in words, the others."""
    by_slot: dict[tuple[str, str | None], list[ChannelGuess]] = {}
    for guess in guesses:
        by_slot.setdefault(guess.slot, []).append(guess)
    kept = [own[0] for own in by_slot.values() if len(own) == 1]
    open_ones = [
        f"{', '.join(g.name for g in own)}: each may be {quantity if side is None else f'{quantity}_{side}'}"
        for (quantity, side), own in by_slot.items()
        if len(own) > 1
    ]
    return kept, open_ones


def reversed_sign(guess: ChannelGuess, reason: str) -> ChannelGuess:
    """With the opposite sign."""
    return replace(guess, sign=-guess.sign, reason=f"{guess.reason}; {reason}")
