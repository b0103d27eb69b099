"""The verdict in words, and what to test next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from doe_kc.discovery.result import Finding, Gap
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.screening.scan import Scan
from doe_kc.discovery.thresholds import CERTAIN, NOISE_DRAWS, PARAMETERS_LISTED, TESTS_ADVISED, UNLISTED
from doe_kc.discovery.verdict.adequacy import Adequacy
from doe_kc.discovery.verdict.exclusion import HypothesisStatus
from doe_kc.discovery.verdict.extra_test import ExtraTest
from doe_kc.discovery.verdict.size_words import size_words
from doe_kc.discovery.verdict.verdict import Verdict
from doe_kc.effects import EFFECTS
from doe_kc.effects.words import place_of, place_words
from doe_kc.ground.numbers import number

OBJECTION = "Against a name: "
"""Begins a sentence with what keeps the whole set from a name."""


def sentences(
    verdict: Verdict,
    findings: Sequence[Finding],
    adequacy: Adequacy,
    gap: Gap,
    remaining: Map,
    scan: Scan | None,
    beyond: Sequence[str],
    widened: float,
    others: Sequence[str],
) -> tuple[str, ...]:
    """Verdict first, then each effect, whether the set holds, and how far the gap shrank.

    beyond: paths of parameters outside their bounds. widened: by how much wider ranges were allowed. others:
    sentences on what sizes would be in other sets.
    """
    out = [_opening(verdict, findings, beyond)]
    out += [*map(_one, findings), *others]
    if verdict.kind == "unexplained":
        out += [f"{OBJECTION}{o}." for o in verdict.objections]
        out += [
            f"Unexplained: {c.load_case}, {c.response}, {c.shape} ({c.wheels}), {z:+.1f} standard deviations."
            for c, z in remaining.worst(3)
        ]
        if scan is not None and scan.interface is not None:
            out.append(f"The data point to {scan.places[0].words}.")
    out.append(adequacy_words(adequacy))
    if beyond:
        out.append(_outside(beyond, widened))
    out.append(
        f"Whitened RMS of all deviations: {gap.nominal:.2f} as handed in, {gap.tuned:.2f} re-tuned without "
        f"an effect, {gap.with_effect:.2f} with what was found; {gap.noise_floor:.2f} is noise."
    )
    return tuple(out)


def _outside(beyond: Sequence[str], widened: float) -> str:
    listed = ", ".join(beyond[:PARAMETERS_LISTED]) + (", …" if len(beyond) > PARAMETERS_LISTED else "")
    count = f"{len(beyond)} parameter{'s' if len(beyond) > 1 else ''}"
    return (
        f"The records ask for {count} outside the bounds ({listed}), so ranges {widened:g} times as wide "
        "were taken: the series is off nominal or scatters more than thought; check the nominal axle."
    )


def _opening(verdict: Verdict, findings: Sequence[Finding], beyond: Sequence[str]) -> str:
    sure = [f for f in findings if f.verdict == "named"]
    unsure = [f for f in findings if f not in sure]
    names, named, others = (_listed([_label(f) for f in some]) for some in (findings, sure, unsure))
    if verdict.kind == "named":
        return f"The model lacks {names}."
    if verdict.kind == "class":
        one = len(unsure) == 1
        lack = f"{named}, and " if sure else ""
        lack += f"{'an effect that is' if one else 'effects that are'} most likely {others}"
        return f"The model lacks {lack}, but others cannot be told from {'it' if one else 'them'}."
    if verdict.kind == "none" and beyond:
        return "No effect is missing: re-tuning explains all records, though only beyond the bounds."
    if verdict.kind == "none":
        return "No effect is missing: re-tuning within production scatter explains all records."
    if sure:
        lead = f"; the best lead is {others}" if others else ""
        return (
            f"The model lacks {named}, and something besides that the library does not name for sure{lead}."
        )
    if findings:
        return f"Something is missing that the library does not name for sure; the best lead is {names}."
    return "Something is missing that no effect of the library explains."


def _listed(names: Sequence[str]) -> str:
    """`a, b and c`."""
    return " and ".join(n for n in (", ".join(names[:-1]), *names[-1:]) if n)


def _label(finding: Finding) -> str:
    label, place = _known(finding.hypothesis.effect), place_of(finding.hypothesis)
    return f"{label} ({place})" if place else label


def _one(finding: Finding) -> str:
    sizes = size_words(finding)
    rivals = ", ".join(f"{_known(r.effect)} {r.probability:.0%}" for r in finding.rivals)
    label = _label(finding)
    text = f"{label[0].upper()}{label[1:]}: {odds_words(finding)}"
    text += f"; {sizes}" if sizes else ""
    places = " or ".join(map(place_words, finding.elsewhere))
    text += f"; at {places} it would do as well" if places else ""
    return text + (f"; else {rivals}." if rivals else ".")


def trace_words(finding: Finding) -> str:
    """Why an effect that the records show is not named."""
    return "too small to matter" if finding.small else "too weakly to be named"


def odds_words(finding: Finding) -> str:
    """How sure an effect is, and against what: `log10 odds > 6 against its removal`."""
    return f"log10 odds {odds_number(finding.log10_odds)} against {against_words(finding)}"


def against_words(finding: Finding) -> str:
    """The best alternative to an effect."""
    return f"{_known(finding.against)} in its place" if finding.against else "its removal"


def odds_number(log10_odds: float) -> str:
    """`4.2`; beyond CERTAIN no more is said than that."""
    return f"> {CERTAIN:g}" if log10_odds > CERTAIN else f"{log10_odds:.1f}"


def adequacy_words(adequacy: Adequacy) -> str:
    """One line on whether the set explains the records, and on something that the library does not list."""
    text = f"Adequacy: noise alone leaves as large a disagreement in {_share(adequacy.map_chance)} of cars"
    if adequacy.worst is not None and adequacy.held_out_chance is not None:
        worst = adequacy.worst
        text += (
            f", and deviations of a load case held out as large as those of {worst.load_case} "
            f"(RMS {worst.law_granted.rms:.2f}) in {_share(adequacy.held_out_chance)}"
        )
    if adequacy.unlisted is None:
        return f"{text}; something that the library does not list, or a law of another shape, is at work."
    most = 100.0 * adequacy.unlisted
    return (
        f"{text}; something that the library does not list is at most {most:.0f} % probable, "
        f"with {100.0 * UNLISTED:.0f} % assumed before the records."
    )


def _share(chance: float) -> str:
    return "less than 0.1 %" if chance <= 1.0 / NOISE_DRAWS else f"{number(100.0 * chance, 2)} %"


def next_tests(
    verdict: Verdict,
    findings: Sequence[Finding],
    ambiguous: Sequence[Sequence[str]],
    statuses: Sequence[HypothesisStatus],
    extra: Mapping[tuple[str, str], Sequence[ExtraTest]],
) -> tuple[str, ...]:
    """What would separate a class, confirm a name, or show what is not testable here.

    extra: of an effect and its rival, the load cases that separate them.
    """
    out = {f"{one} {other}": _separated(one, other, tests) for (one, other), tests in extra.items()}
    for members in ambiguous:
        for m in members:
            out.setdefault(m, f"To tell {_known(m)} from its rivals: {EFFECTS[m].shown_by}.")
    if verdict.kind in ("named", "unexplained"):
        for f in findings:
            ident = f.hypothesis.effect
            out.setdefault(ident, f"To confirm {_known(ident)}: {EFFECTS[ident].shown_by}.")
    for effect, best in _untestable(statuses):
        how = f"{EFFECTS[effect].shown_by}{_component_words(best)}"
        seen = "Seen only as a trace" if best.status == "trace" else "Not testable here"
        out.setdefault(effect, f"{seen}, {_known(effect)}: {how}.")
    return tuple(list(out.values())[:TESTS_ADVISED])


def _untestable(statuses: Sequence[HypothesisStatus]) -> list[tuple[str, HypothesisStatus]]:
    """Effects that hardly show in any place, each with the place that measured parts show best; those that
    they show come first, by how many parts that takes."""
    places: dict[str, list[HypothesisStatus]] = {}
    for s in statuses:
        places.setdefault(s.hypothesis.effect, []).append(s)
    best = [
        (effect, min(statuses_of, key=_effort))
        for effect, statuses_of in places.items()
        if all(s.status == "not testable" or s.component_test is not None for s in statuses_of)
    ]
    return sorted(best, key=lambda item: _effort(item[1]))


def _effort(status: HypothesisStatus) -> tuple[float, float]:
    test = status.component_test
    return (float("inf"), 0.0) if test is None else (len(test.parts), -test.separation)


def _component_words(status: HypothesisStatus) -> str:
    test = status.component_test
    if test is None:
        return ""
    return (
        f"; or measure {', '.join(test.parts)} on a bench, after which its typical size is "
        f"{test.separation:.0f} times its uncertainty"
    )


def _separated(one: str, other: str, tests: Sequence[ExtraTest]) -> str:
    pair = f"{_known(one)} from {_known(other)}"
    if not tests:
        return f"No further load case of this rig tells {pair}."
    listed = " or ".join(f"{t.words} (apart by {t.separation:.0f} times the uncertainty)" for t in tests)
    return f"To tell {pair}, run {listed}."


def _known(effect: str) -> str:
    return EFFECTS[effect].label.lower()
