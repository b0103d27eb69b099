"""An analyser's answer, read from its JSON; what is missing there counts as not said."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from benchmarks.discovery.exclusions import Excluded, read_excluded

Verdict = Literal["named", "class", "none", "unexplained", "failed"]
SURE = 0.9
"""Probability from which an effect counts as named."""


@dataclass(frozen=True)
class Named:
    """One effect of an answer. parameters: name -> (value, standard deviation)."""

    id: str
    location: str | None
    probability: float
    parameters: Mapping[str, tuple[float, float]]
    verdict: str = ""
    """Its own: `named`, `class` or `lead`."""
    limits: Mapping[str, float] = field(default_factory=dict)
    """Name -> what a number that is not told from none is at most, at 95 %; of a stiffness at least."""
    unshown: frozenset[str] = frozenset()
    """Names of numbers that the records do not show."""


@dataclass(frozen=True)
class Answer:
    """effects: most important first. traces: effects too small for a name. classes: ids that are not told
    apart, one tuple an effect.

    unexplained_at: (load case, response). gap: nominal, tuned, with_effect, best_decoy as whitened RMS.
    held_out: load case -> (tuned, with effect). diagnosable: effect -> (detectability, chance of a wrong
    name), where the analyser says so.
    """

    verdict: Verdict
    effects: tuple[Named, ...]
    traces: tuple[Named, ...]
    classes: tuple[tuple[str, ...], ...]
    unexplained_at: tuple[tuple[str, str], ...]
    gap: Mapping[str, float]
    held_out: Mapping[str, tuple[float, float]]
    diagnosable: Mapping[str, tuple[float, float]]
    excluded: tuple[Excluded, ...]
    not_testable: frozenset[str]
    seconds: float

    @property
    def names(self) -> tuple[str, ...]:
        """Ids that the answer commits itself to; members of a class and leads are no names."""
        if self.verdict not in ("named", "class"):
            return ()
        unsure = {e for c in self.classes if len(set(c)) > 1 for e in c}
        return tuple(
            dict.fromkeys(e.id for e in self.effects if e.probability >= SURE and e.id not in unsure)
        )

    @property
    def committed(self) -> tuple[str, ...]:
        """Names, and those that are certain beside something unexplained."""
        if self.verdict != "unexplained":
            return self.names
        return tuple(dict.fromkeys(e.id for e in self.told if e.probability >= SURE))

    @property
    def told(self) -> tuple[Named, ...]:
        """Effects that it gives as found, also beside something unexplained."""
        if self.verdict == "unexplained":
            return tuple(e for e in self.effects if e.verdict == "named")
        return self.effects if self.verdict in ("named", "class") else ()

    @property
    def offered(self) -> frozenset[str]:
        """Names and the members of all classes."""
        if self.verdict not in ("named", "class"):
            return frozenset()
        return frozenset(self.names) | {e for c in self.classes for e in c} | {e.id for e in self.effects}

    @property
    def first(self) -> str:
        """What the answer puts first: an id, or `none`, `unexplained`, `failed`."""
        if self.verdict in ("named", "class"):
            if self.effects:
                return self.effects[0].id
            return self.classes[0][0] if self.classes and self.classes[0] else "none"
        return self.verdict


FAILED = Answer("failed", (), (), (), (), {}, {}, {}, (), frozenset(), float("nan"))
"""The analyser gave none."""


def read_answer(data: Mapping[str, Any] | None) -> Answer:
    """From the stored JSON; None for a case whose analysis broke off."""
    if data is None or data.get("verdict") not in ("named", "class", "none", "unexplained"):
        return FAILED
    return Answer(
        verdict=data["verdict"],
        effects=tuple(_named(e) for e in data.get("effects") or ()),
        traces=tuple(_named(e) for e in data.get("traces") or ()),
        classes=tuple(tuple(c) for c in data.get("classes") or ()),
        unexplained_at=tuple((u["load_case"], u["response"]) for u in data.get("unexplained_at") or ()),
        gap={k: float(v) for k, v in (data.get("gap") or {}).items() if v is not None},
        held_out={
            case: (float(h["tuned"]), float(h["with_effect"]))
            for case, h in (data.get("held_out") or {}).items()
            if h.get("tuned") is not None and h.get("with_effect") is not None
        },
        diagnosable={
            name: (float(d["lambda"]), float(d["wrong_name_probability"]))
            for name, d in (data.get("diagnosable") or {}).items()
        },
        excluded=read_excluded(data.get("excluded") or ()),
        not_testable=frozenset(data.get("not_testable") or ()),
        seconds=float(data.get("seconds") or "nan"),
    )


def _named(effect: Mapping[str, Any]) -> Named:
    known = (effect.get("parameters") or {}).items()
    parameters = {
        name: numbers for key, p in known for name, numbers in _numbers(key, p.get("value"), p.get("sd"))
    }
    limits = {
        name: limit for key, p in known for name, (_, limit) in _numbers(key, p.get("value"), p.get("limit"))
    }
    probability = effect.get("probability")
    return Named(
        effect["id"],
        effect.get("location"),
        1.0 if probability is None else float(probability),
        parameters,
        str(effect.get("verdict") or ""),
        limits,
        frozenset(name for key, p in known for name in _unshown(key, p.get("shown", True))),
    )


def _numbers(key: str, value: Any, other: Any) -> Iterator[tuple[str, tuple[float, float]]]:
    """Name with value and sd or limit, where there are both; members of a list by their places, `LLR[1]`."""
    if isinstance(value, list) and isinstance(other, list):
        for i, (one, its) in enumerate(zip(value, other, strict=True)):
            yield from _numbers(f"{key}[{i}]", one, its)
    elif isinstance(value, int | float) and isinstance(other, int | float):
        yield key, (float(value), float(other))


def _unshown(key: str, shown: Any) -> Iterator[str]:
    """The name where it is not shown; the members of a list option by their places."""
    if isinstance(shown, list):
        yield from (f"{key}[{i}]" for i, one in enumerate(shown) if not one)
    elif not shown:
        yield key
