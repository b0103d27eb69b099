"""Designs of 72 variables beside scipy, SMT and pyDOE."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from importlib import import_module

from _common import machine, publish

import numpy as np  # isort: skip  # after the thread limits
from scipy.spatial.distance import pdist
from scipy.stats import qmc

from doe_kc.ground.typing import FloatArray
from doe_kc.sampling.maximin import more_slices, spread_hypercube

VARIABLES = 72
SIZES = (50, 100, 200)
SEED = 1
SMT_MOST = 100
"""Designs above which SMT's ESE takes a minute."""


def own(n: int) -> FloatArray:
    rng = np.random.default_rng(SEED)
    return spread_hypercube(more_slices(np.zeros((0, VARIABLES)), n, rng), rng)


def scipy_lhs(n: int, optimization: str | None) -> FloatArray:
    rng = np.random.default_rng(SEED)
    return np.asarray(qmc.LatinHypercube(VARIABLES, rng=rng, optimization=optimization).random(n))


def smt_ese(n: int) -> FloatArray:
    limits = np.tile([0.0, 1.0], (VARIABLES, 1))
    return np.asarray(
        import_module("smt.sampling_methods").LHS(xlimits=limits, criterion="ese", seed=SEED)(n)
    )


def pydoe_maximin(n: int) -> FloatArray:
    return np.asarray(import_module("pydoe").lhs(VARIABLES, samples=n, criterion="maximin"))


METHODS: dict[str, Callable[[int], FloatArray]] = {
    "doe-kc lhs": own,
    "scipy lhs": lambda n: scipy_lhs(n, None),
    "scipy lhs, random-cd": lambda n: scipy_lhs(n, "random-cd"),
    "SMT lhs, ese": smt_ese,
    "pyDOE lhs, maximin": pydoe_maximin,
}


def row(name: str, n: int) -> str:
    started = time.process_time()
    x = METHODS[name](n)
    seconds = time.process_time() - started
    correlation = np.abs(np.corrcoef(x.T) - np.eye(VARIABLES)).max()
    pairs = [pdist(x[:, [k, k + 1]]).min() for k in range(0, VARIABLES, 2)]
    return (
        f"| {name} | {n} | {pdist(x).min():.3f} | {qmc.discrepancy(x, method='CD'):.4g} | "
        f"{correlation:.3f} | {np.mean(pairs):.4f} | {seconds:.2f} |"
    )


def main() -> None:
    lines = []
    for n in SIZES:
        for name in METHODS:
            if name == "SMT lhs, ese" and n > SMT_MOST:
                continue
            lines.append(row(name, n))
            sys.stderr.write(lines[-1] + "\n")
    publish(
        "sampling",
        [
            "# Designs",
            "",
            f"{VARIABLES} variables in the unit cube, seed {SEED}. Largest smallest distance and discrepancy "
            "over all variables, the largest correlation of two, smallest distance in planes of two "
            f"neighbouring variables in the mean, seconds of a processor. One thread. {machine()}.",
            "",
            "| method | designs | smallest distance | centred discrepancy | correlation | planes | seconds |",
            "|---|---|---|---|---|---|---|",
            *lines,
        ],
    )


if __name__ == "__main__":
    main()
