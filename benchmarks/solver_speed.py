"""Speed of the whole suite on one core: compiled, interpreted, first call, sensitivities, two processes.

Also what a user would pick instead: each equilibrium handed to scipy's general root finder with the same
exact Jacobian, started from the last equilibrium.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

import numpy as np
from _common import compile_now, example_axle, machine, publish
from scipy.optimize import root

from doe_kc.axle import Axle
from doe_kc.axle.parameters import settable_paths
from doe_kc.campaign.runner import Campaign
from doe_kc.characteristics import reduce_all
from doe_kc.effects import apply_effect
from doe_kc.sampling import sample
from doe_kc.solver.compiled import adaptive_kernel
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.equilibria import March
from doe_kc.solver.kernel import Buffered, kernel
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.sensitivity import sensitivities
from doe_kc.solver.static import static_state
from doe_kc.solver.suite import library_for, solve
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import VariableOptions, build_space

FIRST_CALL = """
import time
started = time.perf_counter()
from benchmarks._common import example_axle
from doe_kc.solver.suite import solve
solve(example_axle())
print(time.perf_counter() - started)
"""


def median_ms(run: Callable[[], object], repeats: int) -> float:
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        run()
        times.append(1e3 * (time.perf_counter() - started))
    return statistics.median(times)


def campaign(axle: Axle, designs: list[dict[str, float]], workers: int) -> None:
    """Every design solved, reduced and stored in memory."""
    with Campaign(AxleSolver(axle), workers=workers) as running:
        running.evaluate(designs, "benchmark", curves=False)


def function_us(name: str) -> float:
    """One interpreted evaluation of a kernel function, microseconds."""
    k = kernel(example_axle().topology)
    f = Buffered(k.functions[name])
    c = k.constant_values(dict(example_axle().values))
    x, u, z = np.zeros(k.nx), np.zeros(k.nu), np.zeros(k.nz)
    x[k.index("preload")] = 4500.0
    return 1e3 * median_ms(lambda: [f(x, c, u, z) for _ in range(50)], 11) / 50


def first_call_seconds() -> float:
    with tempfile.TemporaryDirectory() as empty:
        done = subprocess.run(
            [sys.executable, "-c", FIRST_CALL],
            env={**os.environ, "DOE_KC_CACHE": empty, "PYTHONPATH": os.pathsep.join(sys.path)},
            capture_output=True,
            text=True,
            check=True,
        )
    return float(done.stdout)


def time_by_part() -> list[str]:
    """Where a compiled design's time goes, ms."""
    axle, settings = example_axle(), NewtonSettings()
    k, library = kernel(axle.topology), library_for(axle.topology, True)
    values = dict(axle.values)
    c = k.constant_values(values)
    static = static_state(k, library, c, axle, settings)
    out = [f"constants {median_ms(lambda: k.constant_values(values), 31):.2f}"]
    out.append(f"static {median_ms(lambda: static_state(k, library, c, axle, settings), 31):.2f}")
    for case in axle.load_cases:
        alone = median_ms(lambda case=case: solve(axle, [case], compiled=True), 31)
        out.append(f"{case} {alone:.2f}")
    assert not isinstance(static, March)
    return [
        "- compiled, ms by part (a load case alone includes constants and static state): " + ", ".join(out)
    ]


def scipy_seconds() -> float:
    """The same equilibria by scipy.optimize.root (hybr) with the exact Jacobian."""
    axle = example_axle()
    k, solution = kernel(axle.topology), solve(axle)
    c = k.constant_values(dict(axle.values))
    residual, jacobian = Buffered(k.functions["residual"]), Buffered(k.functions["jacobian"])
    z, scale = np.zeros(0), k.scale

    def fun(x: np.ndarray, u: np.ndarray) -> np.ndarray:
        return residual(x, c, u, z) / scale

    def jac(x: np.ndarray, u: np.ndarray) -> np.ndarray:
        out = np.zeros((k.nx, k.nx))
        out[k.rows, k.cols] = jacobian(x, c, u, z) / scale[k.rows]
        return out

    started = time.perf_counter()
    for case in solution.cases.values():
        for branch in case.branches:
            x = branch.x[0]
            for u, expected in zip(branch.u[1:], branch.x[1:], strict=True):
                x = root(fun, x, args=(u,), jac=jac, tol=1e-12).x
                assert np.abs(x - expected).max() < 1e-5
    return time.perf_counter() - started


