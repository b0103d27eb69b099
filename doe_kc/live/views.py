"""What the page is told of a session: the announcement, answers, the axle's shape, the influence."""

from __future__ import annotations

import math
from itertools import cycle
from typing import Any

import numpy as np

from doe_kc.axle.geometry import point
from doe_kc.axle.members import drawn_points, members_of, shared_parts
from doe_kc.axle.model import Axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import RESPONSE_LABELS, RESPONSE_UNITS, SIDES, CurveSet, response_name
from doe_kc.effects import EFFECTS
from doe_kc.ground.typing import FloatArray
from doe_kc.live.advice import influence
from doe_kc.live.answer import LiveAnswer, LiveSlopes
from doe_kc.live.effect_switches import effect_switches
from doe_kc.live.frames import INFLUENCE, PRESENT, REFERENCE, SHAPE, PageFrame, drawn_curves
from doe_kc.live.model import LiveModel
from doe_kc.live.session import Session
from doe_kc.load_cases import case_label
from doe_kc.measurement import Measurement
from doe_kc.reports.axle.views import MEMBER_COLOURS, OTHER_COLOURS
from doe_kc.reports.names import input_label
from doe_kc.solver.curve_set import rising
from doe_kc.solver.elements._base import mirror
from doe_kc.solver.result import BranchSolution, CaseSolution
from doe_kc.solver.shape import shape_at
from doe_kc.targets.comparison import constraint_interval

SLIDER_GROUPS = {"HARDPOINTS": "Hardpoints", "BUSHINGS": "Bushings", "OTHER": "Other"}


def announcement(session: Session) -> dict[str, Any]:
    """Everything that stays while the sliders move: their kinds, curves, records, lines of the axle."""
    model, answer = session.model, session.nominal
    return {
        "kind": "model",
        "study": model.study.name,
        "axle": model.axle.name,
        "data": int(answer.residual.size),
        "sliders": _sliders(session),
        "cases": announced_cases(answer),
        "responses": [
            {"id": r, "label": RESPONSE_LABELS[r], "name": response_name(r), "unit": unit}
            for r, unit in RESPONSE_UNITS.items()
        ],
        "characteristics": _characteristics(model),
        "measured": {} if model.measurement is None else _measured(model.measurement),
        "effects": _effects(session),
        "outside": session.model.outside is not None,
        "shape": _lines(model.axle),
        "nominal_points": _design_points(session.nominal.axle).ravel().round(4).tolist(),
    }


def _sliders(session: Session) -> list[dict[str, Any]]:
    return [
        {
            "path": v.path,
            "label": v.parameter.label,
            "group": SLIDER_GROUPS[v.parameter.group],
            "unit": v.unit,
            "start": v.start,
            "lower": v.lower,
            "upper": v.upper,
            "step": v.parameter.step,
            "logarithmic": v.logarithmic,
            "point": v.path.split(".")[0] if v.parameter.quantity == "coordinate" else "",
        }
        for v in session.model.space.variables
    ]


def announced_cases(answer: LiveAnswer) -> list[dict[str, Any]]:
    """Load cases with the inputs that curves are drawn at."""
    return [
        {
            "id": ident,
            "label": case_label(ident),
            "unit": case.input_unit,
            "axis": input_label(ident, case.input_unit),
            "input": case.input.round(6).tolist(),
        }
        for ident, case in answer.curves.cases.items()
    ]


def _characteristics(model: LiveModel) -> list[dict[str, Any]]:
    """All registered ones; target, its standard deviation and interval null where there is none."""
    known = {} if model.targets is None else {t.entry.id: t for t in model.targets.characteristics}
    rows: list[dict[str, Any]] = []
    for ident, entry in CHARACTERISTICS.items():
        row: dict[str, Any] = {
            "id": ident,
            "label": entry.label,
            "unit": entry.unit,
            "load_case": entry.load_case,
            "case": "static" if entry.kind == "static" else case_label(entry.load_case),
            "response": entry.response,
            "target": None,
        }
        if ident in known:
            target = known[ident]
            low, high = constraint_interval(target.value)
            if target.constraint is not None:
                low, high = target.constraint.low, target.constraint.high
            row |= {"target": target.value, "sd": target.sd, "low": low, "high": high}
            row |= {"rated": target.active}
        rows.append(row)
    return rows


def _measured(measurement: Measurement) -> dict[str, Any]:
    """Load case -> input and response -> mean, sd, half-width, two sides each; null where not finite."""
    out = {}
    for ident, case in measurement.curves.cases.items():
        sd = measurement.curve_sd(ident)
        responses = {
            r: {
                "mean": _rounded(case.mean[r]),
                "sd": _rounded(sd[r]) if r in sd else None,
                "half": _rounded(case.half_width[r]),
            }
            for r in case.mean
        }
        out[ident] = {"unit": case.input_unit, "input": _rounded(case.input), "responses": responses}
    return out


def _rounded(values: FloatArray) -> list[Any]:
    """Five significant places for drawing; JSON has no nan."""

    def one(v: float) -> float | None:
        return float(f"{v:.6g}") if math.isfinite(v) else None

    array = np.asarray(values)
    return [one(v) for v in array] if array.ndim == 1 else [[one(v) for v in row] for row in array]


