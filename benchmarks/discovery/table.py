"""The suites' results as lines of a report."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from benchmarks.discovery.scoring import Estimate, Score
from benchmarks.discovery.statistics import Share, brier, calibration_error, reliability, share
from benchmarks.discovery.suites import ALL_SUITES
from benchmarks.discovery.truth import DELETED
from doe_kc.ground.typing import FloatArray

Measure = Callable[[Score], bool]
MEASURES: dict[str, Measure] = {
    "exact set": lambda s: s.exact,
    "all found": lambda s: s.found,
    "first right": lambda s: s.top,
    "named or in a class": lambda s: s.in_class,
    "or said not testable": lambda s: s.open,
    "wrong name": lambda s: s.wrong,
    "trace named": lambda s: s.trace,
    "missed": lambda s: s.missed,
    "unexplained": lambda s: s.unexplained,
    "right place": lambda s: s.placed,
    "failed": lambda s: s.verdict == "failed",
}
HAVING = ("all found", "first right", "named or in a class", "or said not testable")
LEFT_OUT = {
    "null": (*HAVING, "missed", "right place"),
    "outside": (*HAVING, "exact set"),
    DELETED: (*HAVING, "exact set"),
}
"""Measures that say nothing about a suite."""
ELSEWHERE = ("right place",)
TARGETS = {
    ("null", "wrong name"): "<= 5 %",
    ("single, diagnosable", "first right"): ">= 95 %",
    ("confounded", "named or in a class"): ">= 95 %",
    ("two, diagnosable", "exact set"): ">= 75 %",
    ("two, diagnosable", "all found"): ">= 85 %",
    ("outside", "unexplained"): ">= 90 %",
    (f"{DELETED}, diagnosable", "unexplained"): ">= 80 %",
    (DELETED, "wrong name"): "<= 10 %",
    (f"{DELETED}, diagnosable", "wrong name"): "<= 10 %",
    ("wrong_priors, diagnosable", "first right"): ">= 85 %",
}
WRONG_NAMES = "<= 5 %"
"""Everywhere else."""


def groups(found: Sequence[Score]) -> dict[str, list[Score]]:
    """Suite -> its cases, and the diagnosable ones of suites that have both kinds."""
    out: dict[str, list[Score]] = {}
    for suite in sorted({s.suite for s in found}, key=list(ALL_SUITES).index):
        own = [s for s in found if s.suite == suite]
        out[suite] = own
        clear = [s for s in own if s.diagnosable]
        if any(s.diagnosable is not None for s in own):
            out[f"{suite}, diagnosable"] = clear
            out[f"{suite}, not diagnosable"] = [s for s in own if s.diagnosable is False]
    return out


def suite_table(found: Sequence[Score]) -> list[str]:
    """A line for every group: shares in percent with their Wilson intervals, and targets where there are."""
    lines = ["| cars | n | " + " | ".join(MEASURES) + " |", "|---" * (len(MEASURES) + 2) + "|"]
    for name, members in groups(found).items():
        cells = [_cell(name, label, [of(s) for s in members]) for label, of in MEASURES.items()]
        lines.append(f"| {name} | {len(members)} | " + " | ".join(cells) + " |")
    return lines


def _cell(group: str, label: str, flags: Sequence[bool]) -> str:
    if label in LEFT_OUT.get(group.split(",")[0], ELSEWHERE) or not flags:
        return ""
    target = TARGETS.get((group, label), WRONG_NAMES if label == "wrong name" else "")
    found = share(flags)
    low, high = found.interval
    text = f"{100 * found.value:.0f} ({100 * low:.0f}-{100 * high:.0f})"
    return f"{text}, target {target}" if target else text


def located(found: Iterable[Score]) -> Share:
    """Right places of rightly named effects that have one, also beside something unexplained."""
    pairs = [s.located for s in found]
    return Share(sum(p[0] for p in pairs), sum(p[1] for p in pairs))


def false_names(found: Iterable[Score]) -> Share:
    """Names that are not what is there, of all names."""
    pairs = [s.false_names for s in found]
    return Share(sum(p[0] for p in pairs), sum(p[1] for p in pairs))


def members_named(found: Iterable[Score]) -> Share:
    """Hidden effects that are named, of those diagnosable by themselves beside the others."""
    pairs = [s.members for s in found]
    return Share(sum(p[0] for p in pairs), sum(p[1] for p in pairs))


def excluded_wrongly(found: Iterable[Score]) -> Share:
    """Hidden effects that are not named, and are said to be smaller than they are."""
    pairs = [s.excluded for s in found]
    return Share(sum(p[0] for p in pairs), sum(p[1] for p in pairs))


def small_effect_lines(found: Sequence[Score]) -> list[str]:
    """How far traces and limits of exclusion can be trusted, by the small shares of all other effects that
    every car has."""
    traced = Share(sum(s.traced[0] for s in found), sum(s.traced[1] for s in found))
    limits = Share(sum(s.limits[0] for s in found), sum(s.limits[1] for s in found))
    lines = [f"- Effects told as traces that the car has: {traced}"]
    for label, approximate in (("same law", False), ("law of another shape", True)):
        z = np.abs([e.z for s in found for e in s.traces if e.approximate == approximate])
        if z.size:
            lines.append(f"- Numbers of those traces, {label}: {z.size}, {_within(z)}")
    return [*lines, f"- Small effects of the car above their limit of exclusion: {limits} (target <= 5 %)"]


def followup_lines(found: Sequence[Score], followed: Sequence[Score]) -> list[str]:
    """What the tests advised bring to confounded cars. followed: those not named at once, after the tests."""
    again = {s.name: s for s in followed}
    last = [again.get(s.name, s) for s in found if s.suite == "confounded"]
    at_last = f"{share([s.exact for s in last])} (target >= 90 %)"
    if not last:
        return []
    if not followed:
        return [f"- Tests advised: none was carried out on a confounded car; exact set at once: {at_last}"]
    return [
        "- Tests advised (load cases driven, parts measured to 2 % or 0.1 mm), carried out on confounded "
        f"cars that are not named at once: exact set {share([s.exact for s in followed])}, wrong name "
        f"{share([s.wrong for s in followed])}; exact set at once or then: {at_last}"
    ]


def _within(z: FloatArray) -> str:
    """Shares of errors, in standard deviations without a sign, within one and two."""
    return ", ".join(f"within {n} sd: {share(list(z < n))}" for n in (1, 2))


def parameter_lines(found: Sequence[Score]) -> list[str]:
    """How good the numbers of rightly named effects are: those told as a value, those told as a limit since
    the records do not tell them from none, and all by their standard deviations, also those not shown."""
    lines = []
    every = [e for s in found for e in s.estimates]
    for label, approximate in (("same law", False), ("law of another shape", True)):
        chosen = [e for e in every if e.approximate == approximate]
        told = [e for e in chosen if e.limit is None and e.shown]
        limits = [e for e in chosen if e.limit is not None]
        if told:
            relative = np.abs([e.relative for e in told])
            middle, most = 100 * np.nanmedian(relative), 100 * np.nanquantile(relative, 0.9)
            lines.append(
                f"- Parameters, {label}, told as a value: {_z_words(told)} (68 % and 95 % where honest); "
                f"error, median {middle:.1f} %, 90 in 100 below {most:.0f} %"
            )
        if limits:
            right = share([e.within_limit for e in limits])
            lines.append(f"- Parameters, {label}, told as a limit: {right} are within it (95 % where honest)")
        if len(chosen) > len(told):
            unshown = sum(not e.shown for e in chosen)
            lines.append(
                f"- Parameters, {label}, all by value and sd, {unshown} not shown by the records among them: "
                f"{_z_words(chosen)}"
            )
    return lines


def _z_words(chosen: Sequence[Estimate]) -> str:
    return f"{len(chosen)}, {_within(np.abs([e.z for e in chosen]))}"


def calibration_lines(found: Sequence[Score]) -> list[str]:
    """Brier score, expected calibration error and reliability of the stated probabilities."""
    believed = [b for s in found for b in s.believed]
    if not believed:
        return ["- No probabilities were stated."]
    lines = [
        f"- Probabilities: {len(believed)}, Brier {brier(believed):.3f}, "
        f"expected calibration error {calibration_error(believed):.3f} (target <= 0.1)",
        "",
        "| stated | mean | right |",
        "|---|---|---|",
    ]
    bins = reliability(believed)
    return lines + [f"| {b.low:g} to {b.high:g} | {b.stated:.3f} | {b.right} |" for b in bins]


def closed_lines(found: Sequence[Score]) -> list[str]:
    """How much of the gap on held-out load cases the named effects close, beside the best other effect."""
    pairs = [(s.closed, s.decoy) for s in found if s.exact and math.isfinite(s.closed)]
    if not pairs:
        return ["- No held-out load cases were reported."]
    closed = np.array([p[0] for p in pairs])
    decoy = np.array([p[1] for p in pairs])
    return [
        f"- Gap closed on held-out load cases, rightly named: median {np.median(closed):.2f}, "
        f"at least 0.90 in {share(list(closed >= 0.9))} (target: 0.90); best other effect on the data that "
        f"it was fitted to: median {np.nanmedian(decoy) if np.isfinite(decoy).any() else math.nan:.2f}"
    ]