def main() -> None:
    axle = example_axle()
    solution = solve(axle)
    counts, n = solution.counts, solution.equilibria
    programs = median_ms(lambda: solve(axle), 31)
    by_programs = not adaptive_kernel(axle.topology).compiled
    compiled = median_ms(lambda: solve(axle, compiled=True), 31)
    interpreted = median_ms(lambda: solve(axle, compiled=False), 11)
    compile_now(axle.topology)
    reduce_ms = median_ms(lambda: reduce_all(curve_set(solution)), 31)
    paths = settable_paths(axle)
    sensitivities(axle, solution, paths)
    exact = median_ms(lambda: sensitivities(axle, solution, paths), 5)
    rubbing = apply_effect(axle, "steering_friction", {}, source="benchmark")
    rubbing = apply_effect(rubbing, "strut_friction", {}, source="benchmark")
    compile_now(rubbing.topology)
    looped, loop_paths = solve(rubbing), settable_paths(rubbing)
    along = median_ms(lambda: sensitivities(rubbing, looped, loop_paths), 5)
    rows = list(sample(build_space(axle, VariableOptions(), "benchmark"), 400, seed=3).rows())
    batch = {w: median_ms(lambda w=w: campaign(axle, rows, w), 1) / len(rows) for w in (1, 2)}
    scipy = 1e3 * scipy_seconds()
    publish(
        "solver_speed",
        [
            "# Speed",
            "",
            f"Whole suite of the example axle: 8 load cases, both directions, {n} equilibria. {machine()}.",
            "",
            "| | ms a design | equilibria/s | wanted |",
            "|---|---|---|---|",
            f"| compiled kernels, one core | {compiled:.1f} | {1e3 * n / compiled:.0f} | 30 ms |",
            *(
                [f"| programs, one core | {programs:.1f} | {1e3 * n / programs:.0f} | |"]
                if by_programs
                else []
            ),
            f"| interpreted, one core | {interpreted:.1f} | {1e3 * n / interpreted:.0f} | 300 ms |",
            f"| scipy.optimize.root, same exact Jacobian, interpreted | {scipy:.0f} "
            f"| {1e3 * n / scipy:.0f} | {scipy / interpreted:.1f} x slower than interpreted |",
            f"| exact sensitivities of all outputs to {len(paths)} parameters | {exact:.0f} | | 1000 ms |",
            f"| the same along the loops of an axle with steering and strut friction, {looped.equilibria} "
            f"equilibria | {along:.0f} | | 1000 ms |",
            f"| batch with characteristics, 1 process | {batch[1]:.1f} | | |",
            f"| batch with characteristics, 2 processes | {batch[2]:.1f} | | {batch[1] / batch[2]:.2f} x |",
            "",
            f"- per equilibrium: {counts[3] / n:.2f} Newton steps, {counts[0] / n:.2f} residuals, "
            f"{counts[1] / n:.2f} Jacobians and factorizations",
            f"- interpreted evaluations: residual {function_us('residual'):.1f} us, "
            f"Jacobian {function_us('jacobian'):.1f} us, outputs {function_us('outputs'):.1f} us",
            *time_by_part(),
            f"- reduction of curves to {len(reduce_all(curve_set(solution)))} characteristics: "
            f"{reduce_ms:.1f} ms",
            f"- first call on a new machine, import, assembly and programs included: "
            f"{first_call_seconds():.1f} s (wanted: below 10 s)",
        ],
    )


if __name__ == "__main__":
    main()
