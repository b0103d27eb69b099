"""The example's folder with a small study in it: its axle, seven variables, records of two load cases of a
car whose hub is compliant."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from functools import cache, lru_cache
from pathlib import Path

import numpy as np

from doe_kc.api.studies import stored
from doe_kc.axle import Axle, with_values
from doe_kc.axle_file import read_axle
from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES, CurveSet
from doe_kc.discovery.result import Discovery
from doe_kc.effects import apply_effect
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LOAD_CASES
from doe_kc.measurement import Measurement
from doe_kc.measurement.channels import RIG_NAMES
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.study import Study, read_study
from doe_kc.workflow.answer import Answer
from doe_kc.workflow.chain import Correlate, Discover, follow_chain
from doe_kc.workflow.discover import discover_study, effect_library
from doe_kc.workflow.measure import Reduced, study_measurement
from tests.measurement.synthetic import RESOLUTION, csv_text, triangle
from tests.reference import EXAMPLE

MEASURED = ("lateral", "lateral_opposite")
HUB = {"camber_Nm_deg": 5000.0, "toe_Nm_deg": 9000.0}
SCATTER = {"ROB.z": 281.4, "LLF.z": 212.8, "llr.Fy": 1.1}
"""Of the car: path -> absolute value."""
SMALL_LIBRARY = ("hub_compliance", "tie_rod_compliance")
STUDY = """
name = "Front axle"
axle = "axle.toml"
measurement = "rig"
pictures = "none"
[influence]
parameters = ["ROB.z", "llr.F?", "spring.rate"]
[variables]
use = ["ROB.z", "LLF.z", "llr.F?", "static.*"]
"""


def write_example(root: Path) -> Path:
    """`examples/front_axle` under `root`, as in the repository, but small; returns that folder."""
    folder = root / "examples" / "front_axle"
    (folder / "rig").mkdir(parents=True)
    shutil.copy(EXAMPLE / "axle.toml", folder)
    shutil.copytree(EXAMPLE.parent / "adams", root / "examples" / "adams")
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    car, rng = measured_car(), np.random.default_rng(1)
    solved = curve_set(solve(car, MEASURED))
    lines = ['name = "car"', *_alignment(solved), "[records]"]
    for case in MEASURED:
        files = [f"{case}_{run}.csv" for run in range(3)]
        lines.append(f"{case} = {files}")
        for file in files:
            (folder / "rig" / file).write_text(csv_text(_record(solved, case, rng)), encoding="utf-8")
    (folder / "rig" / "test.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder


@lru_cache(maxsize=1)
def measured_car() -> Axle:
    """The example's axle with scatter and a compliant hub."""
    axle = with_values(read_axle(EXAMPLE / "axle.toml"), SCATTER)
    return apply_effect(axle, "hub_compliance", HUB, source="test")


def small_library(axle: Axle, exclude: tuple[str, ...] = ()) -> tuple[Hypothesis, ...]:
    """The hypotheses of two effects: a search takes a second or two."""
    return tuple(h for h in effect_library(axle, exclude) if h.effect in SMALL_LIBRARY)


@cache
def _discovery(folder: Path, left_out: frozenset[str]) -> Discovery:
    with stored(read_study(folder), None) as study:
        return discover_study(study, study_measurement(study), exclude=sorted(left_out), workers=1)


def discovery_once(
    study: Study, _measurement: Measurement, *, exclude: Sequence[str], **_: object
) -> Discovery:
    """In place of `discover_study` of the small study: the examples ask for the same five times."""
    return _discovery(study.folder.resolve(), frozenset(exclude) & {*SMALL_LIBRARY})


_ANSWERS: dict[Path, Answer] = {}


def chain_once(study: Study, reduced: Reduced, discover: Discover, correlate: Correlate) -> Answer:
    """In place of `follow_chain` of the small study, which the examples ask for three times."""
    if study.folder.resolve() not in _ANSWERS:
        _ANSWERS[study.folder.resolve()] = follow_chain(study, reduced, discover, correlate)
    return _ANSWERS[study.folder.resolve()]


def _alignment(solved: CurveSet) -> list[str]:
    assert solved.static is not None
    sides = [
        ", ".join(f"{name}_deg = {solved.static[name][k]:.3f}" for name in ("toe", "camber", "caster"))
        for k in (0, 1)
    ]
    return ["[alignment]", f"left = {{ {sides[0]} }}", f"right = {{ {sides[1]} }}"]


def _record(solved: CurveSet, load_case: str, rng: np.random.Generator) -> dict[str, FloatArray]:
    """Column heading -> samples of one run: white noise, an offset and a gain of its own."""
    case, curves = LOAD_CASES[load_case], solved.cases[load_case]
    inputs = case.amplitude * triangle()
    out = {"time [s]": np.arange(inputs.size) * 0.1, f"{case.channel} [{case.unit}]": inputs}
    for side, name in enumerate("LR"):
        for response in RIG_RESPONSES:
            y = np.interp(inputs, curves.input, curves.mean[response][side])
            error = rng.normal(size=inputs.size) + rng.normal()
            gain = 1.0 + 0.001 * rng.normal()
            heading = f"{RIG_NAMES[response]}_{name} [{RESPONSE_UNITS[response]}]"
            out[heading] = gain * y + RESOLUTION[response] * error
    return out
