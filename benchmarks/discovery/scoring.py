"""One answer against its key."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from benchmarks.discovery.answer import Answer, Named
from benchmarks.discovery.exclusions import contradicted, said_of, unshown
from benchmarks.discovery.sides import numbers, place
from benchmarks.discovery.truth import DELETED, TrueEffect, Truth


@dataclass(frozen=True)
class Estimate:
    """A parameter of a rightly named effect, also beside something unexplained. approximate: of a law of
    another shape. limit: None where the answer tells it from none. shown: whether it says that the records
    show it."""

    effect: str
    parameter: str
    true: float
    value: float
    sd: float
    approximate: bool
    limit: float | None = None
    shown: bool = True

    @property
    def within_limit(self) -> bool:
        """Whether the true value is on the limit's side of the one told; a stiffness is at least as large."""
        return self.limit is not None and (self.true - self.limit) * (self.value - self.limit) >= 0.0

    @property
    def z(self) -> float:
        """Error in standard deviations."""
        return (self.value - self.true) / self.sd if self.sd > 0 else math.inf

    @property
    def relative(self) -> float:
        """Error over the true value."""
        return (self.value - self.true) / abs(self.true) if self.true else math.nan


@dataclass(frozen=True)
class Score:
    """exact: the names are the hidden effects, no more and no less. found: all of these are named. top: the
    first name is one of them. in_class: each is named or in a class. open: each is that, or said not to be
    testable with these records. wrong: some name is not what is there; trace: some name is clutter, rightly
    sized but too small to matter. missed: answered that nothing is missing. placed: an unexplained deviation
    is reported where it is. located: right places of rightly named effects, also beside something
    unexplained, over those that have one. closed, decoy: share of the gap that the named effects, and the
    best other one, close; nan where the answer gives none. members: hidden effects that are named, also
    beside something unexplained, over those diagnosable by themselves beside the others. false_names: names,
    those among them, that are not what is there, over all. excluded: hidden effects that are excluded below
    their size, over those not named. traces: parameters of effects told as traces that the car has; traced:
    such effects, over all told. limits: small effects of the car whose limit of exclusion is below their
    size, over those with one.
    """

    name: str
    suite: str
    truth: str
    first: str
    verdict: str
    names: tuple[str, ...]
    exact: bool
    found: bool
    top: bool
    in_class: bool
    open: bool
    wrong: bool
    trace: bool
    missed: bool
    unexplained: bool
    placed: bool
    located: tuple[int, int]
    estimates: tuple[Estimate, ...]
    believed: tuple[tuple[float, bool], ...]
    closed: float
    decoy: float
    diagnosable: bool | None
    members: tuple[int, int]
    false_names: tuple[int, int]
    excluded: tuple[int, int]
    traces: tuple[Estimate, ...]
    traced: tuple[int, int]
    limits: tuple[int, int]
    seconds: float


@dataclass(frozen=True)
class Predicted:
    """From the opened key: detectability of each hidden effect and the chance that noise names a rival, by
    its id; and where their changes show."""

    members: Mapping[str, tuple[float, float]]
    shows: frozenset[tuple[str, str]] = frozenset()


DETECTABLE = 10.0
WRONG_NAME = 0.05
FACTOR = 2.0
"""Within which a trace is taken for rightly sized."""


def score(truth: Truth, answer: Answer, predicted: Predicted | None = None) -> Score:
    """predicted: None for a car without hidden effects, or where the analyser's own word counts."""
    shows = truth.shows | (predicted.shows if predicted is not None else frozenset())
    names, committed = frozenset(answer.names), frozenset(answer.committed)
    small = frozenset(e.id for e in answer.effects if e.id in committed - truth.ids and _traced(truth, e))
    pairs = [(t, n) for t in truth.effects for n in answer.told if n.id == t.id and t.id in committed]
    traces = [(t, n) for t in (*truth.effects, *truth.small) for n in answer.traces if _same(t, n)]
    return Score(
        name=truth.name,
        suite=truth.suite,
        truth=truth.label,
        first=answer.first,
        verdict=answer.verdict,
        names=answer.names,
        exact=names == truth.ids and not truth.outside and answer.verdict not in ("unexplained", "failed"),
        found=bool(truth.ids) and truth.ids <= names,
        top=answer.first in truth.ids,
        in_class=bool(truth.ids) and truth.ids <= answer.offered,
        open=bool(truth.ids)
        and answer.verdict in ("named", "class", "none")
        and all(
            e.id in answer.offered | answer.not_testable or unshown(e, answer.excluded) for e in truth.effects
        ),
        wrong=bool(committed - truth.ids - small),
        trace=bool(small),
        missed=bool(truth.ids or truth.outside) and answer.verdict == "none",
        unexplained=answer.verdict == "unexplained",
        placed=bool(shows & set(answer.unexplained_at)),
        located=_located(pairs),
        estimates=tuple(_estimates(pairs)),
        believed=_believed(truth, answer),
        closed=held_out_closed(answer),
        decoy=decoy_closed(answer),
        diagnosable=_diagnosable(truth, answer, predicted),
        members=_members(truth, committed, predicted),
        false_names=(len(committed - truth.ids - small), len(committed)),
        excluded=_excluded(truth, answer, names),
        traces=tuple(_estimates(traces)),
        traced=(len(traces), len(answer.traces)),
        limits=_limits(truth, answer),
        seconds=answer.seconds,
    )


