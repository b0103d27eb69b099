"""What the intervals of the choice cover on separate designs, for three axle types.

`python benchmarks/surrogate_coverage.py`, one thread, six minutes.
"""

from __future__ import annotations

import sys
import time

from _common import ROOT, machine, publish

import numpy as np  # isort: skip  # after the thread limits
from scipy.stats import qmc

from doe_kc.axle_file import read_axle
from doe_kc.campaign.runner import Campaign
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.calibration import widening
from doe_kc.surrogate_models.study import SurrogateStudy, fit_study
from doe_kc.surrogate_models.training import constant_outputs
from doe_kc.surrogate_models.validation import NOMINAL, NOMINAL_WIDTH
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import VariableOptions, build_space

AXLES = ("front_axle", "double_wishbone_front", "five_link_rear")
SETS = {50: (21, 22, 23), 100: (21, 22), 200: (21,)}
"""Designs -> seeds; neither they nor the tests were used to choose any constant."""
TESTS, TEST_SEED = 500, 299
GOAL = 0.03
HEAD = (
    "| axle | variables | designs | sets | error | coverage | within ± 3 % | lowest | limits hold | "
    "independent errors: within | lowest | seconds |"
)


Sets = dict[tuple[int, int], tuple[FloatArray, FloatArray]]


def evaluated(name: str) -> tuple[Sets, FloatArray, FloatArray]:
    """(designs, seed) -> x, y, and x, y of the tests; characteristics that an axle has, and that change."""
    axle = read_axle(ROOT / "examples" / name / "axle.toml")
    space = build_space(axle, VariableOptions(), "benchmark")
    with Campaign(AxleSolver(axle, {}), workers=1) as campaign:

        def values(x: FloatArray) -> FloatArray:
            outcomes = campaign.evaluate([space.values(u) for u in x], "benchmark", curves=False)
            return np.array([o.characteristics for o in outcomes])

        def hypercube(n: int, seed: int) -> FloatArray:
            return np.asarray(qmc.LatinHypercube(space.dimension, rng=np.random.default_rng(seed)).random(n))

        test = hypercube(TESTS, TEST_SEED)
        true = values(test)
        known = np.isfinite(true).all(axis=0)
        known[known] = ~constant_outputs(true[:, known])
        sets = {(n, s): hypercube(n, s) for n, seeds in SETS.items() for s in seeds}
        return {key: (x, values(x)[:, known]) for key, x in sets.items()}, test, true[:, known]


def covered(
    study: SurrogateStudy, test: FloatArray, true: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(m,) error, coverage on the tests, and what a scale from n of the tests covers of the others."""
    model, n = study.model, len(study.x)
    missed, variance = true - model.predict(test), model.variance(test)
    error = np.sqrt(np.square(missed).mean(axis=0) / true.var(axis=0))
    ratio = np.square(missed) / variance
    scale = ratio[:n].mean(axis=0) * np.exp((NOMINAL_WIDTH**2 - 1.0) / (2.0 * n))
    share = (ratio[n:] <= NOMINAL_WIDTH**2 * scale).mean(axis=0)
    return error, (ratio <= NOMINAL_WIDTH**2).mean(axis=0), share


def main() -> None:
    lines = [HEAD, "|---" * 12 + "|"]
    for name in AXLES:
        designs, test, true = evaluated(name)
        for n, seeds in SETS.items():
            found, held, seconds = [], [], []
            for seed in seeds:
                started = time.process_time()
                study = fit_study(*designs[n, seed], workers=1)
                seconds.append(time.process_time() - started)
                found.append(covered(study, test, true))
                low, high = (
                    study.of_chosen({k: j.limits[i] for k, j in study.models.items()}) for i in (0, 1)
                )
                held.append((low <= found[-1][1]) & (found[-1][1] <= high))
            error, share, ideal = (np.array(parts) for parts in zip(*found, strict=True))
            within, best = ((np.abs(s - NOMINAL) <= GOAL).mean() for s in (share, ideal))
            lines.append(
                f"| {name} | {test.shape[1]} | {n} | {len(seeds)} | {error.mean():.4f} | "
                f"{share.mean():.3f} | "
                f"{within:.2f} | {share.min():.2f} | {np.mean(held):.2f} | {best:.2f} | {ideal.min():.2f} | "
                f"{np.mean(seconds):.1f} |"
            )
            sys.stderr.write(lines[-1] + "\n")
    widths = ", ".join(f"{widening(n):.3f} at {n}" for n in SETS)
    publish(
        "surrogate_coverage",
        [
            "# Coverage of the printed intervals",
            "",
            f"`python benchmarks/surrogate_coverage.py`. The choice among the default models without slopes, "
            f"fitted to plain Latin hypercubes; its 95 % intervals on {TESTS} separate designs. Error: mean "
            "over the characteristics of sqrt(1 - Q2) there. Within: share of the characteristics with a "
            "coverage of 0.95 ± 0.03; lowest: of a single one of any set. Limits hold: share whose coverage "
            "is between the limits printed beside it. Independent errors: the same where the scale of each "
            "interval comes from as many of the separate designs as there are designs, which nobody has: "
            "what errors that share nothing with the model could do. Seconds of a processor, "
            f"cross-validation included. Intervals are widened by {widths} for their scale's uncertainty. "
            f"One thread, niced, much other work on the machine. {machine()}.",
            "",
            *lines,
        ],
    )


if __name__ == "__main__":
    main()
