"""How many axles have an equilibrium in every load case, and whether coarse steps ever hide a snap."""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from _common import example_axle, machine, publish

from doe_kc.axle import Axle, parameter_value, with_values
from doe_kc.axle.model import HARDPOINTS
from doe_kc.axle_file import read_axle
from doe_kc.campaign.processes import available_cores
from doe_kc.campaign.runner import Campaign
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.sampling import sample
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import VariableOptions, build_space

FINER = 8
"""Steps of the fine path over the default ones."""
SCATTER = (
    "Axles whose every hardpoint coordinate is scattered evenly, far beyond what any design keeps to;",
    "steering to +-60 mm of rack. Many fold over: the tie rod comes in line with the steer arm. Each is",
    f"solved with the default steps and with {FINER} times as many. A silent jump is a load case that the",
    "default steps report and the fine ones do not, or not so (toe, camber to 1e-4 deg, wheel centre to",
    "1e-3 mm). False ends are of load cases that fine steps get through.",
)
SAME = {"toe": 1e-4, "camber": 1e-4, "wc_x": 1e-3, "wc_y": 1e-3, "wc_z": 1e-3}
"""deg, mm; results of both that are farther apart are of different paths."""


def scattered(axle: Axle, size: float, seed: int) -> Axle:
    """Every hardpoint coordinate moved by at most `size` mm, the sides alike."""
    rng = np.random.default_rng(seed)
    paths = [f"{name}.{axis}" for name in HARDPOINTS if name not in axle.follow for axis in "xyz"]
    return with_values(axle, {p: parameter_value(axle, p) + rng.uniform(-size, size) for p in paths})


def with_finer_steps(axle: Axle, factor: int) -> Axle:
    cases = {ident: replace(case, steps=case.steps * factor) for ident, case in axle.load_cases.items()}
    return replace(axle, load_cases=cases)


def differences(coarse: Solution, fine: Solution) -> Iterator[str]:
    """Load cases that coarse steps report and fine ones do not, or not so: silent jumps."""
    for ident, case in coarse.cases.items():
        if ident not in fine.cases:
            yield f"{ident}: reported, though {fine.failure}"
            return
        for a, b in zip(case.branches, fine.cases[ident].branches, strict=True):
            for name, limit in SAME.items():
                columns = [coarse.column(f"{name}@{side}") for side in "LR"]
                apart = np.abs(a.y[:, columns] - b.y[::FINER, columns]).max()
                if apart > limit:
                    yield f"{ident}, branch {a.name}: {name} {apart:.3g} from the fine path"


def continuity(axle: Axle, n: int, size: float) -> list[str]:
    """Lines on n axles with their hardpoints scattered, coarse steps against fine ones."""
    jumps: list[str] = []
    ends: Counter[str] = Counter()
    stricter, seconds = 0, 0.0
    for seed in range(n):
        one = scattered(axle, size, seed)
        started = time.process_time()
        coarse = solve(one, throw=False)
        seconds += time.process_time() - started
        fine = solve(with_finer_steps(one, FINER), throw=False)
        jumps += [f"- axle {seed}: {text}" for text in differences(coarse, fine)]
        if coarse.failure is not None:
            ends[f"{coarse.failure.load_case}, {coarse.failure.cause.split(':')[0]}"] += 1
            stricter += fine.failure is None or len(fine.cases) > len(coarse.cases)
    return [
        f"| +-{size:g} mm | {n} | {n - ends.total()} | **{len(jumps)}** | {stricter} | "
        f"{1e3 * seconds / n:.1f} ms | {'; '.join(f'{c} x {e}' for e, c in ends.most_common(6))} |",
        *jumps,
    ]


