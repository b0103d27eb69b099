"""Cars with two effects, the outside model that has both, and the twin that lacks them.

The outside model is the package's own command behind the protocol of outside solvers, on an axle file with
the effects; the records are those of a car at the parameters of a key of tests/data/rig, with noise.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.discovery.car import Car
from benchmarks.discovery.chance import stream
from benchmarks.discovery.hidden import Hidden
from benchmarks.discovery.records import write_records
from benchmarks.discovery.sensors import Levels, levels
from doe_kc.axle import Axle, with_values
from doe_kc.axle_file import read_axle
from doe_kc.axle_file.write import write_axle
from doe_kc.effects import apply_effect
from tests.correlation import cases

HUB: Mapping[str, Mapping[str, Any]] = {
    "hub_compliance": {"camber_Nm_deg": 6000.0, "toe_Nm_deg": 9000.0},
    "steering_friction": {"force_N": 150.0, "presliding_mm": 0.05},
}
STRUT: Mapping[str, Mapping[str, Any]] = {
    "strut_bending": {"k_Nm_deg": 6500.0, "torsion_Nm_deg": 30000.0},
    "tie_rod_compliance": {"k_N_mm": 15000.0},
}
BUSHING_SD = 0.6
"""Of the logarithm of a bushing's stiffness in the wrong import."""
POINT_ERROR = 15.0
"""mm, of the points that no variable moves."""
BRIDGE = """import json, subprocess, sys

parameters, folder, axle = sys.argv[1:]
values = json.load(open(parameters))["parameters"]
changes = [word for path, value in values.items() for word in ("--set", f"{path}={value!r}")]
command = [sys.executable, "-m", "doe_kc", "simulate", axle, *changes, "--out", folder]
sys.exit(subprocess.run(command, stdout=subprocess.DEVNULL).returncode)
"""


@dataclass(frozen=True)
class TwinCase:
    """key: car of tests/data/rig whose parameters the car has. effects: of car and outside model.
    wrong: whether the twin was imported with wrong bushings, points and bar besides. quiet: whether the rig's
    errors are a tenth of what they are. compared: whether all corrections are run on it."""

    key: str
    effects: str
    wrong: bool = False
    quiet: bool = False
    compared: bool = False

    @property
    def name(self) -> str:
        """For files and tables."""
        further = f"{', wrong import' if self.wrong else ''}{', quiet rig' if self.quiet else ''}"
        return f"{self.key}, {self.effects}{further}"

    @property
    def options(self) -> Mapping[str, Mapping[str, Any]]:
        """Effect -> its table."""
        return HUB if self.effects == "hub compliance and steering friction" else STRUT


HUB_WORDS, STRUT_WORDS = "hub compliance and steering friction", "strut bending and tie-rod compliance"
TWIN_CASES = (
    TwinCase("car_b", HUB_WORDS, compared=True),
    *(TwinCase(key, HUB_WORDS) for key in ("car_c", "car_d", "car_e")),
    *(TwinCase(key, STRUT_WORDS) for key in ("car_b", "car_e")),
    *(TwinCase(key, HUB_WORDS, quiet=True) for key in ("car_b", "car_e")),
    *(TwinCase(key, HUB_WORDS, wrong=True, compared=True) for key in ("car_b", "car_e")),
)


def wrongly_imported(axle: Axle, sd: float = BUSHING_SD) -> Axle:
    """The axle as a wrong import has it, always the same. sd: of the logarithm of a bushing's stiffness."""
    rng = np.random.default_rng(7)
    values: dict[str, float] = {}
    for name, value in axle.values.items():
        if name.endswith("@L") and ".stiffness." in name:
            factor = float(np.exp(rng.normal(0.0, sd)))
            values |= {f"{name[:-1]}{side}": value * factor for side in "LR"}
    for point in ("CLAMP.x", "UPBBI.x", "ARB.x", "ARB.z"):
        values |= {f"{point}@{side}": axle.values[f"{point}@{side}"] + POINT_ERROR for side in "LR"}
    return axle.changed(values | {"arb.rate": 1.3 * axle.values["arb.rate"]})


def quietened(errors: Levels) -> Levels:
    """A tenth of every error."""

    def tenth(values: Mapping[str, float]) -> dict[str, float]:
        return {kind: 0.1 * value for kind, value in values.items()}

    return replace(
        errors,
        white=tenth(errors.white),
        offset=tenth(errors.offset),
        smooth=tenth(errors.smooth),
        gain=0.1 * errors.gain,
        input_white=0.1 * errors.input_white,
    )


def write_case(case: TwinCase, folder: Path, *, twin: bool, seed: int, budget: int) -> Path:
    """Study, twin, outside model and records of a case in a folder; the folder. seed: of noise and search."""
    folder.mkdir(parents=True, exist_ok=True)
    nominal = read_axle(cases.AXLE)
    real = wrongly_imported(nominal) if case.wrong else nominal
    hidden = tuple(Hidden(i, 1.0, options=o) for i, o in case.options.items())
    car = Car(with_values(real, cases.truth(case.key, nominal)), hidden, (), None, {})
    errors = levels(stream(seed, "levels"), faults=False)
    errors = quietened(errors) if case.quiet else errors
    write_records(car.clean(), nominal, errors, seed, "car", folder / "rig")
    for ident, options in case.options.items():
        real = apply_effect(real, ident, options, source="benchmark")
    (folder / "axle.toml").write_bytes(cases.AXLE.read_bytes())
    write_axle(real, cases.AXLE, folder / "outside.toml")
    (folder / "bridge.py").write_text(BRIDGE)
    command = [sys.executable, "bridge.py", "{parameters}", "{folder}", "outside.toml"]
    (folder / "study.toml").write_text(
        'axle = "axle.toml"\nmeasurement = "rig"\npictures = "none"\n'
        f"seed = {seed}\n[solver]\ncommand = {command}\n"
        f'{"" if twin else "twin = false"}\n[variables]\nlevels = "continuous"\n'
        f"[correlation]\nbudget = {budget}\n"
    )
    return folder