def _effects(session: Session) -> list[dict[str, Any]]:
    return [
        {
            "name": switch.name,
            "label": switch.label,
            "physics": EFFECTS[switch.effect].physics,
            "of_file": switch.of_file,
            "law": switch.law,
            "sizes": [
                {"name": s.name, "label": s.label, "unit": s.unit, "value": s.value} for s in switch.sizes
            ],
        }
        for switch in effect_switches(session.base.study).values()
    ]


def _lines(axle: Axle) -> dict[str, Any]:
    """points: names of a side, left ones first in a frame, then right ones. parts: lines by places."""
    names = drawn_points(axle)
    place = {name: i for i, name in enumerate(names)}
    others = cycle(OTHER_COLOURS)
    parts = [
        {
            "name": part,
            "colour": MEMBER_COLOURS.get(part) or next(others),
            "shared": part in shared_parts(axle),
            "lines": [[place[a], place[b]] for a, b in lines],
        }
        for part, lines in members_of(axle).items()
    ]
    return {
        "points": list(names),
        "labels": [axle.labels.get(name, name) for name in names],
        "parts": parts,
        "wheel_centre": place["WLC"],
        "radius": float(point(axle, "WLC")[2]),
    }


def _design_points(axle: Axle) -> FloatArray:
    """(2 n, 3) hardpoints of the left and the right side as designed, chassis frame, mm."""
    names = drawn_points(axle)
    sides = [point(axle, n, s) * np.array([1.0, mirror(s), 1.0]) for s in SIDES for n in names]
    return np.array(sides)


def present_frame(session: Session, seq: int) -> PageFrame:
    """exact: sliders as they are set, all characteristics, their terms of the rating (nan without one), then
    gap, rating, seconds. drawn: curves of the last good answer. text: failure, empty when it is the answer;
    whether the true model gave it.
    """
    set_now = np.array(list(session.values().values()))
    text = {"failure": session.failure, "true": session.present.true}
    return _answer_frame(session, PRESENT, seq, session.present, set_now, text)


def reference_frames(session: Session) -> list[PageFrame]:
    """Of the nominal axle, seq 0, and of each snapshot, seq 1 and more."""
    named = [("nominal", session.nominal), *((s.name, s.answer) for s in session.state.snapshots)]
    frames = []
    for place, (name, answer) in enumerate(named):
        values = np.array([answer.values.get(p, math.nan) for p in session.model.space.paths])
        text = {"name": name, "true": answer.true}
        frames.append(_answer_frame(session, REFERENCE, place, answer, values, text))
    return frames


def _answer_frame(
    session: Session, kind: int, seq: int, answer: LiveAnswer, values: FloatArray, text: dict[str, Any]
) -> PageFrame:
    terms = np.full(len(CHARACTERISTICS), math.nan)
    total = math.nan
    if answer.rating is not None and answer.model.targets is not None:
        terms[answer.model.targets.rows] = answer.rating.objectives + answer.rating.constraints
        total = answer.rating.total
    last = np.array([answer.gap, total, answer.seconds])
    exact = [values, answer.characteristics, terms, last]
    drawn = drawn_curves(answer.curves, session.nominal.curves)
    return PageFrame(kind, seq, np.concatenate(exact), drawn, text)


def influence_frame(session: Session, slopes: LiveSlopes, seq: int) -> PageFrame:
    """exact: rows of `influence`, one after the other."""
    table = influence(slopes, session.space)
    finite = np.where(np.isfinite(table), table, 0.0)
    return PageFrame(INFLUENCE, seq, finite.ravel(), np.zeros(0), {"sliders": table.shape[1]})


def shape_frame(answer: LiveAnswer, announced: CurveSet, load_case: str, row: int, seq: int) -> PageFrame:
    """drawn: points as designed, at rest and at the input, left then right, 3 each; then for rest and input
    the wheels' spin axes. text: load case, row and input. row: of the inputs of `announced`."""
    case = answer.solution.cases.get(load_case) or next(iter(answer.solution.cases.values()))
    grid = rising(case)
    drawn = announced.cases.get(case.load_case.id)
    if drawn is not None and drawn.input.size != grid.size:  # an outside solver and loops have their own
        row = int(np.argmin(np.abs(grid - drawn.input[min(row, drawn.input.size - 1)])))
    row = min(row, grid.size - 1)
    states = [shape_at(answer.axle, *_rest(case)), shape_at(answer.axle, *_branch_row(case, row))]
    names = [f"{name}@{side}" for side in SIDES for name in drawn_points(answer.axle)]
    parts = [_design_points(answer.axle)]
    parts += [np.array([s.points[name] for name in names]) for s in states]
    parts += [np.array([s.spin[side] for side in SIDES]) for s in states]
    text = {"load_case": case.load_case.id, "row": row, "input": round(float(grid[row]), 6)}
    return PageFrame(SHAPE, seq, np.zeros(0), np.concatenate([p.ravel() for p in parts]), text)


def _rest(case: CaseSolution) -> tuple[BranchSolution, int]:
    return case.branches[0], 0


def _branch_row(case: CaseSolution, row: int) -> tuple[BranchSolution, int]:
    """Branch and row of a place on the rising grid; of a loop the climbing branch."""
    branches = {b.name: b for b in case.branches}
    if "load" in branches:
        return branches["load"], row
    steps = len(branches["neg"].input) - 1
    return (branches["neg"], steps - row) if row < steps else (branches["pos"], row - steps)
