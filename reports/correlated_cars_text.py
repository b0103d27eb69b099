"""The words of the report on correlated cars."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from correlation_runs import Trace
from recovery import BUDGET, Fit, far_off
from report_text import first_times, number, spread, table

HEAD = """# Two measured cars correlated, their parameters known

Two virtual cars (`tests/data/rig`: records with noise, and the key of the parameters that made them) are
correlated from the example's nominal axle with all {d} default variables. Made by
`python reports/correlated_cars.py`, which also asserts what is stated here.

## The rating: `ego`

Default settings, budget {budget} evaluations, {seeds} seeds a car. Improvement: of the active
characteristics that count (baseline more than three standard errors from its target), 100 % = target met.
Median (lowest to highest). A run takes {seconds} s of one core.

{ego}

{verdict}

## The curves: `gauss_newton`

Misfit: mean squared residual in units of the records' noise; 1 = fitted to noise level. Seconds of one
core.

{fits}

Within two stated standard deviations of the truth: **{inside} of {judged}** visible parameters of the
measured cars ({share:.1f} %). Visible: the measurement at least halves the prior standard deviation;
counted are those that the key states.

**Calibration.** {n} synthetic cars: the nominal axle with production scatter (1 mm, bushings 20 %, rates 3 %,
angles 0.1 deg, ride height and stop clearances 1 mm), solved, with noise drawn from the noise model of
car_b's records. Of {synthetic_judged} visible parameters **{coverage:.1f} ± {error:.1f} %** lie within two
stated standard deviations (± is the standard error from car to car). Gaussian errors would give 95.4 %; the
stated ones are a little cautious, because the prior (uniform between the bounds) is wider than the scatter
that the cars were drawn with. rms of (estimate - truth) / sd without the stops' clearances: {rms:.2f}.
Misfit {misfit}: below 1 by the fitted parameters and the allowance for corners of curves; {feasible} of {n}
meet every constraint (the fit knows of none; a target within noise of its interval can fall outside).

**Where it does not hold.** Farther than three stated standard deviations: {far}. A stop that the record
touches with its last point, or just not, is a corner: beyond it the clearance changes nothing, so that the
error is one-sided and the linear standard deviation says too little. {stuck} of {n} fits ended at such a
corner without the word "converged", at noise level all the same (budget {fit_budget}).

![recovery](correlated_cars.png)

Left: each parameter's estimate beside the truth, both as change from nominal in prior standard deviations.
What is not visible stays near nominal with a wide bar, and says so. Right: the errors of the synthetic
cars.

Visible in both measured cars: {visible}.
"""


def markdown(
    ego: Mapping[str, list[Trace]],
    fits: Mapping[str, Fit],
    synthetic: Sequence[Fit],
    coverage: Callable[[list[Fit]], tuple[float, float]],
) -> str:
    """The report."""
    runs = [t for each in ego.values() for t in each]
    own, own_error = coverage(list(synthetic))
    z = np.concatenate([f.z[f.judged] for f in synthetic])
    plain = np.concatenate([f.z[f.judged & ["stop" not in p for p in f.paths]] for f in synthetic])
    far = ", ".join(f"`{path}` ({value:+.1f})" for path, value in far_off(synthetic)) or "none"
    first = next(iter(fits.values()))
    return HEAD.format(
        d=len(first.paths),
        budget=max(t.evaluations for t in runs),
        seeds=len(runs) // len(ego),
        seconds=spread([t.seconds for t in runs], 2),
        ego=_ego_table(ego),
        verdict=verdict(runs),
        fits=_fit_table(fits, synthetic),
        inside=sum(f.inside for f in fits.values()),
        judged=sum(int(f.judged.sum()) for f in fits.values()),
        share=100.0 * coverage(list(fits.values()))[0],
        n=len(synthetic),
        synthetic_judged=z.size,
        coverage=100.0 * own,
        error=100.0 * own_error,
        rms=float(np.sqrt(np.mean(plain**2))),
        far=far,
        stuck=sum(not f.stopped.startswith("converged") for f in synthetic),
        fit_budget=BUDGET,
        misfit=spread([f.misfit["all"] for f in synthetic]),
        feasible=sum(f.feasible for f in synthetic),
        visible=visible_in_all(list(fits.values())),
    )


def verdict(runs: Sequence[Trace]) -> str:
    """How many runs did what is claimed of them, and what the others miss."""
    met = sum(t.feasible for t in runs)
    enough = sum(t.improvement >= 95.0 for t in runs)
    missed = sorted({v for t in runs for v in t.violated})
    words = (
        f"All constraints met in {met} of {len(runs)} runs; mean improvement of at least 95 % in {enough}."
    )
    return words + (f" Missed at times: {', '.join(missed)}." if missed else "")


def visible_in_all(fits: Sequence[Fit]) -> str:
    """Parameters that every car's records see, in words."""
    names = [p for i, p in enumerate(fits[0].paths) if all(f.visible[i] for f in fits)]
    return ", ".join(f"`{n}`" for n in names)


def _ego_table(ego: Mapping[str, list[Trace]]) -> str:
    head = (
        "car", "constraints met", "mean improvement [%]", "evaluations to feasibility",
        "evaluations", "rating",
    )  # fmt: skip
    return table(head, [_ego_row(car, runs) for car, runs in ego.items()])


def _ego_row(car: str, runs: Sequence[Trace]) -> list[str]:
    return [
        car,
        f"{sum(t.feasible for t in runs)} of {len(runs)}",
        spread([t.improvement for t in runs]),
        first_times([t.feasible_at for t in runs]),
        spread([t.evaluations for t in runs]),
        spread([t.rating for t in runs]),
    ]


def _fit_table(fits: Mapping[str, Fit], synthetic: Sequence[Fit]) -> str:
    cases = list(next(iter(fits.values())).misfit)
    head = ["", *fits, f"{len(synthetic)} synthetic cars"]
    rows = [
        [
            f"misfit, {c}",
            *(f"{f.misfit[c]:.2f}" for f in fits.values()),
            spread([f.misfit[c] for f in synthetic], 2),
        ]
        for c in cases
    ]
    judged = [int(f.judged.sum()) for f in synthetic]
    rows.append(_line("visible parameters", fits, synthetic, lambda f: sum(f.visible)))
    within = [f"{f.inside} of {f.judged.sum()}" for f in fits.values()]
    rows.append(["visible within 2 sd", *within, f"{sum(f.inside for f in synthetic)} of {sum(judged)}"])
    rows.append(_line("evaluations", fits, synthetic, lambda f: f.evaluations))
    rows.append(_line("seconds", fits, synthetic, lambda f: f.seconds))
    return table(head, rows)


def _line(
    name: str, fits: Mapping[str, Fit], synthetic: Sequence[Fit], value: Callable[[Fit], float]
) -> list[str]:
    return [name, *(number(value(f), 2) for f in fits.values()), spread([value(f) for f in synthetic], 2)]
