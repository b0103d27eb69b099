"""A study of an outside solver: a car that has an effect which its twin lacks, some of its designs stored."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.campaign.record import StoredEvaluation, design_key, packed_outcome
from doe_kc.campaign.store import open_store
from doe_kc.effects import apply_effect
from doe_kc.study import Study, read_study
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.own import AxleSolver
from tests.live.cases import EXAMPLES, RIG

EFFECT = """
[effects.hub_compliance]
camber_Nm_deg = 2500.0
toe_Nm_deg = 3500.0
"""
BRIDGE = """
import json, subprocess, sys
parameters, folder, axle = sys.argv[1:]
values = json.load(open(parameters))["parameters"]
if values["RIB.z"] > {limit}:
    sys.exit("the bridge fell down")
changes = [word for path, value in values.items() for word in ("--set", f"{{path}}={{value!r}}")]
command = [sys.executable, "-m", "doe_kc", "simulate", axle, *changes, "--out", folder]
sys.exit(subprocess.run(command, stdout=subprocess.DEVNULL).returncode)
"""
STUDY = """
schema = "doe_kc.study/1"
name = "Front axle, outside model"
axle = "axle.toml"
measurement = "{records}"

[variables]
use = ["LLF.z", "RIB.z", "ROB.z", "llr.Fx", "llr.Fy", "spring.rate"]

[solver]
command = ["{python}", "bridge.py", "{{parameters}}", "{{folder}}", "car.toml"]
twin = {twin}
"""
FAILS_ABOVE = 2.0
"""mm above its start, of RIB.z: there the command fails."""


def outside_study(folder: Path, *, designs: int, twin: bool = True) -> Study:
    """Its files in a folder, and so many designs in its store, the first the start."""
    folder.mkdir(exist_ok=True)
    axle = (EXAMPLES / "front_axle" / "axle.toml").read_text("utf-8")
    (folder / "axle.toml").write_text(axle, encoding="utf-8")
    (folder / "car.toml").write_text(axle + EFFECT, encoding="utf-8")
    words = {"records": RIG / "car_b", "python": sys.executable, "twin": str(twin).lower()}
    (folder / "study.toml").write_text(STUDY.format(**words), encoding="utf-8")
    study = read_study(folder)
    limit = next(v.start for v in study.space.variables if v.path == "RIB.z") + FAILS_ABOVE
    (folder / "bridge.py").write_text(BRIDGE.format(limit=limit), encoding="utf-8")
    if designs:
        _store(study, designs)
    return study


def car(study: Study) -> Axle:
    """What the command solves."""
    sizes = {"camber_Nm_deg": 2500.0, "toe_Nm_deg": 3500.0}
    return apply_effect(study.axle, "hub_compliance", sizes, source="test")


def _store(study: Study, count: int) -> None:
    """The car's own answers, as the command would give them, without its processes."""
    space, rng = study.space, np.random.default_rng(0)
    points = [space.start, *rng.uniform(0.1, 0.9, (count - 1, space.dimension))]
    solver = AxleSolver(car(study), study.windows).prepare([{}])
    records = []
    for point in points:
        values = space.values(point)
        records.append(
            StoredEvaluation(
                key=design_key(values),
                parameters=values,
                packed=packed_outcome(solver.evaluate(values)),
                windows=dict(study.windows),
                origin="sample:lhs",
                created="2026-01-01",
                versions={},
            )
        )
    outside = solver_for(study.axle, study.solver, study.windows, study.folder)
    with open_store(study.store, outside) as store:
        store.put_all(records)
