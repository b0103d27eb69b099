"""The words of the report on correlated cars."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from correlation_runs import Trace
from recovery import BUDGET, Fit, far_off
from report_text import first_times, number, spread, table

Coverage = Callable[[list[Fit]], tuple[float, float]]

HEAD = """# Two measured cars correlated, their parameters known

Two virtual cars (`tests/data/rig`: records with noise, and the key of the parameters that made them) are
correlated from the example's nominal axle with all {d} default variables. Made by
`python reports/correlated_cars.py`, which also asserts what is stated here.

## The rating: `ego`

Default settings, {seeds} seeds a car; slopes "exact" as shipped with the built-in solver, "learnt" with
`gradients = false`, as for an outside solver, from at most {budget} evaluations. Exact sensitivities are not
counted as evaluations; each takes the time of some 20 of them. Improvement: of the active characteristics
that count (baseline more than three standard errors from its target), 100 % = target met. Median (lowest to
highest); seconds of one core.

{ego}

{verdict}

## The curves: `gauss_newton`

Misfit: mean squared residual in units of the records' noise; 1 = fitted to noise level. Seconds of one
core.

{fits}

Within two stated standard deviations of the truth: **{inside} of {judged}** visible parameters of the
measured cars ({share:.1f} %). Visible: the measurement at least halves the prior standard deviation;
counted are those that the key states.

**Calibration.** {n} synthetic cars of each of two kinds: the nominal axle with production scatter
(hardpoints 1 mm, bushings 20 %, rates 3 %, angles 0.1 deg, ride height and stop clearances 1 mm) or a
multiple of it, solved, with noise drawn from the noise model of car_b's records.

{calibration}

Inside: visible parameters within two stated standard deviations; ± is the standard error from car to car.
Gaussian errors would give 95.4 %. The stated errors are a little cautious for production scatter, because
the prior (uniform between the bounds) is wider than that. rms: of (estimate - truth) / sd without the
stops' clearances. Misfit is below 1 by the fitted parameters and the allowance for corners of curves. The
fit knows of no constraints; a target within noise of its interval can fall outside.

**Where it does not hold.** Farther than three stated standard deviations: {far}.

- A stop that the record touches with its last point, or just not, is a corner: beyond it the clearance
  changes nothing, so the error is one-sided and the linear standard deviation says too little. At such
  corners {stuck} of {all} synthetic fits end without the word "converged" (step too small, or the budget of
  {fit_budget}), at noise level all the same.
- `sff.Fy` and `sfr.Fy` of car_e trade with each other and with `sff.Fx` in a curved valley: these bushings
  lie up to half or double their nominal stiffness, and the truth fits the records as well as the estimate
  does.

![recovery](correlated_cars.png)

Left: each parameter's estimate beside the truth, both as change from nominal in prior standard deviations.
What is not visible stays near nominal with a wide bar, and says so. Right: the errors of the synthetic
cars.

Visible in both measured cars: {visible}.
"""


def markdown(
    ego: Mapping[tuple[str, str], list[Trace]],
    fits: Mapping[str, Fit],
    synthetic: Mapping[float, list[Fit]],
    coverage: Coverage,
) -> str:
    """The report."""
    runs = [t for each in ego.values() for t in each]
    own = list(fits.values())
    made = [f for each in synthetic.values() for f in each]
    return HEAD.format(
        d=len(own[0].paths),
        budget=max(t.evaluations for t in runs),
        seeds=len(runs) // len(ego),
        ego=_ego_table(ego),
        verdict=verdict(runs),
        fits=_fit_table(fits, synthetic),
        inside=sum(f.inside for f in own),
        judged=sum(int(f.judged.sum()) for f in own),
        share=100.0 * coverage(own)[0],
        n=len(made) // len(synthetic),
        calibration=_calibration(synthetic, coverage),
        far=_far({**{car: [f] for car, f in fits.items()}, **_named(synthetic)}),
        stuck=sum(not f.stopped.startswith("converged") for f in made),
        all=len(made),
        fit_budget=BUDGET,
        visible=visible_in_all(own),
    )


def _named(synthetic: Mapping[float, list[Fit]]) -> dict[str, list[Fit]]:
    return {f"{times:g} × scatter": fits for times, fits in synthetic.items()}


def _calibration(synthetic: Mapping[float, list[Fit]], coverage: Coverage) -> str:
    head = ("cars", "visible parameters", "inside [%]", "rms", "constraints met", "converged")
    rows = []
    for name, fits in _named(synthetic).items():
        share, error = (100.0 * v for v in coverage(fits))
        plain = np.concatenate([f.z[f.judged & ["stop" not in p for p in f.paths]] for f in fits])
        done = sum(f.stopped.startswith("converged") for f in fits)
        rows.append(
            [
                f"{len(fits)}, {name}",
                str(sum(int(f.judged.sum()) for f in fits)),
                f"**{share:.1f} ± {error:.1f}**",
                f"{np.sqrt(np.mean(plain**2)):.2f}",
                f"{sum(f.feasible for f in fits)} of {len(fits)}",
                f"{done} of {len(fits)}",
            ]
        )
    return table(head, rows)


def _far(groups: Mapping[str, list[Fit]]) -> str:
    found = {name: far_off(fits) for name, fits in groups.items()}
    words = [
        f"{name}: {', '.join(f'`{p}` ({z:+.1f})' for p, z in far)}" for name, far in found.items() if far
    ]
    return "; ".join(words) or "none"


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


def _ego_table(ego: Mapping[tuple[str, str], list[Trace]]) -> str:
    head = (
        "car", "slopes", "constraints met", "mean improvement [%]", "evaluations to feasibility",
        "evaluations", "rating", "seconds",
    )  # fmt: skip
    return table(head, [_ego_row(*kind, runs) for kind, runs in ego.items()])


def _ego_row(car: str, slopes: str, runs: Sequence[Trace]) -> list[str]:
    return [
        car,
        slopes,
        f"{sum(t.feasible for t in runs)} of {len(runs)}",
        spread([t.improvement for t in runs]),
        first_times([t.feasible_at for t in runs]),
        spread([t.evaluations for t in runs]),
        spread([t.rating for t in runs]),
        spread([t.seconds for t in runs], 2),
    ]


def _fit_table(fits: Mapping[str, Fit], synthetic: Mapping[float, list[Fit]]) -> str:
    groups = [*([f] for f in fits.values()), *synthetic.values()]
    head = ["", *fits, *(f"{len(f)} cars, {name}" for name, f in _named(synthetic).items())]
    cases = list(groups[0][0].misfit)
    rows = [_line(f"misfit, {c}", groups, lambda f, c=c: f.misfit[c]) for c in cases]  # type: ignore[misc]
    rows.append(_line("visible parameters", groups, lambda f: sum(f.visible)))
    inside = [f"{sum(f.inside for f in g)} of {sum(int(f.judged.sum()) for f in g)}" for g in groups]
    rows.append(["visible within 2 sd", *inside])
    rows.append(_line("evaluations", groups, lambda f: f.evaluations))
    rows.append(_line("seconds", groups, lambda f: f.seconds))
    return table(head, rows)


def _line(name: str, groups: Sequence[Sequence[Fit]], value: Callable[[Fit], float]) -> list[str]:
    cells = [number(value(g[0])) if len(g) == 1 else spread([value(f) for f in g], 2) for g in groups]
    return [name, *cells]