def default_bounds(n: int, seed: int) -> list[str]:
    """Lines on a Latin hypercube over all default bounds."""
    axle = example_axle()
    space = build_space(axle, VariableOptions(levels="continuous"), "benchmark")
    design = sample(space, n, seed=seed)
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder, Campaign(AxleSolver(axle), Path(folder, "s")) as campaign:
        results = campaign.evaluate(list(design.rows()), "benchmark", curves=False)
    seconds = time.perf_counter() - started
    failed = Counter(o.reason for o in results if o.failed)
    share = 100.0 * (1 - sum(failed.values()) / n)
    return [
        f"{n} Latin-hypercube designs (seed {seed}) over the default bounds of "
        f"{space.dimension} parameters, all eight load cases in both directions.",
        "",
        f"- converged: {share:.3f} % ({sum(failed.values())} failures)",
        f"- {seconds:.1f} s over {available_cores()} processes, "
        f"{1e3 * seconds / n:.1f} ms a design ({machine()})",
        "",
        *[f"- {count} x {reason}" for reason, count in failed.most_common(20)],
    ]


def over_bounds(axle_type: str, n: int, compared: int, seed: int) -> list[str]:
    """A row on a Latin hypercube over a type's default bounds; `compared` of its designs with fine steps."""
    axle = read_axle(example_folder(axle_type) / "axle.toml")
    space = build_space(axle, VariableOptions(levels="continuous"), "benchmark")
    rows = list(sample(space, n, seed=seed).rows())
    failed: Counter[str] = Counter()
    jumps: list[str] = []
    seconds = 0.0
    for i, row in enumerate(rows):
        one = with_values(axle, row)
        started = time.process_time()
        coarse = solve(one, throw=False)
        seconds += time.process_time() - started
        if coarse.failure is not None:
            failed[f"{coarse.failure.load_case}, {coarse.failure.cause.split(':')[0]}"] += 1
        if i < compared:
            fine = solve(with_finer_steps(one, FINER), throw=False)
            jumps += [f"- {axle_type}, design {i}: {text}" for text in differences(coarse, fine)]
    share = 100.0 * (1 - failed.total() / n)
    ends = "; ".join(f"{c} x {e}" for e, c in failed.most_common(4)) or "–"
    return [
        f"| {axle_type} | {space.dimension} | {n} | {share:.2f} % | {compared} | **{len(jumps)}** | "
        f"{1e3 * seconds / n:.1f} ms | {ends} |",
        *jumps,
    ]


def types_report(n: int, compared: int, seed: int) -> list[str]:
    """Of every axle type that the package describes."""
    lines = [
        "# Robustness of axle types",
        "",
        f"Latin-hypercube designs (seed {seed}) over the default bounds of all parameters of each type's",
        "example, all load cases in both directions, compiled, one process. A silent jump is a load case",
        f"that the default steps report and {FINER} times as many do not, or not so ({machine()}).",
        "",
        "| type | parameters | designs | converged | with fine steps | silent jumps | CPU a design | ends |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for axle_type in EXAMPLE_TYPES:
        lines += over_bounds(axle_type, n, compared, seed)
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--types", action="store_true", help="of every axle type instead of the McPherson")
    parser.add_argument("--compared", type=int, default=200, help="designs of a type solved with fine steps")
    parser.add_argument("-n", type=int, default=10_000, help="designs over the default bounds")
    parser.add_argument("--scattered", type=int, default=1000, help="axles of either hardpoint scatter")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    if arguments.types:
        publish("robustness_types", types_report(arguments.n, arguments.compared, arguments.seed))
        return
    axle = example_axle()
    publish(
        "robustness",
        [
            "# Robustness",
            "",
            *default_bounds(arguments.n, arguments.seed),
            "## One path, whatever the steps",
            "",
            *SCATTER,
            "",
            "| scatter | axles | all load cases solved | silent jumps | false ends | CPU an axle | ends |",
            "|---|---|---|---|---|---|---|",
            *continuity(axle, arguments.scattered, 60.0),
            *continuity(axle, arguments.scattered, 20.0),
        ],
    )


if __name__ == "__main__":
    main()
