"""The whole discovery on one car: from an axle and its records to a verdict."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from doe_kc.discovery.alternatives import Alternatives, alternatives
from doe_kc.discovery.bench import Bench
from doe_kc.discovery.contrasts import contrasts
from doe_kc.discovery.disagreement import raw_map, remaining_map
from doe_kc.discovery.extra_test import ExtraTest, extra_tests
from doe_kc.discovery.findings import findings
from doe_kc.discovery.gaps import gaps, returned
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.projection import projection
from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.screen import Screened
from doe_kc.discovery.search import Search, accepted_at, threshold
from doe_kc.discovery.sentences import next_tests, sentences
from doe_kc.discovery.standing import Standing, Status, standings
from doe_kc.discovery.trials import Trial
from doe_kc.discovery.verdict import classes, verdict
from doe_kc.discovery.widening import beyond, searched
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.threads import one_thread

WORST = 8
"""Unexplained disagreements that are listed."""


@one_thread()
def discover(model: EffectModel, library: Sequence[Hypothesis], bench: Bench | None = None) -> Discovery:
    """model: the axle without any effect, its tunable parameters and its records."""
    started = time.perf_counter()
    bench = bench or Bench()
    found, widened = searched(model, library, bench)
    nominal = model.residual(model.centre)
    project = projection(found.final)
    remaining = remaining_map(contrasts(found.final.model.likelihood), found.final.residual, project)
    shapes = contrasts(model.likelihood)
    before = remaining_map(shapes, found.tuned.residual, projection(found.tuned))
    compared = alternatives(found, max(1.0, remaining.mean_square), bench)
    every = findings(found, compared)
    relevant = tuple(sorted((f for f in every if f.relevant), key=lambda f: -f.detectability))
    predicted = bench.held_out(found.tuned, found.plain) if relevant else ()
    judged = verdict(relevant, before, remaining, predicted, found.tuned, found.plain)
    somewhere = None if before.agrees else bench.scanned(found.tuned, max(1.0, remaining.mean_square))
    decoy = best_decoy(compared, relevant)
    whole, each = gaps(model.likelihood, nominal, found.tuned, found.plain, decoy.fit if decoy else None)
    stands = _standings(found, every, len(library))
    outside = beyond(model.space, found.plain)
    ambiguous = classes(relevant) if judged.kind == "class" else ()
    separating = _separating(compared, ambiguous)
    return Discovery(
        verdict=judged.kind,
        sentences=sentences(judged, relevant, whole, remaining, somewhere, outside, widened),
        findings=relevant,
        traces=tuple(f for f in every if not f.relevant),
        classes=ambiguous,
        standings=stands,
        unexplained=tuple(remaining.worst(WORST)) if judged.kind == "unexplained" else (),
        search=found,
        decoy=decoy,
        nominal=nominal,
        raw=raw_map(shapes, nominal),
        tuned=before,
        final=remaining,
        gap=whole,
        gaps=each,
        held_out=predicted,
        returned=returned(found.tuned, found.plain) if relevant else (),
        next_tests=next_tests(judged, relevant, ambiguous, stands, separating),
        seconds=time.perf_counter() - started,
        scan=somewhere,
        widened=widened,
        beyond=outside,
        separating=separating,
    )


def best_decoy(compared: Sequence[Alternatives], relevant: Sequence[Finding]) -> Trial | None:
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


def _standings(found: Search, every: Sequence[Finding], count: int) -> tuple[Standing, ...]:
    critical, last = float(np.sqrt(2.0 * threshold(count))), found.steps[-1].before
    members: list[tuple[Screened, Status]] = []
    for f in every:
        step = accepted_at(found, f.hypothesis)
        own = next(s for s in step.screened if s.hypothesis == f.hypothesis)
        own = own.with_errors(step.before.model.likelihood, last.model.likelihood)
        members.append((own, "found" if f.relevant else "trace"))
    names = {s.hypothesis.name for s, _ in members}
    others = [s for s in found.steps[-1].screened if s.hypothesis.name not in names]
    return standings(last, projection(last, effects=False), others, members, critical)
