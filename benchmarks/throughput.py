"""CPU time of a suite and of exact sensitivities for every axle type, and of designs in a campaign.

Minima and ratios: they hold on a machine that does other things too.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import get_args

import numpy as np
from _common import compile_now, machine, publish

from doe_kc.axle import Axle, design_parameters
from doe_kc.axle.parameters import ParameterMap, settable_paths, switched_topology
from doe_kc.axle_file import read_axle
from doe_kc.campaign.record import StoredCurves
from doe_kc.campaign.runner import Campaign
from doe_kc.effects import apply_effect
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.sampling import sample
from doe_kc.solver.batch_library import batch_library
from doe_kc.solver.batch_suite import solve_batch
from doe_kc.solver.instructions import own_instruction_set
from doe_kc.solver.sensitivity import sensitivities
from doe_kc.solver.suite import solve
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import VariableOptions, build_space

REPEATS = 9
DESIGNS = 2000
SIDE_BY_SIDE = 64
"""Designs of a batch."""
CAMPAIGN_TYPES = ("mcpherson_front", "five_link_rear")
FRICTION = ("steering_friction", "strut_friction")
MOST_SUITES = 12.0
SCALED = (1, 2, 4)
"""Dask workers on this machine."""
CLUSTER_SIZES = (2, 4, 8, 16, 32, 64)
WARM_UP = 256
"""Designs with which workers load the package and its kernels."""


def least_ms(run: Callable[[], object], repeats: int = REPEATS) -> float:
    """Smallest CPU time of this process, ms, after one run that compiles."""
    run()
    times = []
    for _ in range(repeats):
        started = time.process_time()
        run()
        times.append(1e3 * (time.process_time() - started))
    return min(times)


def sensitivity_row(name: str, axle: Axle) -> str:
    solution, every = solve(axle), settable_paths(axle)
    for topology in {axle.topology, *(switched_topology(axle, path) for path in every)}:
        compile_now(topology)
    own = [p.path for p in design_parameters(axle)]
    suite = least_ms(partial(solve, axle))
    all_ms, own_ms = (least_ms(partial(sensitivities, axle, solution, p), 5) for p in (every, own))
    cells = [
        *(name, str(solution.equilibria), f"{suite:.1f}"),
        *(str(len(every)), f"{all_ms:.0f}", f"{all_ms / suite:.1f}"),
        *(str(len(own)), f"{own_ms:.0f}", f"{own_ms / suite:.1f}"),
    ]
    return f"| {' | '.join(cells)} |"


def batch_row(name: str, axle: Axle) -> str:
    """Solved alone and side by side, the same designs in the same minute."""
    space = build_space(axle, VariableOptions(levels="continuous"), "benchmark")
    design = sample(space, SIDE_BY_SIDE, seed=3, method="sobol")
    parameters = ParameterMap(axle, design.paths)
    kept = [row for row in design.values if parameters.axle(list(row)).topology == axle.topology]
    axles = [parameters.axle(list(row)) for row in kept]
    changes, library = parameters.changes(np.array(kept)), batch_library(axle.topology)
    alone = least_ms(lambda: [solve(each, throw=False) for each in axles], 5) / len(axles)
    found = solve_batch(axle, changes, library)
    batch = least_ms(partial(solve_batch, axle, changes, library), 5) / len(axles)
    cells = (
        name,
        f"{alone:.2f}",
        f"{batch:.2f}",
        f"{alone / batch:.1f}",
        f"{found.failed.sum()} of {len(axles)}",
    )
    return f"| {' | '.join(cells)} |"


def cpu_seconds() -> float:
    """Of this process and of those that have ended."""
    t = os.times()
    return t.user + t.system + t.children_user + t.children_system


def campaign_row(name: str, axle: Axle, kept: StoredCurves) -> str:
    space = build_space(axle, VariableOptions(levels="continuous"), "benchmark")
    designs = list(sample(space, DESIGNS, seed=3, method="sobol").rows())
    rows = []
    for _ in range(3):
        with tempfile.TemporaryDirectory() as folder:
            path, before, started = Path(folder) / "store", cpu_seconds(), time.perf_counter()
            with Campaign(AxleSolver(axle), path, workers=2, stored_curves=kept) as campaign:
                campaign.evaluate(designs, "benchmark", curves=False)
            wall = time.perf_counter() - started
            size = path.stat().st_size / DESIGNS / 1e3
            rows.append((1e3 * (cpu_seconds() - before) / DESIGNS, 1e3 * wall / DESIGNS, size))
    used, wall, size = min(rows)
    return f"| {name} | {kept} | {used:.2f} | {wall:.2f} | {size:.1f} |"


@dataclass(frozen=True)
class Scaling:
    """A campaign on Dask workers.

    wall: ms a design. own: CPU ms a design of the process that asks and stores, the scheduler in it. theirs:
    CPU ms a design of the workers together.
    """

    workers: int
    wall: float
    own: float
    theirs: float

    def rate(self, workers: int) -> float:
        """Designs a second of workers that have a core each: all of them busy, or the asking process."""
        return 1e3 * min(workers / self.theirs, 1.0 / self.own)


def scaling(axle: Axle, workers: int) -> Scaling:
    """Of designs with their characteristics alone, after some that start the workers."""
    from distributed import Client, LocalCluster

    space = build_space(axle, VariableOptions(levels="continuous"), "benchmark")
    designs = list(sample(space, DESIGNS + WARM_UP, seed=3, method="sobol").rows())
    options = {"n_workers": workers, "threads_per_worker": 1, "dashboard_address": None}
    with (
        LocalCluster(**options) as cluster,
        Client(cluster) as client,
        Campaign(AxleSolver(axle), scheduler=cluster.scheduler_address, stored_curves="none") as campaign,
    ):
        campaign.evaluate(designs[:WARM_UP], "warm up", curves=False)
        theirs = sum(client.run(time.process_time).values())
        own, wall = time.process_time(), time.perf_counter()
        campaign.evaluate(designs[WARM_UP:], "benchmark", curves=False)
        wall, own = time.perf_counter() - wall, time.process_time() - own
        theirs = sum(client.run(time.process_time).values()) - theirs
    return Scaling(workers, *(1e3 * seconds / DESIGNS for seconds in (wall, own, theirs)))


def scaling_lines(runs: Sequence[Scaling]) -> list[str]:
    """What was measured, and what a cluster would give."""
    least = min(runs, key=lambda r: r.own + r.theirs)
    cells = [
        f"| {r.workers} | {r.wall:.2f} | {runs[0].wall / r.wall:.2f} | {r.own:.2f} | {r.theirs:.2f} |"
        for r in runs
    ]
    share = 100.0 * least.own / (least.own + least.theirs)
    return [
        f"{DESIGNS} designs of {CAMPAIGN_TYPES[0]}, characteristics alone, on Dask workers of this machine, "
        f"which has {os.cpu_count()} cores: more workers share them, and other work on the machine lengthens "
        "wall times. The scheduler is in the asking process:",
        "",
        "| workers | wall ms a design | times one worker | CPU ms, asking process | CPU ms, workers |",
        "|---|---|---|---|---|",
        *cells,
        "",
        f"{share:.0f} % of the work is serial: naming designs, sending, storing, the scheduler. What a "
        "cluster would give with such a core for every worker and one for the asking process, by the least "
        "CPU times above (an estimate; the network is not in it):",
        "",
        "| workers | designs a second | 10,000 designs |",
        "|---|---|---|",
        *(f"| {n} | {least.rate(n):.0f} | {1e4 / least.rate(n):.1f} s |" for n in CLUSTER_SIZES),
    ]


def main() -> None:
    axles = {t: read_axle(example_folder(t) / "axle.toml") for t in EXAMPLE_TYPES}
    rubbing = axles["mcpherson_front"]
    for effect in FRICTION:
        rubbing = apply_effect(rubbing, effect, {}, source="benchmark")
    soft = apply_effect(rubbing, "rubber_hysteresis", {}, source="benchmark")
    further = {"mcpherson_front, two frictions": rubbing, "the same, rubber with hysteresis": soft}
    sensitivity = [sensitivity_row(name, axle) for name, axle in (axles | further).items()]
    batches = [batch_row(name, axle) for name, axle in axles.items()]
    campaigns = [
        campaign_row(name, axles[name], kept) for name in CAMPAIGN_TYPES for kept in get_args(StoredCurves)
    ]
    runs = [scaling(axles[CAMPAIGN_TYPES[0]], workers) for workers in SCALED]
    publish(
        "throughput",
        [
            "# Throughput",
            "",
            f"Compiled kernels, all load cases of each type's example, least CPU time of {REPEATS} runs. "
            f"{machine()}; load average {os.getloadavg()[1]:.0f} in the five minutes before.",
            "",
            f"Exact sensitivities of all outputs in all equilibria (wanted: at most {MOST_SUITES:g} suites):",
            "",
            "| axle | equilibria | suite, ms | all parameters | ms | suites | of the design | ms | suites |",
            "|---|---|---|---|---|---|---|---|---|",
            *sensitivity,
            "",
            f"Suites of {SIDE_BY_SIDE} designs over the default bounds, each alone and side by side in "
            f"{own_instruction_set().lanes} lanes (wanted: 1 ms in a batch), CPU ms a design; handed on: "
            "what has no solution side by side and is solved alone again:",
            "",
            "| axle | alone | side by side | ratio | handed on |",
            "|---|---|---|---|---|",
            *batches,
            "",
            f"Campaigns of {DESIGNS} designs over the default bounds, two processes: solved, reduced, "
            "checked and stored, least of three (wanted on two idle cores: 10,000 in 8 s, with curves in "
            "14 s, that is 1.6 and 2.8 ms of CPU):",
            "",
            "| axle | curves stored | CPU ms a design | wall ms a design | kB a design |",
            "|---|---|---|---|---|",
            *campaigns,
            "",
            *scaling_lines(runs),
        ],
    )


if __name__ == "__main__":
    main()
