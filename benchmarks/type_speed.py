"""Speed of every axle type: CPU time a design against the number of unknowns, and the first call."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time

from _common import machine, publish

from doe_kc.axle import with_values
from doe_kc.axle_file import read_axle
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.sampling import sample
from doe_kc.solver.kernel import kernel
from doe_kc.solver.suite import solve
from doe_kc.variables import VariableOptions, build_space

DESIGNS = 60
WANTED_MS = {"mcpherson_front": 5.1, "five_link_rear": 20.0}
OTHERS_MS, FIRST_CALL_S = 8.0, 10.0
FIRST_CALL = """
import sys, time
started = time.perf_counter()
from pathlib import Path
from doe_kc.axle_file import read_axle
from doe_kc.solver.suite import solve
solve(read_axle(Path(sys.argv[1])))
print(time.perf_counter() - started)
"""


def first_call_seconds(axle_type: str) -> tuple[float, float]:
    """(wall, CPU) seconds of import, assembly, programs and solving in an empty cache."""
    before = os.times()
    with tempfile.TemporaryDirectory() as empty:
        done = subprocess.run(
            [sys.executable, "-c", FIRST_CALL, str(example_folder(axle_type) / "axle.toml")],
            env={**os.environ, "DOE_KC_CACHE": empty, "PYTHONPATH": os.pathsep.join(sys.path)},
            capture_output=True,
            text=True,
            check=True,
        )
    after = os.times()
    used = after.children_user - before.children_user + after.children_system - before.children_system
    return float(done.stdout), used


def design_ms(axle_type: str) -> tuple[int, int, float]:
    """(unknowns, equilibria, median CPU ms of designs over the default bounds)."""
    axle = read_axle(example_folder(axle_type) / "axle.toml")
    space = build_space(axle, VariableOptions(levels="continuous"), "benchmark")
    designs = [with_values(axle, row) for row in sample(space, DESIGNS, seed=2).rows()]
    solution, times = solve(axle, compiled=True), []
    for design in designs:
        started = time.process_time()
        solve(design, compiled=True)
        times.append(1e3 * (time.process_time() - started))
    return kernel(axle.topology).nx, solution.equilibria, statistics.median(times)


def main() -> None:
    rows = []
    for axle_type in EXAMPLE_TYPES:
        wall, used = first_call_seconds(axle_type)
        rows.append((axle_type, *design_ms(axle_type), wall, used))
    unit = next(ms / WANTED_MS[name] for name, _, _, ms, _, _ in rows if name == "mcpherson_front")
    publish(
        "type_speed",
        [
            "# Speed of axle types",
            "",
            f"{DESIGNS} designs over the default bounds of each type's example, all load cases in both",
            f"directions, compiled kernels, one core, median CPU time. {machine()}. The goals are",
            f"of a machine that takes {WANTED_MS['mcpherson_front']} ms for the McPherson; this one took "
            f"{unit:.2f} times as long,",
            "and `in goals` is the time over the goal on the same footing.",
            "",
            "| type | unknowns | equilibria | ms a design | us an equilibrium | goal, ms | in goals "
            "| first call, s | of it CPU, s |",
            "|---|---|---|---|---|---|---|---|---|",
            *(
                f"| {name} | {nx} | {n} | {ms:.1f} | {1e3 * ms / n:.0f} | {_wanted(name):g} "
                f"| {ms / unit / _wanted(name):.2f} | {wall:.1f} | {used:.1f} |"
                for name, nx, n, ms, wall, used in rows
            ),
            "",
            "The first call holds import, assembly, programs and the library that runs them (wanted: below "
            f"{FIRST_CALL_S:g} s where nothing else runs).",
        ],
    )


def _wanted(axle_type: str) -> float:
    return WANTED_MS.get(axle_type, OTHERS_MS)


if __name__ == "__main__":
    main()
