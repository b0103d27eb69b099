"""The whole discovery on one car: from an axle and its records to a verdict."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood, Rewhitening
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result import CurveGap, Discovery, Finding, FindingVerdict, Gap
from doe_kc.discovery.screening.disagreement import raw_map
from doe_kc.discovery.screening.scan import Scan
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.bound_check import beyond, search_within_bounds
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.search.decision import threshold
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.law_variants import frictions
from doe_kc.discovery.search.refits import HypothesisFit, temper
from doe_kc.discovery.thresholds import DISAGREEMENTS_LISTED
from doe_kc.discovery.verdict.adequacy import Adequacy, adequacy
from doe_kc.discovery.verdict.alternatives import Alternatives
from doe_kc.discovery.verdict.certainty import certain, name_doubt
from doe_kc.discovery.verdict.exchange import exchanged
from doe_kc.discovery.verdict.exclusion import HypothesisStatus, Status, hypothesis_statuses
from doe_kc.discovery.verdict.extra_test import ExtraTest, extra_tests
from doe_kc.discovery.verdict.findings import findings
from doe_kc.discovery.verdict.other_sizes import other_sizes
from doe_kc.discovery.verdict.sentences import next_tests, sentences
from doe_kc.discovery.verdict.verdict import Verdict, ambiguous, class_of, classes, verdict
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.memory import return_large_arrays
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray


@one_thread()
def discover(
    model: EffectModel, library: Sequence[Hypothesis], workers: DiscoveryWorkers | None = None
) -> Discovery:
    """model: the axle without any effect, its tunable parameters and its records."""
    started = time.perf_counter()
    return_large_arrays()
    workers = workers or DiscoveryWorkers()
    search, compared = exchanged(search_within_bounds(model, library, workers), library, workers)
    nominal = model.residual(model.centre)
    tuned, with_effects = search.tuned, search.with_effects
    tuned_map, residual_map = tuned.residual_map, search.with_law_discrepancy.residual_map
    pending_scan = None if tuned_map.agrees else workers.scan(tuned)
    pending = workers.held_out(tuned, with_effects, search.with_law_discrepancy) if compared else None
    members = findings(search, compared, workers)
    relevant = tuple(sorted((f for f in members if f.relevant), key=lambda f: -f.detectability))
    predictions = pending() if pending is not None and relevant else ()
    outcome = verdict(relevant, residual_map, predictions, tuned, with_effects)
    set_adequacy = adequacy(residual_map, predictions)
    relevant = with_verdicts(relevant, compared, outcome, search.with_law_discrepancy, set_adequacy)
    scanned = None if pending_scan is None else pending_scan()
    interface_scan = None if scanned is None else Scan.of(scanned, temper(search.with_law_discrepancy))
    decoy = best_decoy(compared, relevant)
    gap, curve_gaps = gaps(model.likelihood, nominal, tuned, with_effects, decoy.fit if decoy else None)
    traces = shown_traces(members, set_adequacy)
    limits_hold = resolved(search, set_adequacy)
    statuses = library_statuses(search, (*relevant, *traces), len(library), resolved=limits_hold)
    outside, others = beyond(model.space, with_effects), other_sizes(search, compared, relevant)
    groups = classes(relevant) if outcome.kind == "class" else ()
    separating = _separating(compared, relevant) if groups else {}
    return Discovery(
        verdict=outcome.kind,
        sentences=sentences(
            outcome,
            relevant,
            set_adequacy,
            gap,
            residual_map,
            interface_scan,
            outside,
            tuned.model.widened,
            others,
        ),
        findings=relevant,
        traces=traces,
        classes=groups,
        statuses=statuses,
        unexplained=tuple(residual_map.worst(DISAGREEMENTS_LISTED)) if outcome.kind == "unexplained" else (),
        adequacy=set_adequacy,
        search=search,
        decoy=decoy,
        nominal=nominal,
        nominal_map=raw_map(tuned.model.contrasts, nominal),
        tuned_map=tuned_map,
        residual_map=residual_map,
        gap=gap,
        gaps=curve_gaps,
        held_out=predictions,
        next_tests=next_tests(outcome, relevant, groups, statuses, separating),
        seconds=time.perf_counter() - started,
        scan=interface_scan,
        widened=tuned.model.widened,
        beyond=outside,
        separating=separating,
    )


def with_verdicts(
    relevant: Sequence[Finding],
    compared: Sequence[Alternatives],
    outcome: Verdict,
    final: Fit,
    set_adequacy: Adequacy,
) -> tuple[Finding, ...]:
    """The findings, each with its own verdict: some are certain although the rest is not explained.

    Their probabilities are those among the sets, times that of nothing outside the library in their place.
    """
    own = {c.hypothesis.name: c for c in compared}

    def judged(finding: Finding) -> Finding:
        place = own[finding.hypothesis.name]
        kind: FindingVerdict = "class" if ambiguous(finding) else "named"
        doubt = name_doubt(place, final, set_adequacy)
        if outcome.kind == "unexplained":
            sure = certain(finding, place, final)
            kind, doubt = ("named", name_doubt(place, final, None)) if sure else ("lead", doubt)
        return replace(finding, verdict=kind, probability=finding.probability / (1.0 + doubt))

    return tuple(map(judged, relevant))


def best_decoy(compared: Sequence[Alternatives], relevant: Sequence[Finding]) -> HypothesisFit | None:
    """The best refit of another effect in place of the largest finding, None where none is plausible."""
    for own in compared:
        if relevant and own.hypothesis == relevant[0].hypothesis:
            others = [t for t in own.trials if t.hypothesis.effect != own.hypothesis.effect]
            return others[0] if others else None
    return None


def _separating(
    compared: Sequence[Alternatives], relevant: Sequence[Finding]
) -> dict[tuple[str, str], tuple[ExtraTest, ...]]:
    """The load cases that tell an effect which others could be from each of those."""
    out: dict[tuple[str, str], tuple[ExtraTest, ...]] = {}
    trials = {c.hypothesis.name: c.trials for c in compared}
    for finding in filter(ambiguous, relevant):
        own, *rest = trials[finding.hypothesis.name]
        first, *others = class_of(finding)
        for other in others:
            rival = next((t for t in rest if t.hypothesis.effect == other), None)
            if rival is not None and (first, other) not in out:
                out[first, other] = extra_tests(own.fit, rival.fit)
    return out


def resolved(search: EffectSearch, adequacy: Adequacy) -> bool:
    """Whether limits of effects that are not in the model mean anything.

    They take the model for right. Where what remains is not noise it is not; where the law of a friction is
    not the model's, what is missing of that hides effects larger than any such limit.
    """
    shares = search.discrepancy_shares
    other_law = (shares.get(h.name, 0.0) > 0.0 for h in frictions(search.with_law_discrepancy))
    return adequacy.holds and not any(other_law)


def shown_traces(members: Sequence[Finding], adequacy: Adequacy) -> tuple[Finding, ...]:
    """Effects that are there and too small to matter, or too weak to be named; of the rig only where the set
    holds: else they stand for anything.

    What came in beside other laws of the set can be none beside the last ones: a gain of the tyre load was
    told as 1.0004 +- 0.0004.
    """
    small = (f for f in members if f.seen and not f.relevant)
    return tuple(f for f in small if adequacy.holds or not EFFECTS[f.hypothesis.effect].on_rig)


def library_statuses(
    search: EffectSearch, named: Sequence[Finding], count: int, *, resolved: bool
) -> tuple[HypothesisStatus, ...]:
    """Of the members of the last set and of all that can come in beside it.

    named: the findings and traces that are reported. count: hypotheses of the library. resolved: see
    `resolved`.
    """
    last, critical = search.with_law_discrepancy, float(np.sqrt(2.0 * threshold(count)))
    statuses: dict[str, Status] = {f.hypothesis.name: "found" if f.relevant else "trace" for f in named}
    own = {h.name for h in last.model.members}
    members: list[tuple[Screened, Status]] = [
        (s, statuses.get(s.hypothesis.name, "unresolved"))
        for s in search.screened
        if s.hypothesis.name in own
    ]
    others = [
        s for s in search.screened if s.hypothesis.name not in own and compatible(last.model, s.hypothesis)
    ]
    others.sort(key=lambda s: -s.gain)
    masked = {one.hypothesis.name for one in search.larger}
    return hypothesis_statuses(last, others, members, critical, resolved=resolved, masked=masked)


def gaps(
    likelihood: Likelihood, nominal: FloatArray, tuned: Fit, with_effects: Fit, decoy: Fit | None
) -> tuple[Gap, tuple[CurveGap, ...]]:
    """The gap of all records together, and of each load case and response.

    likelihood: with the errors that it is in, those of all fits but the decoy's.
    """
    rows: dict[tuple[str, str], list[int]] = {}
    for curve, place in likelihood.slices():
        at = rows.setdefault((curve.load_case, curve.response), [])
        at.extend(range(place.start, place.stop))
    residuals: Mapping[str, FloatArray | None] = {
        "nominal": nominal,
        "tuned": tuned.residual,
        "with_effect": with_effects.residual,
        "best_decoy": None if decoy is None else _in_errors(decoy, likelihood),
    }

    def gap(places: slice | list[int], floor: float) -> Gap:
        rms = {k: float("nan") if r is None else _rms(r[places]) for k, r in residuals.items()}
        return Gap(noise_floor=floor, **rms)

    total = gap(slice(None), noise_floor(with_effects))
    return total, tuple(CurveGap(c, r, gap(at, 1.0)) for (c, r), at in rows.items())


def noise_floor(fit: Fit) -> float:
    """Whitened RMS expected of the right model: sqrt(1 - parameters used / data)."""
    used = float(np.sum(1.0 - np.diag(fit.covariance) / fit.model.prior_sd**2))
    return float(np.sqrt(max(0.0, 1.0 - used / fit.residual.size)))


def _in_errors(fit: Fit, likelihood: Likelihood) -> FloatArray:
    return Rewhitening(fit.model.likelihood, likelihood)(fit.residual)


def _rms(residual: FloatArray) -> float:
    return float(np.sqrt(np.mean(residual**2)))
