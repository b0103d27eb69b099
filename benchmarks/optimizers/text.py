"""What the page says around its tables; verdicts on the goals are computed from the runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from optimizers.figures import LEVELS, OURS, best_rating, median, to_feasible, to_level, used
from optimizers.peer import Peer
from optimizers.running import Result

Figure = Callable[[Result], float]
GOAL = 10.0
MARKS: dict[str, Figure] = {
    **{f"{100 * level:g} %": to_level(level) for level in LEVELS},
    "feasible": to_feasible,
}

CONDITIONS = """Records of car_b, all {size} default variables, targets as the product makes them. \
Everyone has the same start, bounds and targets; one wrapper counts, baseline and repeated designs too. \
Deviation: the sum over the active characteristics of ((value - target) / Norm)^2. Columns 10 %, 1 %, \
0.1 %: evaluations until it has fallen to that share of the start's; feasible: until all constraints are \
met; as the true car: until the rating of the car that the records were made of ({rating:.2f}). Median \
(worst) over seeds; a median of an even number of seeds is the upper one. Ours in bold.

- The true car's own deviation is {share:.1f} % of the start's: measurement noise. The levels 1 % and \
0.1 % lie below it and measure how fast a search is, not how true its axle is.
- `ego` as shipped and `gauss_newton` also take exact sensitivities of the product's own solver, which no \
peer sees and which are not counted as evaluations; what they cost stands below the tables. `ego` with \
`gradients = false` is what an outside solver gets, and the row to hold against the peers.
- `gauss_newton` fits the whole curves by their errors and stops when they ask for no more; it works \
neither on the deviation nor on the rating, and its answer is the most probable axle.
- DFO-LS and least_squares minimize a sum of squares (objectives' e / Norm, violations by sqrt(QuadWt) / \
Norm, scaled curves), not the rating; BoTorch composite maximizes the rating itself.
- The others see the rating (2.2) alone; NSGA-II its sums by load case; BoTorch's GP of the rating models \
-log(-rating), as the rating spans three decades.
- First steps: 0.1 of the bounds for DFO-LS, COBYQA and CMA-ES, as the half-width of the opening sample \
of `ego`; both BoTorch searches are given the very sample that it opens with without slopes. No \
peer's settings were searched for; the defaults of `ego` may have been chosen on this car, which favours it.
- The variables are continuous for everyone.
- Peers with fewer seeds than five: see the column. CMA-ES may use 1000 evaluations, BoTorch composite 50, \
BoTorch's GP of the rating 150, SMT EGO 45, Optuna's GPSampler four minutes; others 300."""


def reading(peers: Sequence[Peer], runs: Mapping[str, Sequence[Result]]) -> list[str]:
    """Whether ego reaches its goals, level by level, with slopes and without."""
    by_id = {p.id: p for p in peers}
    there = [p for p in peers if not p.ours and runs[p.id]]
    lines: list[str] = []
    for name, words in OURS.items():
        if runs[name]:
            lines += [f"## Goals of {words}", "", *_goals(by_id[name], there, runs), ""]
    return [*lines, *_at_fifty(runs)]


def _goals(own: Peer, there: Sequence[Peer], runs: Mapping[str, Sequence[Result]]) -> list[str]:
    lines: list[str] = []
    scalar = [p for p in there if p.sees == "rating"]
    aware = [p for p in there if p.sees != "rating"]
    for mark, figure in MARKS.items():
        ours = median(runs[own.id], figure)
        verdict = "; ".join(filter(None, (_short(p, runs[p.id], figure, ours) for p in scalar)))
        never = sum(not math.isfinite(median(runs[p.id], figure)) for p in scalar)
        lines += [
            f"- {mark}, ten times fewer than every scalar method ({never} of {len(scalar)} never get there): "
            f"{'not so for ' + verdict if verdict else 'met'}.",
            f"- {mark}, no more than the best residual-aware peer: {_best(aware, runs, figure, ours)}.",
        ]
    return lines


def _at_fifty(runs: Mapping[str, Sequence[Result]]) -> list[str]:
    """Best rating of ego and its strongest peer."""
    names = {
        "ego_values": "ego",
        "botorch_composite": "BoTorch composite",
    }
    there = [n for n in names if runs[n]]
    listed = ", ".join(f"{names[n]} {best_rating(runs[n], 50):.3f} ({len(runs[n])} seeds)" for n in there)
    return [f"Best rating after 50 evaluations, none with slopes: {listed}."]


def _short(peer: Peer, found: Sequence[Result], figure: Figure, ours: float) -> str:
    """Empty when the peer needs ten times as many, or is shown not to get there in so many."""
    theirs = median(found, figure)
    if math.isfinite(theirs):
        return "" if theirs >= GOAL * ours else f"{peer.label} ({theirs / ours:.1f} times)"
    tried = used(found) / ours
    return "" if tried >= GOAL else f"{peer.label} (not reached, but only tried to {tried:.1f} times)"


def _best(aware: Sequence[Peer], runs: Mapping[str, Sequence[Result]], figure: Figure, ours: float) -> str:
    """Against the residual-aware peer that needs fewest."""
    if not aware:
        return "no such peer was run"
    theirs, name, spent = min((median(runs[p.id], figure), p.label, used(runs[p.id])) for p in aware)
    if not math.isfinite(theirs):
        return f"met, none gets there (in {spent})"
    return f"{'met' if ours <= theirs else 'missed'}, ego {ours:.0f}, {name} {theirs:.0f}"
