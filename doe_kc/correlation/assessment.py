"""Whether a correlated axle can be used: one word, and the reasons in sentences.

sound: every measured characteristic inside its interval or its noise, nothing worse than before, few
variables at a bound, and what is left is noise. doubtful: usable where it is said. not_usable: worse than the
axle that was handed in, in anything that was measured, or no fit at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from doe_kc.correlation.posterior import BOUND_SHARE
from doe_kc.correlation.result import Correlation
from doe_kc.correlation.search_targets import hold_distance, hold_rms
from doe_kc.correlation.status import STATUS_LABELS, Status
from doe_kc.targets import Improvement
from doe_kc.targets.comparison import constraint_interval
from doe_kc.targets.improvement import SIGNIFICANT

BOUND_COUNT_SHARE = 0.1
"""Share of the variables that may end at a bound: more of them stand in for something."""
MISFIT = 1.2
"""Whitened RMS of the deviations from which they are more than noise; its own scatter is some 0.01."""


@dataclass(frozen=True)
class Assessment:
    """status, and the reasons for it in sentences; for a sound axle what was checked."""

    status: Status
    reasons: tuple[str, ...]

    @property
    def line(self) -> str:
        """The first line of everything that is handed over."""
        return f"{STATUS_LABELS[self.status]}: {' '.join(self.reasons)}"


@dataclass(frozen=True)
class Objection:
    """One sentence that speaks against an axle. fatal: it cannot be used."""

    sentence: str
    fatal: bool = False


def assess(
    correlation: Correlation, *, misfit: float | None = None, further: Sequence[Objection] = ()
) -> Assessment:
    """The status of the axle handed over.

    misfit: whitened RMS of what is left against the records, by default that of the mean curves. further:
    what is known from elsewhere, such as a discovery.
    """
    left = correlation.misfit if misfit is None else misfit
    objections = [
        *_harmed_characteristics(correlation),
        *_harmed_curves(correlation),
        *_no_fit(correlation),
        *_outside(correlation),
        *_relaxed(correlation),
        *further,
        *_left(left),
        *_at_bounds(correlation),
        *_freed(correlation),
    ]
    if not objections:
        count = len(correlation.improvements)
        return Assessment(
            "sound", (f"All {count} characteristics lie inside their interval or their noise.",)
        )
    fatal = any(o.fatal for o in objections)
    return Assessment(
        "not_usable" if fatal else "doubtful",
        tuple(o.sentence for o in sorted(objections, key=lambda o: not o.fatal)),
    )


def inside(entry: Improvement) -> bool:
    """Whether the final value lies in its interval (that of equations 5.1 and 5.2 without a constraint), or
    within three standard deviations of its target."""
    c = entry.target.constraint
    low, high = (c.low, c.high) if c is not None else constraint_interval(entry.target.value)
    near = abs(entry.final - entry.target.value) <= SIGNIFICANT * entry.target.sd
    return low <= entry.final <= high or near


def harmed(entry: Improvement) -> bool:
    """Whether the final value is further from its target than interval, noise and baseline allow."""
    limit = hold_distance(entry.target, entry.baseline)
    return abs(entry.final - entry.target.value) > limit * (1.0 + 1e-9)


def _harmed_characteristics(correlation: Correlation) -> list[Objection]:
    return [
        Objection(
            f"Worse than before: {e.target.entry.id} {e.final:.4g} {e.target.entry.unit} for "
            f"{e.target.value:.4g}, was {e.baseline:.4g}.",
            fatal=True,
        )
        for e in correlation.improvements
        if e.target.hold and harmed(e)
    ]


def _harmed_curves(correlation: Correlation) -> list[Objection]:
    out = []
    for curve, before, after in correlation.curve_deviations:
        if curve.hold and after > hold_rms(curve, before) * (1.0 + 1e-9):
            out.append(
                Objection(
                    f"Worse than before: the curve {curve.id}, RMS {after:.3g}, was {before:.3g}.",
                    fatal=True,
                )
            )
    return out


def _no_fit(correlation: Correlation) -> list[Objection]:
    """Where no design was better than the axle handed in, and that one is not at its targets."""
    settled = all(inside(e) for e in correlation.improvements)
    if settled or correlation.best.merit > correlation.baseline.merit:
        return []
    return [Objection("No design was better than the axle that was handed in.", fatal=True)]


def _outside(correlation: Correlation) -> list[Objection]:
    relaxed = correlation.relaxation.distances if correlation.relaxation is not None else {}
    out = [
        e
        for e in correlation.improvements
        if not inside(e)
        and e.target.entry.id not in relaxed
        and (e.target.objective is None or e.target.objective.goal == "target")
    ]
    return [Objection(f"Outside interval and noise: {_values(out)}.")] if out else []


def _relaxed(correlation: Correlation) -> list[Objection]:
    relaxed = correlation.relaxation.distances if correlation.relaxation is not None else {}
    out = [e for e in correlation.improvements if e.target.entry.id in relaxed and not inside(e)]
    return [Objection(f"Out of reach within the bounds: {_values(out)}.")] if out else []


def _values(entries: Sequence[Improvement]) -> str:
    return ", ".join(
        f"{e.target.entry.id} {e.final:.4g} for {e.target.value:.4g} {e.target.entry.unit}" for e in entries
    )


def _left(misfit: float | None) -> list[Objection]:
    if misfit is None or not misfit > MISFIT:
        return []
    return [Objection(f"The deviations that are left are {misfit:.1f} times the noise of the records.")]


def _at_bounds(correlation: Correlation) -> list[Objection]:
    point = correlation.best.point
    ended = (point <= BOUND_SHARE) | (point >= 1.0 - BOUND_SHARE)
    names = [v.path for v, out in zip(correlation.problem.space.variables, ended, strict=True) if out]
    if len(names) <= max(1.0, BOUND_COUNT_SHARE * point.size):
        return []
    return [
        Objection(f"{len(names)} of {point.size} variables end at a bound: they may stand in for an effect.")
    ]


def _freed(correlation: Correlation) -> list[Objection]:
    freed = [
        e for e in correlation.improvements if not e.target.hold and _aimed(e) and harmed(e) and not inside(e)
    ]
    return [Objection(f"Let go by the study and worse than before: {_values(freed)}.")] if freed else []


def _aimed(entry: Improvement) -> bool:
    objective = entry.target.objective
    return objective is None or objective.goal == "target"
