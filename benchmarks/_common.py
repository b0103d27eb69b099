"""Shared by the benchmarks: the example axle, the machine, where results go."""

from __future__ import annotations

import os
import platform
import sys
from pathlib import Path

from threadpoolctl import threadpool_limits

ROOT = Path(__file__).parents[1]
RESULTS = Path(__file__).parent / "results"
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")
threadpool_limits(1)  # of what was loaded before
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from doe_kc.axle import Axle  # noqa: E402  # after the thread limits
from doe_kc.axle.topology import Topology  # noqa: E402
from doe_kc.axle_file import read_axle  # noqa: E402
from doe_kc.solver.compiled import adaptive_kernel  # noqa: E402


def compile_now(topology: Topology) -> None:
    """Compile the kernel of a topology, which otherwise runs by programs for a while."""
    adaptive_kernel(topology).compile()


def example_axle() -> Axle:
    """The shipped axle."""
    return read_axle(ROOT / "examples" / "front_axle" / "axle.toml")


def machine() -> str:
    """Processor and versions, one line."""
    model = platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [
            line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if "model name" in line
        ]
        model = names[0] if names else model
    return f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}"


def publish(name: str, lines: list[str]) -> None:
    """Print a report and keep it under results/."""
    text = "\n".join(lines) + "\n"
    RESULTS.mkdir(exist_ok=True)
    (RESULTS / f"{name}.md").write_text(text)
    print(text)
