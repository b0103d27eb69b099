"""A discovery as data, for `--json` and for callers; and its summary for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from doe_kc.discovery.result import Discovery, Finding, ParameterEstimate
from doe_kc.discovery.thresholds import CERTAIN
from doe_kc.discovery.verdict.adequacy import Adequacy
from doe_kc.discovery.verdict.exclusion import HypothesisStatus, exclusion_limit
from doe_kc.discovery.verdict.other_sizes import OTHER_SIZE
from doe_kc.discovery.verdict.sentences import OBJECTION, adequacy_words, odds_words, trace_words
from doe_kc.discovery.verdict.size_words import size_words
from doe_kc.effects.hypothesis import Size
from doe_kc.effects.words import effect_label, hypothesis_label
from doe_kc.reports.discovery.words import contrast_words, headline

HIDDEN = ("not testable", "no solution")


def discovery_document(discovery: Discovery, axle_path: Path | None) -> dict[str, Any]:
    """What `discover --json` writes; numbers that are not finite are None.

    effects: those that are named, or the most probable of a class, each with its own verdict: where the
    verdict of the whole is unexplained some may be certain all the same; leads: the others there; traces:
    seen, too small to matter or too weakly to be named. parameters: value, sd, unit of each option, lists
    for a list option; limit: null, or what a number that the records do not tell from none is at most (a
    stiffness: at least), at 95 %; shown: whether the records say more of it than was known before.
    log10_odds: of each effect against the best alternative, its removal or a rival in its place, all others
    in the model; 6 says 6 or more; against: id of that rival, null for the removal.
    adequacy: how often noise alone leaves as large a disagreement as remains (map_chance), and as large an
    RMS of the worst load case held out (held_out_chance, worst_held_out; null where none was); unlisted: the
    largest probability of something outside the library, null where the set does not explain the records.
    excluded: places whose sizes would have been found from `above` on (stiffnesses: below it) if the model is
    right but for that, null for a size that the records do not show; unresolved: ids of effects that would
    be among them, had the records not something else that the model does not explain. beyond_bounds:
    paths of parameters that the records ask to be outside the study's bounds. points_to: interface and law of
    the generic scan, where the verdict is unexplained. not_testable: ids of which no place is testable. gap:
    whitened RMS of all records.
    further_tests: those of next_test that are computed, see `further_tests`.
    """
    leads = [f for f in discovery.findings if f.verdict == "lead"]
    document = {
        "verdict": discovery.verdict,
        "effects": [effect_entry(f) for f in discovery.findings if f not in leads],
        "leads": [effect_entry(f) for f in leads],
        "traces": [effect_entry(f) for f in discovery.traces],
        "classes": [list(c) for c in discovery.classes],
        "adequacy": _adequacy(discovery.adequacy),
        "excluded": [_excluded(s) for s in discovery.statuses if s.status == "excluded"],
        "unresolved": sorted({s.hypothesis.effect for s in discovery.statuses if s.status == "unresolved"}),
        "not_testable": not_testable(discovery.statuses),
        "unexplained_at": [
            {"load_case": c.load_case, "response": c.response, "shape": c.shape, "z": z}
            for c, z in discovery.unexplained
        ],
        "gap": dict(vars(discovery.gap)),
        "held_out": {
            h.load_case: {
                "tuned": h.tuned.rms,
                "with_effect": h.with_effect.rms,
                "law_granted": h.law_granted.rms,
            }
            for h in discovery.held_out
        },
        "points_to": _place(discovery),
        "beyond_bounds": list(discovery.beyond),
        "next_test": list(discovery.next_tests),
        "further_tests": further_tests(discovery),
        "axle": None if axle_path is None else str(axle_path),
    }
    return {key: _finite(value) for key, value in document.items()}


def effect_entry(finding: Finding) -> dict[str, Any]:
    """id, location, others that would do as well, probability, odds and table of an effect."""
    parameters: dict[str, dict[str, Any]] = {}
    length = 1 + max((e.index or 0 for e in finding.estimates), default=0)
    for e in finding.estimates:
        if e.index is None:
            parameters[e.key] = _numbers(e)
            continue
        none = {"value": 0.0, "sd": 0.0, "limit": None, "shown": True}
        empty = {name: [of] * length for name, of in none.items()}
        entry = parameters.setdefault(e.key, empty | {"unit": e.unit})
        for name in none:
            entry[name][e.index] = _numbers(e)[name]
    hypothesis = finding.hypothesis
    if hypothesis.location is None:  # what is fixed then says which of several ways it is, as a technique
        fixed = {"sd": None, "limit": None, "shown": True, "unit": ""}
        parameters |= {k: {"value": v} | fixed for k, v in hypothesis.fixed.items()}
    return {
        "id": hypothesis.effect,
        "location": hypothesis.location,
        "elsewhere": list(finding.elsewhere),
        "verdict": finding.verdict,
        "probability": finding.probability,
        "log10_odds": min(finding.log10_odds, CERTAIN),
        "against": finding.against or None,
        "parameters": parameters,
        "options": dict(hypothesis.fixed) | ({"law": hypothesis.law} if hypothesis.law else {}),
    }


def _numbers(e: ParameterEstimate) -> dict[str, Any]:
    return {"value": e.value, "sd": e.sd, "limit": e.limit, "shown": e.shown, "unit": e.unit}


def _adequacy(holds: Adequacy) -> dict[str, Any]:
    return {
        "map_chance": holds.map_chance,
        "held_out_chance": holds.held_out_chance,
        "worst_held_out": None if holds.worst is None else holds.worst.load_case,
        "unlisted": holds.unlisted,
    }


def _place(discovery: Discovery) -> dict[str, Any] | None:
    """What the generic scan says where no effect of the library is named."""
    if discovery.verdict != "unexplained" or discovery.scan is None or discovery.scan.interface is None:
        return None
    best = discovery.scan.places[0]
    return {
        "interface": best.interface,
        "law": best.law,
        "side": best.side,
        "dofs": list(best.dofs),
        "probability": best.probability,
        "words": best.words,
    }


def further_tests(discovery: Discovery) -> list[dict[str, Any]]:
    """Load cases that would tell two effects apart, and parts to measure that would show a hidden one.

    separation: standard deviations; of a component test those that the effect makes at its typical size.
    """
    runs = [
        {
            "kind": "load_case",
            "effects": list(pair),
            "load_case": test.case.id,
            "amplitude": test.case.amplitude,
            "unit": test.case.unit,
            "offset_mm": getattr(test.case, "offset", None),
            "separation": test.separation,
        }
        for pair, tests in discovery.separating.items()
        for test in tests
    ]
    parts = [
        {
            "kind": "component",
            "effects": [s.hypothesis.effect],
            "location": s.hypothesis.location,
            "parts": list(s.component_test.parts),
            "separation": s.component_test.separation,
        }
        for s in discovery.statuses
        if s.component_test is not None
    ]
    return [*runs, *parts]


def _excluded(standing: HypothesisStatus) -> dict[str, Any]:
    h = standing.hypothesis
    above = {s.key: {"value": _limit(s, standing), "unit": s.unit} for s in h.sizes if not s.shape}
    return {"id": h.effect, "location": h.location, "above": above}


def _limit(size: Size, standing: HypothesisStatus) -> float | list[float | None] | None:
    """The option's number from which it is excluded, None where it is not; of a list all components."""
    sizes = standing.hypothesis.sizes
    limits = {s.name: exclusion_limit(s, a) for s, a in zip(sizes, standing.limits, strict=True)}
    if size.index is None:
        return limits[size.name]
    return [limits[s.name] for s in sizes if s.key == size.key]


