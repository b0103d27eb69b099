"""Latin hypercube over all default bounds: how many axles have an equilibrium in every load case."""

from __future__ import annotations

import argparse
import time
from collections import Counter

from _common import example_axle, machine, publish

from doe_kc.axle import design_parameters
from doe_kc.sampling.batch import available_cores, evaluate_all
from doe_kc.sampling.latin_hypercube import latin_hypercube


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-n", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    axle = example_axle()
    parameters = [p for p in design_parameters(axle) if p.active]
    design = latin_hypercube(parameters, arguments.n, seed=arguments.seed)
    started = time.perf_counter()
    results = evaluate_all(axle, list(design.rows()))
    seconds = time.perf_counter() - started
    failed = Counter(e.reason for e in results if e.reason)
    share = 100.0 * (1 - sum(failed.values()) / arguments.n)
    publish(
        "robustness",
        [
            "# Robustness",
            "",
            f"{arguments.n} Latin-hypercube designs (seed {arguments.seed}) over the default bounds of "
            f"{len(parameters)} parameters, all eight load cases in both directions.",
            "",
            f"- converged: {share:.3f} % ({sum(failed.values())} failures)",
            f"- {seconds:.1f} s over {available_cores()} processes, "
            f"{1e3 * seconds / arguments.n:.1f} ms a design ({machine()})",
            "",
            *[f"- {count} x {reason}" for reason, count in failed.most_common(20)],
        ],
    )


if __name__ == "__main__":
    main()
