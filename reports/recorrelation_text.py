"""The words of the report on re-correlation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from correlation_runs import Trace
from recorrelation_case import Case
from recorrelation_figure import SEEN
from report_text import first_times, number, spread, table

HEAD = """# A disturbed model correlated back

The study that the thesis cites as typical of an optimization "which has a solution that the model is able
to fulfil without making trade-offs" (section 6.2): a model is tweaked and correlated to its own curves. The
nominal axle of `examples/front_axle` is disturbed in all {d} variables by drawn changes of known size
(production scatter: hardpoints 1 mm, bushings 20 %, rates 3 %, angles 0.1 deg, ride height and stop
clearances 1 mm; and {large} times as much). Its noise-free curves are the targets, and the search starts
from nominal with the default bounds and settings. Made by `python reports/recorrelation.py`, which also
asserts the figures.

{runs}

Deviation: mean of |value - target| / Norm over the {active} active characteristics. Mean improvement: over
all of them, including those that nominal misses by almost nothing, since targets without noise have no
error that a small deviation could hide in. `gauss_newton` assumes {share:g} times the rig's noise. Median
(lowest to highest) over cars and seeds.

![re-correlation](recorrelation.png)

Left: every run. Right: what is left of the disturbance along the principal directions of the space of
variables, from those that no record shows to those that any does.

## Are the parameters found again?

{groups}

rms over the parameters and cars in prior standard deviations; "left" is estimate minus truth. Visible:
records with the rig's own noise would at least halve the prior standard deviation.

![parameters](recorrelation_parameters.png)

{words}
"""

WORDS = """- **What is left of the rating is the resolution.** On 101 levels, the default, `ego` ends at
  {levels}; with `levels = "continuous"` at {fine}. Where a target lies near zero, as anti-lift does in
  two of these cars, half a level of `LLF.z`, 0.03 mm, costs 0.15 of the rating, and no choice of the other
  levels makes up for it. In records with noise less is lost (`configurations.md`, Figure 6).
- **The characteristics are found again, the parameters only where the curves see them.** Of {d}
  directions in the space of variables, {many} are seen by records with the rig's noise (the prior standard
  deviation at least halved). Along these `gauss_newton` leaves {seen:.1%} of the disturbance, along the
  {few} others {unseen:.0%}. Those others are the null space: combinations of parameters that move the
  curves by less than their noise. No method and no further evaluation finds them; another record, or fewer
  variables, would.
- **`ego` leaves {ego_seen:.0%} of what is seen and {ego_unseen:.0%} of what is not.** It works on {active}
  characteristics and the curves with an objective, not on all curves, from {budget} evaluations, and stops
  where the rating is good: along all but the strongest directions a change of parameters costs next to
  nothing.{more}
- **Found again best** (`gauss_newton`): {best}.
- **Not found at all** (at least 95 % left): {worst}. The torsional stiffness of a bushing carries next to
  nothing beside the links that turn it, a point of the sub-frame matters only by how its bushing deflects,
  and `LWD.z` moves along the damper's axis, nearly.
- **Consequence.** A correlated model is right in what was measured. Its parameters are statements about the
  car only where the report of a correlation calls them visible.