def _excluded(truth: Truth, answer: Answer, names: frozenset[str]) -> tuple[int, int]:
    unnamed = [e for e in truth.effects if e.id not in names and truth.suite != DELETED]
    wrong = [e for e in unnamed if any(contradicted(e, s) for s in said_of(e, answer.excluded))]
    return len(wrong), len(unnamed)


def _same(true: TrueEffect, told: Named) -> bool:
    """Whether a trace that is told is that effect, where it has a place of its own there."""
    return told.id == true.id and place(true.id, true.location) in ("", place(told.id, told.location or ""))


def _limits(truth: Truth, answer: Answer) -> tuple[int, int]:
    """Small effects that are larger than their limit, over those of whose numbers one has a limit."""
    said = [(t, s) for t in truth.small for s in answer.excluded if s.id == t.id]
    known = [(t, s) for t, s in said if any(s.above.get(n) is not None for n in t.parameters)]
    return sum(contradicted(t, s) for t, s in known), len(known)


def _members(truth: Truth, names: frozenset[str], predicted: Predicted | None) -> tuple[int, int]:
    if predicted is None or truth.suite == DELETED:
        return 0, 0
    clear = [i for i in truth.ids if _clear(*predicted.members[i])]
    return sum(i in names for i in clear), len(clear)


def _traced(truth: Truth, named: Named) -> bool:
    """Whether a name is clutter found: its numbers are those of the trace that is there, within a factor."""
    true = truth.clutter.get(named.id, {}) if named.id not in truth.ids else {}
    ratios = [value / true[name] for name, (value, _) in named.parameters.items() if true.get(name)]
    return bool(ratios) and max(ratios) > 0 and 1 / FACTOR < max(ratios, key=abs) < FACTOR


def _located(pairs: list[tuple[TrueEffect, Named]]) -> tuple[int, int]:
    asked = [(place(t.id, t.location), place(t.id, n.location or "")) for t, n in pairs if t.location]
    return sum(t == n for t, n in asked), len(asked)


def _estimates(pairs: list[tuple[TrueEffect, Named]]) -> Iterator[Estimate]:
    for t, n in pairs:
        there = t.parameters_at(n.location or "")
        true = numbers(t.id, {name: (value, 0.0) for name, value in there.items()})
        for name, (value, sd) in numbers(t.id, n.parameters).items():
            if name in true:
                limit, shown = n.limits.get(name), name not in n.unshown
                yield Estimate(t.id, name, true[name][0], value, sd, t.approximate, limit, shown)


def _believed(truth: Truth, answer: Answer) -> tuple[tuple[float, bool], ...]:
    """(probability, whether it is right) of every effect told as found, also beside something unexplained."""
    return tuple((e.probability, e.id in truth.ids) for e in answer.told if not _traced(truth, e))


def held_out_closed(answer: Answer) -> float:
    """G = 1 - (R_after - 1) / (R_tuned - 1) of the load cases held out; R: whitened RMS, noise is 1."""
    if not answer.held_out:
        return math.nan
    tuned, after = (
        math.sqrt(sum(pair[i] ** 2 for pair in answer.held_out.values()) / len(answer.held_out))
        for i in (0, 1)
    )
    return _closed(tuned, after)


def decoy_closed(answer: Answer) -> float:
    """The same of the best other effect, on the data that it was fitted to: an upper bound."""
    gap = answer.gap
    if "tuned" not in gap or "best_decoy" not in gap:
        return math.nan
    return _closed(gap["tuned"], gap["best_decoy"])


def _closed(tuned: float, after: float) -> float:
    return 1.0 - (after - 1.0) / (tuned - 1.0) if tuned > 1.0 else math.nan


def _diagnosable(truth: Truth, answer: Answer, predicted: Predicted | None) -> bool | None:
    """Whether the weakest hidden effect is strong enough and unlike all others; None where nobody says."""
    said = [answer.diagnosable[i] for i in truth.ids if i in answer.diagnosable]
    if predicted is not None:
        said = list(predicted.members.values())
    elif not truth.ids or len(said) < len(truth.ids):
        return None
    return all(_clear(strength, wrong) for strength, wrong in said)


def _clear(strength: float, wrong: float) -> bool:
    """Whether an effect is strong enough and unlike all others."""
    return strength >= DETECTABLE and wrong <= WRONG_NAME
