"""Own time of `ego` on twice the variables: every parameter of both sides free, real evaluations."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

from optimizers.peer import Peer
from optimizers.running import CODE, PEERS, Result, problem, run

from doe_kc.axle.design_parameters import design_parameters
from doe_kc.axle.parameters import parameter_value
from doe_kc.correlation.methods.ego.method import WITH_SLOPES
from doe_kc.correlation.modelled.archive import build_archive
from doe_kc.correlation.problem import Candidate, Problem
from doe_kc.ground.errors import InputError
from doe_kc.variables import Change, VariableOptions, build_space
from tests.correlation import cases

VARIABLES = 120


def wide(out: Path) -> Path:
    """File of the run of `ego`; made when it is not there."""
    place = out / CODE / "wide.json"
    if not place.exists():
        peer = next(p for p in PEERS if p.id == "ego")
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(json.dumps(asdict(_run(peer)) | {"outputs": _outputs()}))
    return place


def line(out: Path) -> str:
    """One sentence, empty before the run."""
    place = out / CODE / "wide.json"
    if not place.exists():
        return ""
    found = json.loads(place.read_text())
    outputs, runs = found.pop("outputs"), Result(**found)
    proposals = len(runs.rating) - 1 - WITH_SLOPES.size(_wide().space)
    return (
        f"`ego` with {VARIABLES} side-wise variables and {outputs} outputs: {runs.own_cpu / proposals:.2f} "
        f"own CPU s a proposal (mean of {proposals}), {runs.own_cpu / len(runs.rating):.2f} an evaluation "
        "with the opening sample (goal: below 1 s); besides, "
        f"{runs.expansions} exact sensitivities of {runs.expansion_cpu:.2f} s each."
    )


def _outputs() -> int:
    """Characteristics and curve scores that `ego` models after the opening sample."""
    known = _wide()
    opening = WITH_SLOPES.sample(known.space, WITH_SLOPES.size(known.space), 1)
    designs = [Candidate(known.space.start, "baseline"), *opening]
    answers = [cases.outcome(known.axle, known.space.values(c.point)) for c in designs]
    judged = [known.judged(i, c, o) for i, (c, o) in enumerate(zip(designs, answers, strict=True))]
    best = build_archive(known.targets, judged).best
    slopes = known.output_slopes(best.point)
    return int(build_archive(known.targets, judged, slopes).outputs.shape[1])


def _run(peer: Peer) -> Result:
    return run(peer, 1, _wide())


def _wide() -> Problem:
    """120 side-wise variables, the same records."""
    known = problem()
    paths = [
        (f"{side}.{p.path}", p)
        for p in design_parameters(known.axle)
        if p.active
        for side in ("left", "right")
        if _settable(known.axle, f"{side}.{p.path}")
    ][:VARIABLES]
    changes = [Change(match=path, offset=[p.lower - p.nominal, p.upper - p.nominal]) for path, p in paths]
    options = VariableOptions(use=[path for path, _ in paths], change=changes)
    return replace(known, space=build_space(known.axle, options, "benchmark"))


def _settable(axle: object, path: str) -> bool:
    try:
        parameter_value(axle, path)  # type: ignore[arg-type]
    except InputError:
        return False
    return True