def not_testable(statuses: Iterable[HypothesisStatus]) -> list[str]:
    """Ids of effects that cannot be tested in any place."""
    of_effect: dict[str, list[str]] = {}
    for s in statuses:
        of_effect.setdefault(s.hypothesis.effect, []).append(s.status)
    return [ident for ident, places in of_effect.items() if all(status in HIDDEN for status in places)]


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(v) for v in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def discovery_lines(discovery: Discovery) -> list[str]:
    """The outcome for a terminal."""
    lines = [f"{headline(discovery)}. {discovery.sentences[0]}"]
    lines += [
        f"{'lead' if f.verdict == 'lead' else 'effect'}: {_line(discovery, f)}" for f in discovery.findings
    ]
    lines += [f"trace: {_line(discovery, f)}; {trace_words(f)}" for f in discovery.traces]
    others = (s.removeprefix(OTHER_SIZE) for s in discovery.sentences if s.startswith(OTHER_SIZE))
    lines += [f"{OTHER_SIZE.lower()}{clause.rstrip('.')}" for clause in others]
    for group in discovery.classes:
        lines.append(f"cannot be told apart: {' or '.join(effect_label(e) for e in group)}")
    against = (s.removeprefix(OBJECTION) for s in discovery.sentences if s.startswith(OBJECTION))
    lines += [f"{OBJECTION.lower()}{clause.rstrip('.')}" for clause in against]
    lines += [f"unexplained: {contrast_words(c)}, {z:+.1f} sd" for c, z in discovery.unexplained[:3]]
    gap = discovery.gap
    steps = [f"{gap.nominal:.2f} as handed in", f"{gap.tuned:.2f} re-tuned"]
    if discovery.fitted.model.members:
        steps.append(f"{gap.with_effect:.2f} with the effect")
    lines.append(f"gap: {' -> '.join(steps)} (noise floor {gap.noise_floor:.2f})")
    lines.append(adequacy_words(discovery.adequacy))
    if discovery.held_out:
        better = sum(h.gain > 0.0 for h in discovery.held_out)
        lines.append(f"held out: {better} of {len(discovery.held_out)} load cases predicted better")
    if discovery.next_tests:
        lines.append(f"next test: {discovery.next_tests[0]}")
    return lines


def _line(discovery: Discovery, finding: Finding) -> str:
    sizes = f": {size_words(finding)}" if finding.hypothesis.sizes else ""
    return f"{hypothesis_label(finding.hypothesis)}{sizes}, {odds_words(finding)}"