"""


def markdown(cases: Sequence[Case], parameters: pd.DataFrame, share: float) -> str:
    """The report."""
    return HEAD.format(
        d=len(parameters),
        large=number(max(c.times for c in cases)),
        runs=_runs(cases),
        active=cases[0].active,
        share=share,
        groups=_groups(cases),
        words=_words(cases, parameters),
    )


def _runs(cases: Sequence[Case]) -> str:
    head = (
        "disturbance", "method", "variables", "runs", "rating at nominal", "rating found", "constraints met",
        "evaluations to feasibility", "deviation before [%]", "deviation left [%]", "deviation removed [%]",
        "mean improvement [%]",
        "evaluations",
    )  # fmt: skip
    rows = []
    for times in sorted({c.times for c in cases}):
        own = [c for c in cases if c.times == times]
        rows.append(_row(times, "levels", [t for c in own for t in c.ego]))
        rows.append(_row(times, "continuous", [t for c in own for t in c.fine]))
        rows.append(_row(times, "continuous", [c.newton for c in own]))
    return table(head, rows)


def _row(times: float, variables: str, runs: Sequence[Trace]) -> list[str]:
    return [
        f"{times:g} × scatter",
        f"`{runs[0].method}`",
        variables,
        str(len(runs)),
        spread([t.best[0] for t in runs]),
        spread([t.rating for t in runs]),
        f"{sum(t.feasible for t in runs)} of {len(runs)}",
        first_times([t.feasible_at for t in runs]),
        spread([100.0 * t.deviation[0] for t in runs]),
        spread([100.0 * t.deviation[1] for t in runs]),
        spread([100.0 * (1.0 - t.deviation[1] / t.deviation[0]) for t in runs]),
        spread([t.improvement for t in runs]),
        spread([t.evaluations for t in runs]),
    ]


LOST = 0.95
"""Share of the disturbance left from which a parameter counts as not found."""
GROUPS = ("hardpoints", "bushings, F", "bushings, T", "others")


def group_of(path: str) -> str:
    """Kind of parameter."""
    point, _, axis = path.partition(".")
    if point.isupper():
        return GROUPS[0]
    if point in {"llf", "llr", "sff", "sfr", "upb"}:
        return GROUPS[1] if axis.startswith("F") else GROUPS[2]
    return GROUPS[3]


def _groups(cases: Sequence[Case]) -> str:
    head = ("parameters", "", "number a car", "disturbance", "left by `ego`", "left by `gauss_newton`")
    kinds = np.array([group_of(p) for p in cases[0].paths])
    rows = []
    for name in (*GROUPS, "all"):
        for word, wanted in (("visible", True), ("not visible", False)):
            masks = [(c.visible.astype(bool) == wanted) & ((kinds == name) | (name == "all")) for c in cases]
            if any(m.any() for m in masks):
                rows.append([name, word, *_group_row(cases, masks)])
    return table(head, rows)


def _group_row(cases: Sequence[Case], masks: Sequence[np.ndarray]) -> list[str]:
    pairs = list(zip(cases, masks, strict=True))
    moved = np.concatenate([c.moved[m] for c, m in pairs])
    by_ego = np.concatenate([c.left(t.point)[m] for c, m in pairs for t in c.ego])
    by_fit = np.concatenate([c.left(c.fit.estimate)[m] for c, m in pairs])
    rms = [f"{np.sqrt(np.mean(v**2)):.2f}" for v in (moved, by_ego, by_fit)]
    return [number(float(np.mean([m.sum() for m in masks]))), *rms]


def _words(cases: Sequence[Case], parameters: pd.DataFrame) -> str:
    share = parameters["left_by_gauss_newton"] / parameters["moved"]
    order = parameters["parameter"].to_numpy()[np.argsort(share.to_numpy())]
    many = float(np.mean([np.sum(c.seen > SEEN) for c in cases]))
    seen = [left_along(cases, what, wanted=True) for what in ("fit", "ego")]
    unseen = [left_along(cases, what, wanted=False) for what in ("fit", "ego")]
    more = " Along unseen ones it ends further from the truth than nominal was." if unseen[1] > 1.0 else ""
    lost = parameters["parameter"][share >= LOST]
    return WORDS.format(
        d=len(parameters),
        many=f"{many:.0f}",
        few=f"{len(parameters) - many:.0f}",
        seen=seen[0],
        unseen=unseen[0],
        ego_seen=seen[1],
        ego_unseen=unseen[1],
        more=more,
        best=", ".join(f"`{p}`" for p in order[:12]),
        worst=", ".join(f"`{p}`" for p in lost),
        active=cases[0].active,
        levels=spread([t.rating for c in cases for t in c.ego]),
        fine=spread([t.rating for c in cases for t in c.fine]),
        budget=max(t.evaluations for c in cases for t in c.ego),
    )


def left_along(cases: Sequence[Case], what: str, *, wanted: bool) -> float:
    """rms left over rms disturbance along the directions that the rig sees, or does not."""
    left, moved = 0.0, 0.0
    for c in cases:
        points = [c.fit.estimate] if what == "fit" else [t.point for t in c.ego]
        mask = (c.seen > SEEN) == wanted
        moved += len(points) * float(np.sum((c.axes.T @ c.moved)[mask] ** 2))
        left += sum(float(np.sum((c.axes.T @ c.left(p))[mask] ** 2)) for p in points)
    return float(np.sqrt(left / moved))
