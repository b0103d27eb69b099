"""Latin hypercube over all default bounds: how many axles have an equilibrium in every load case."""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from pathlib import Path

from _common import example_axle, machine, publish

from doe_kc.campaign.processes import available_cores
from doe_kc.campaign.runner import Campaign
from doe_kc.sampling import sample
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import VariableOptions, build_space


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-n", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    axle = example_axle()
    space = build_space(axle, VariableOptions(levels="continuous"), "benchmark")
    design = sample(space, arguments.n, seed=arguments.seed)
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder, Campaign(AxleSolver(axle), Path(folder, "s")) as campaign:
        results = campaign.evaluate(list(design.rows()), "benchmark", curves=False)
    seconds = time.perf_counter() - started
    failed = Counter(o.reason for o in results if o.failed)
    share = 100.0 * (1 - sum(failed.values()) / arguments.n)
    publish(
        "robustness",
        [
            "# Robustness",
            "",
            f"{arguments.n} Latin-hypercube designs (seed {arguments.seed}) over the default bounds of "
            f"{space.dimension} parameters, all eight load cases in both directions.",
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
