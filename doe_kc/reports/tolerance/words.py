"""What follows from a tolerance study, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from doe_kc.ground.listing import first_of
from doe_kc.ground.numbers import number, unit_words
from doe_kc.production_scatter.result import Tolerance
from doe_kc.production_scatter.statistics import CarShare
from doe_kc.production_scatter.tightening import Tightening

MOST_NAMED = 3
"""Characteristics or parameters that a sentence names."""


def share_words(share: CarShare) -> str:
    """`3.2 % (2.3 to 4.5)`: share of the cars and its 95 % interval."""
    low, mid, high = (100.0 * v for v in (share.low, share.share, share.high))
    return f"{number(mid, 3)} % ({number(low, 2)} to {number(high, 2)})"


def ranked_tightenings(tolerance: Tolerance) -> list[Tightening]:
    """The one that brings most first: cars outside any requirement, where that makes a difference; then
    requirements that a car misses; then the sum of the relative reductions of all standard deviations."""
    some = bool(tolerance.required)

    def merit(t: Tightening) -> tuple[float, float, float]:
        gain = tolerance.any_outside.count - t.any_outside.count if some else 0
        return (float(gain), tolerance.missed - t.missed if some else 0.0, float(np.sum(1.0 - t.sd_ratio)))

    return sorted(tolerance.tightenings, key=merit, reverse=True)


def conclusions(tolerance: Tolerance) -> list[str]:
    """Sentences, the most important first."""
    return list(_conclusions(tolerance))


def _conclusions(tolerance: Tolerance) -> Iterator[str]:
    cars = f"{tolerance.n} cars, {len(tolerance.model.scatters)} parameters scatter"
    failed = (
        f"; {len(tolerance.failures)} cars have no equilibrium and are left out" if tolerance.failures else ""
    )
    yield f"{cars}{failed}; {tolerance.seconds:.1f} s, {tolerance.runs} solved now."
    if tolerance.required:
        yield from _requirement_words(tolerance)
    yield from _best_words(tolerance)
    curved = [s for s in tolerance.scatters if not s.linear]
    if curved:
        worst = sorted(curved, key=lambda s: s.explained)[:MOST_NAMED]
        listed = ", ".join(f"{s.entry.id} ({100.0 * s.explained:.0f} %)" for s in worst)
        yield (
            f"{len(curved)} of {len(tolerance.scatters)} characteristics are not linear over the scatter: "
            f"slopes explain less than 95 % of their variance, least of {listed}."
        )
    else:
        yield "All characteristics are linear over the scatter: slopes explain 95 % of each variance."


def _requirement_words(tolerance: Tolerance) -> Iterator[str]:
    stated = all(r.stated for _, r in tolerance.required)
    whose = "requirements" if stated else "intervals of the targets"
    yield (
        f"{share_words(tolerance.any_outside)} of the cars are outside at least one of "
        f"{len(tolerance.required)} {whose}."
    )
    known = [(s, s.outside) for s in tolerance.scatters if s.outside is not None and s.outside.count]
    worst = sorted(known, key=lambda pair: -pair[1].share)[:MOST_NAMED]
    if worst:
        yield "Most often outside: " + ", ".join(f"{s.entry.id} {share_words(o)}" for s, o in worst) + "."
    centre = [
        s.entry.id
        for s in tolerance.scatters
        if s.requirement is not None and bool(s.requirement.outside(np.array([s.nominal]))[0])
    ]
    if centre:
        yield (
            f"The unchanged axle is itself outside in {first_of(centre, MOST_NAMED)}: there no tolerance "
            "helps, the axle has to move."
        )


def _best_words(tolerance: Tolerance) -> Iterator[str]:
    now = tolerance.any_outside
    for t in ranked_tightenings(tolerance)[:MOST_NAMED]:
        parameter = t.scatter.parameter
        head = (
            f"Halving the scatter of {parameter.path} (sd {number(t.scatter.sd)}{unit_words(parameter.unit)})"
        )
        if tolerance.required and t.any_outside.count < now.count:
            before, after = (number(100.0 * s.share) for s in (now, t.any_outside))
            yield f"{head} takes the cars outside from {before} to {after} %."
        elif tolerance.required and t.missed < tolerance.missed:
            yield (
                f"{head} takes the requirements that a car misses from {tolerance.missed:.2f} to "
                f"{t.missed:.2f} of {len(tolerance.required)}."
            )
        else:
            k = int(np.argmin(t.sd_ratio))
            yield (
                f"{head} takes {100.0 * (1.0 - t.sd_ratio[k]):.0f} % off the standard deviation of "
                f"{tolerance.characteristics[k].id}."
            )
