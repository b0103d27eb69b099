"""Writes what a test engineer hands over: CSV records of three runs, and `test.toml`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from benchmarks.discovery.car import CleanRecords
from benchmarks.discovery.chance import stream
from benchmarks.discovery.sensors import INPUT_WHITE, RESOLUTION, Levels, kind, read, rig_loops
from doe_kc.axle import Axle
from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES, SIDES
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases.force import LateralOffset
from doe_kc.measurement.channels import RIG_NAMES

RUNS = 3
SAMPLE_TIME = 0.1
"""s."""
DECIMALS = {"angle": 4, "displacement": 3, "tyre_load": 1}
BENCH_SD = {"toe": 0.01, "camber": 0.01, "spin": 0.02}
"""deg, of the alignment bench."""
BENCH_DECIMALS = {"toe": 3, "camber": 3, "spin": 2}


def write_records(
    clean: CleanRecords, nominal: Axle, levels: Levels, seed: int, name: str, folder: Path
) -> None:
    """All runs of all load cases. seed: of the errors."""
    folder.mkdir(parents=True, exist_ok=True)
    for case in clean.loops:
        loops = rig_loops(levels, stream(seed, "rig loop", case), RIG_RESPONSES)
        for run in range(RUNS):
            rng = stream(seed, "run", case, str(run))
            (folder / _file(case, run)).write_text(_csv(clean, case, levels, loops, rng))
    (folder / "test.toml").write_text(_manifest(clean, nominal, stream(seed, "bench"), name))


def _file(case: str, run: int) -> str:
    return f"{case}_repeat{run}.csv" if run else f"{case}.csv"


def _csv(
    clean: CleanRecords,
    case: str,
    levels: Levels,
    loops: Mapping[str, FloatArray],
    rng: np.random.Generator,
) -> str:
    loop = clean.loops[case]
    channel = loop.case.channel
    noise = levels.input_white * INPUT_WHITE[channel] * rng.standard_normal(loop.input.size)
    measured = read(
        {r: clean.recorded(case, r) for r in RIG_RESPONSES},
        {r: loop.change(r) for r in RIG_RESPONSES},
        loop.input / loop.case.amplitude,
        levels,
        loops,
        rng,
    )
    heads = ["time [s]", f"{channel} [{loop.case.unit}]"]
    columns = [[f"{v:.6g}" for v in SAMPLE_TIME * np.arange(noise.size)]]
    columns.append([f"{v:.6g}" for v in loop.input + noise])
    for side, letter in enumerate(SIDES):
        for response in RIG_RESPONSES:
            heads.append(f"{RIG_NAMES[response]}_{letter} [{RESPONSE_UNITS[response]}]")
            decimals = DECIMALS[kind(response)]
            columns.append([f"{v:g}" for v in np.round(measured[response][side], decimals)])
    rows = [",".join(row) for row in zip(*columns, strict=True)]
    return "\n".join([",".join(heads), *rows]) + "\n"


def _manifest(clean: CleanRecords, nominal: Axle, rng: np.random.Generator, name: str) -> str:
    angles = {
        r: np.round(clean.static[r] + sd * rng.standard_normal(2), BENCH_DECIMALS[r])
        for r, sd in BENCH_SD.items()
    }
    rows = [
        f"{word} = {{ toe_deg = {angles['toe'][i]:g}, camber_deg = {angles['camber'][i]:g}, "
        f"caster_deg = {angles['spin'][i]:g} }}"
        for i, word in enumerate(("left", "right"))
    ]
    lines = [
        "# K&C rig record of one axle. Sampled loops: +A -> -A -> +A, steady cycle.",
        f'name = "{name}"',
        "[setup]",
        'loading = "kerb+2"',
        f"reference_wheel_load_N = {nominal.values['tyre.static_load']:g}",
        'body = "clamped"',
        f'steering = "{"wheel held" if nominal.rack_mm_per_rev else "none"}"',
        f"lateral_offset_mm = {_offset(clean):.1f}",
        *([f"rack_mm_per_rev = {nominal.rack_mm_per_rev:g}"] if nominal.rack_mm_per_rev else []),
        "[alignment]   # static values at ride height, from the alignment bench",
        *rows,
        "[sensor_resolution]",
        f"angle_deg = {RESOLUTION['angle']:g}",
        f"displacement_mm = {RESOLUTION['displacement']:g}",
        f"tyre_load_N = {RESOLUTION['tyre_load']:g}",
        "[records]",
    ]
    for case in clean.loops:
        files = ", ".join(f'"{_file(case, run)}"' for run in range(RUNS))
        lines.append(f"{case} = [{files}]")
    return "\n".join(lines) + "\n"


def _offset(clean: CleanRecords) -> float:
    """mm behind the contact point, of the load case that has one."""
    cases = (loop.case for loop in clean.loops.values())
    return next((c.offset for c in cases if isinstance(c, LateralOffset)), LateralOffset.offset)
