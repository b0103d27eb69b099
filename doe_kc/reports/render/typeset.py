"""Prose and cells of a page: true minus signs and arrows, and what a code stands for when pointed at."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache

from markupsafe import Markup, escape

from doe_kc.axle.model import BUSHING_AXES, EXTRA_HARDPOINTS, HARDPOINTS
from doe_kc.axle.parameter_kinds import (
    COORDINATES,
    KINDS,
    SIDE_PREFIXES,
    ParameterKind,
    bushing_kind,
    kind_of,
    point_kind,
)
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.effects import EFFECTS
from doe_kc.load_cases import case_label
from doe_kc.reports.names import within_sentence

MINUS = "\N{MINUS SIGN}"
_CODE = re.compile(r"(?<![\w.\]])(?:[A-Za-z]\w*\.)?[A-Za-z]\w*(?:\.[A-Za-z]\w*)?(?![\w\[])")
"""A word that may be a code: up to two dots between its parts."""
_EXPLAINED = re.compile(r'<abbr title="[^"]*">(?P<code>[\w.]+)</abbr>')
_NEGATIVE = re.compile(r"(?<![\w.)\]])-(?=[\d.])")
"""A hyphen that is the sign of a number: neither in a date, a file's name nor an exponent."""


def typeset(text: str) -> Markup:
    """Text of a page, escaped. `-3` gets its minus sign, `->` an arrow, `+-` its sign; a code such as
    `llr.Fx` says what it is when pointed at. `Markup` is taken as it is."""
    if isinstance(text, Markup):
        return text
    parts, end = [], 0
    for word in _CODE.finditer(text):
        means = meaning(word.group())
        if means:
            code = f'<abbr title="{escape(means)}">{word.group()}</abbr>'
            parts += [escape(signs(text[end : word.start()])), code]
            end = word.end()
    return Markup("".join([*parts, escape(signs(text[end:]))]))


def with_own_meanings(html: str, labels: Mapping[str, str]) -> str:
    """A page whose codes say what they are on this axle. labels: of its points and elements by name."""

    def own(match: re.Match[str]) -> str:
        means = _own_meaning(match["code"], labels)
        return f'<abbr title="{escape(means)}">{match["code"]}</abbr>' if means else match.group()

    return _EXPLAINED.sub(own, html)


def _own_meaning(code: str, labels: Mapping[str, str]) -> str:
    side, _, rest = code.partition(".")
    if side in SIDE_PREFIXES:
        means = _own_meaning(rest, labels)
        return f"{means}, {side} side alone" if means else ""
    if side not in labels:
        return ""
    if rest in COORDINATES:
        return _parameter(point_kind(labels[side], rest))
    if rest in BUSHING_AXES:
        return _parameter(bushing_kind(labels[side], rest))
    return "" if rest else f"Hardpoint: {labels[side].lower()}"


def signs(text: str) -> str:
    """Typewriter signs as those of print."""
    text = _NEGATIVE.sub(MINUS, text.replace("+-", "±").replace("->", "→"))
    return text.replace("^2", "²").replace("^3", "³")


def unsigned_zero(text: str) -> str:
    """A number that is written as zero, without a sign."""
    return text if text.strip("+-0. %") else text.lstrip("+-")


def meaning(code: str) -> str:
    """What a code is, from its declaration: parameter, hardpoint, characteristic, effect; empty for none."""
    side, _, rest = code.partition(".")
    known = _meanings()
    if side in SIDE_PREFIXES and rest in known:
        return f"{known[rest]}, {side} side alone"
    if code in known or not rest:
        return known.get(code, "")
    kind = kind_of(code)  # a point or bushing of an axle whose type is data
    return _parameter(kind) if kind is not None else ""


@lru_cache(maxsize=1)
def _meanings() -> Mapping[str, str]:
    points = {**HARDPOINTS, **EXTRA_HARDPOINTS}
    return {
        **{name: f"Hardpoint: {label.lower()}" for name, label in points.items()},
        **{
            c.id: f"{case_label(c.load_case)}: {within_sentence(c.label)}, {c.unit}"
            for c in CHARACTERISTICS.values()
        },
        **{name: f"Effect: {effect.label.lower()}" for name, effect in EFFECTS.items()},
        **{path: _parameter(kind) for path, kind in KINDS.items()},
    }


def _parameter(kind: ParameterKind) -> str:
    if kind.quantity == "stiffness":
        return f"{kind.label}: factor of the axle file's"
    return f"{kind.label}, {kind.unit}" if kind.unit != "-" else kind.label
