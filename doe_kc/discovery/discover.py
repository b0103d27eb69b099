"""The whole discovery on one car: from an axle and its records to a verdict."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result import CurveGap, Discovery, Finding, Gap, Returned
from doe_kc.discovery.screening.disagreement import raw_map, remaining_map
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.bound_check import beyond, search_within_bounds
from doe_kc.discovery.search.law_discrepancy import sticks
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.search.search import EffectSearch, accepted_at, threshold
from doe_kc.discovery.thresholds import RETURNS_FROM, WORST
from doe_kc.discovery.verdict.adequacy import Adequacy, adequacy
from doe_kc.discovery.verdict.alternatives import Alternatives, alternatives
from doe_kc.discovery.verdict.exclusion import HypothesisStatus, Status, hypothesis_statuses
from doe_kc.discovery.verdict.extra_test import ExtraTest, extra_tests
from doe_kc.discovery.verdict.findings import findings
from doe_kc.discovery.verdict.sentences import next_tests, sentences
from doe_kc.discovery.verdict.verdict import classes, verdict
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray


@one_thread()
def discover(
    model: EffectModel, library: Sequence[Hypothesis], bench: DiscoveryWorkers | None = None
) -> Discovery:
    """model: the axle without any effect, its tunable parameters and its records."""
    started = time.perf_counter()
    bench = bench or DiscoveryWorkers()
    found, widened = search_within_bounds(model, library, bench)
    nominal = model.residual(model.centre)
    final, tuned = found.final, found.tuned
    remaining = remaining_map(final.model.contrasts, final.residual, final.projection)
    before = remaining_map(tuned.model.contrasts, tuned.residual, tuned.projection)
    compared = alternatives(found, max(1.0, remaining.mean_square), bench)
    every = findings(found, compared)
    relevant = tuple(sorted((f for f in every if f.relevant), key=lambda f: -f.detectability))
    scanned = None if before.agrees else bench.scanned(tuned, max(1.0, remaining.mean_square))
    predicted = bench.held_out(found.tuned, found.plain, found.final) if relevant else ()
    judged = verdict(relevant, remaining, predicted, found.tuned, found.plain)
    holds = adequacy(remaining, predicted)
    somewhere = None if scanned is None else scanned()
    decoy = best_decoy(compared, relevant)
    whole, each = gaps(model.likelihood, nominal, found.tuned, found.plain, decoy.fit if decoy else None)
    traces = shown_traces(every, holds)
    statuses = _standings(found, (*relevant, *traces), len(library), resolved=resolved(found, holds))
    outside = beyond(model.space, found.plain)
    ambiguous = classes(relevant) if judged.kind == "class" else ()
    separating = _separating(compared, ambiguous)
    return Discovery(
        verdict=judged.kind,
        sentences=sentences(judged, relevant, holds, whole, remaining, somewhere, outside, widened),
        findings=relevant,
        traces=traces,
        classes=ambiguous,
        statuses=statuses,
        unexplained=tuple(remaining.worst(WORST)) if judged.kind == "unexplained" else (),
        adequacy=holds,
        search=found,
        decoy=decoy,
        nominal=nominal,
        raw=raw_map(tuned.model.contrasts, nominal),
        tuned=before,
        final=remaining,
        gap=whole,
        gaps=each,
        held_out=predicted,
        returned=returned(found.tuned, found.plain) if relevant else (),
        next_tests=next_tests(judged, relevant, ambiguous, statuses, separating),
        seconds=time.perf_counter() - started,
        scan=somewhere,
        widened=widened,
        beyond=outside,
        separating=separating,
    )


def best_decoy(compared: Sequence[Alternatives], relevant: Sequence[Finding]) -> HypothesisFit | None:
    """The best refit of another effect in place of the largest finding, None where none is plausible."""
    for own in compared:
        if relevant and own.hypothesis == relevant[0].hypothesis:
            others = [t for t in own.trials if t.hypothesis.effect != own.hypothesis.effect]
            return others[0] if others else None
    return None


def _separating(
    compared: Sequence[Alternatives], ambiguous: Sequence[Sequence[str]]
) -> dict[tuple[str, str], tuple[ExtraTest, ...]]:
    """Of every class, the load cases that tell its first effect from each other one."""
    out: dict[tuple[str, str], tuple[ExtraTest, ...]] = {}
    trials = {c.hypothesis.effect: c.trials for c in compared}
    for first, *others in ambiguous:
        own, *rest = trials[first]
        for other in others:
            rival = next((t for t in rest if t.hypothesis.effect == other), None)
            if rival is not None:
                out[first, other] = extra_tests(own.fit, rival.fit)
    return out


def resolved(search: EffectSearch, holds: Adequacy) -> bool:
    """Whether limits of effects that are not in the model mean anything.

    They take the model for right. Where what remains is not noise it is not; where the law of a friction is
    not the model's, what is missing of that hides effects larger than any such limit.
    """
    final = search.final
    open_ = (search.shares.get(h.name, 0.0) > 0.0 and sticks(final, h) for h in final.model.members)
    return holds.holds and not any(open_)


def shown_traces(every: Sequence[Finding], holds: Adequacy) -> tuple[Finding, ...]:
    """Effects too small to matter; of the rig only where the set holds: else they stand for anything."""
    small = (f for f in every if not f.relevant)
    return tuple(f for f in small if holds.holds or not EFFECTS[f.hypothesis.effect].on_rig)


def _standings(
    search: EffectSearch, named: Sequence[Finding], count: int, *, resolved: bool
) -> tuple[HypothesisStatus, ...]:
    """named: findings and traces that are given."""
    critical, last = float(np.sqrt(2.0 * threshold(count))), search.steps[-1].before
    members: list[tuple[Screened, Status]] = []
    statuses: dict[str, Status] = {f.hypothesis.name: "found" if f.relevant else "trace" for f in named}
    for hypothesis in search.final.model.members:
        step = accepted_at(search, hypothesis)
        own = next(s for s in step.screened if s.hypothesis == hypothesis)
        own = own.with_errors(step.before.model.likelihood, last.model.likelihood)
        members.append((own, statuses.get(hypothesis.name, "unresolved")))
    names = {s.hypothesis.name for s, _ in members}
    others = [s for s in search.steps[-1].screened if s.hypothesis.name not in names]
    return hypothesis_statuses(last, last.tuning_projection, others, members, critical, resolved=resolved)


def gaps(
    likelihood: Likelihood, nominal: FloatArray, tuned: Fit, final: Fit, decoy: Fit | None
) -> tuple[Gap, tuple[CurveGap, ...]]:
    """Of all records together, and of each load case and response."""
    rows: dict[tuple[str, str], list[int]] = {}
    for curve, place in likelihood.slices():
        at = rows.setdefault((curve.load_case, curve.response), [])
        at.extend(range(place.start, place.stop))
    residuals: Mapping[str, FloatArray | None] = {
        "nominal": nominal,
        "tuned": tuned.residual,
        "with_effect": final.residual,
        "best_decoy": None if decoy is None else decoy.residual,
    }

    def gap(places: slice | list[int], floor: float) -> Gap:
        found = {k: float("nan") if r is None else _rms(r[places]) for k, r in residuals.items()}
        return Gap(noise_floor=floor, **found)

    whole = gap(slice(None), noise_floor(final))
    return whole, tuple(CurveGap(c, r, gap(at, 1.0)) for (c, r), at in rows.items())


def noise_floor(final: Fit) -> float:
    """Whitened RMS expected of the right model: sqrt(1 - parameters used / data)."""
    used = float(np.sum(1.0 - np.diag(final.covariance) / final.model.prior_sd**2))
    return float(np.sqrt(max(0.0, 1.0 - used / final.residual.size)))


def _rms(residual: FloatArray) -> float:
    return float(np.sqrt(np.mean(residual**2)))


def returned(tuned: Fit, final: Fit) -> tuple[Returned, ...]:
    """Parameters that the re-tuned model had moved and that go back once the effects are there."""
    model = final.model
    count = model.parameters
    before = (tuned.z[:count] - model.centre[:count]) / model.prior_sd[:count]
    after = (final.z[:count] - model.centre[:count]) / model.prior_sd[:count]
    nominal = model.space.values(model.centre[:count])
    one, two = model.space.values(tuned.z[:count]), model.space.values(final.z[:count])
    out = [
        Returned(
            v.path,
            nominal[v.path],
            one[v.path],
            two[v.path],
            v.unit,
            float(before[i]),
            float(after[i]),
        )
        for i, v in enumerate(model.space.variables)
        if abs(before[i]) >= RETURNS_FROM and abs(after[i]) < abs(before[i])
    ]
    return tuple(sorted(out, key=lambda r: abs(r.with_effect_distance) - abs(r.tuned_distance)))
