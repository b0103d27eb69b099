"""The live page as one file that still moves: without a server, by the first-order model, and it says so."""

from __future__ import annotations

import base64
import hashlib
import json
from typing import Any

import numpy as np

from doe_kc.ground.numbers import number
from doe_kc.ground.typing import FloatArray
from doe_kc.live import views
from doe_kc.live.advice import influence
from doe_kc.live.answer import LiveAnswer, solve_live
from doe_kc.live.first_order import CheckedRange, FirstOrder, checked_range, first_order
from doe_kc.live.frames import drawn_curves
from doe_kc.live.page_files import asset
from doe_kc.live.session import Session
from doe_kc.variables.variable import Variable

SHAPE_ROWS = 5
"""Inputs of a load case at which the axle is drawn."""
SHARE_OF_STEP = 0.5
"""Of a parameter's step: half the difference by which the axle's points are differentiated."""
SCRIPTS = ("uPlot.iife.min.js", "frames.js", "charts.js", "axle.js", "embedded.js", "live.js")
STYLES = ("uPlot.min.css", "live.css")


def static_page(session: Session) -> str:
    """HTML of the present design: one file, no request, its scripts allowed by their hashes."""
    slopes = session.slopes()
    model = first_order(slopes, session.space)
    checked = checked_range(model, session.compilation, seed=session.base.study.seed)
    document = _document(session, model, checked)
    data = json.dumps(document, allow_nan=False).replace("<", "\\u003c")
    page = asset("live.html")
    head, _, rest = page.partition('<link rel="stylesheet"')
    body = rest[rest.index("</head>") :]
    body = body[: body.index('<script src="')]
    scripts, styles = [asset(name) for name in SCRIPTS], [asset(name) for name in STYLES]
    policy = (
        f"default-src 'none'; img-src data:; script-src {_hashes(scripts)}; style-src {_hashes(styles)}; "
        "base-uri 'none'; form-action 'none'"
    )
    return "".join(
        [
            head.replace(
                "<title>", f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n<title>'
            ),
            *(f"<style>{text}</style>\n" for text in styles),
            body,
            f'<script type="application/json" id="embedded">{data}</script>\n',
            *(f"<script>{text}</script>\n" for text in scripts),
            "</body>\n</html>\n",
        ]
    )


def _hashes(texts: list[str]) -> str:
    digests = [base64.b64encode(hashlib.sha256(t.encode()).digest()).decode() for t in texts]
    return " ".join(f"'sha256-{d}'" for d in digests)


def _packed(values: FloatArray) -> str:
    """Float32, little-endian, base64."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode()


def _document(session: Session, model: FirstOrder, checked: CheckedRange) -> dict[str, Any]:
    said = views.announcement(session)
    answer, own = model.answer, _own_variables(model)
    said["sliders"] = [_slider(said["sliders"][i], session, int(i)) for i in model.columns]
    said["effects"], said["cases"] = [], views.announced_cases(answer)
    references = [("nominal", session.nominal)]
    references += [(s.name, s.answer) for s in session.state.snapshots]
    table = np.nan_to_num(influence(session.slopes(), session.space)[:, model.columns])
    return {
        "model": said,
        "sentence": _sentence(model, checked),
        "base": [answer.values[p] for p in model.paths],
        "places": [[v.lower, v.upper, v.logarithmic] for v in own],
        "characteristics": _packed(np.nan_to_num(model.characteristics)),
        "characteristic_slopes": _packed(np.nan_to_num(model.characteristic_slopes)),
        "curves": _packed(model.curves),
        "slopes": _packed(_without_loops(model)),
        "chi": model.chi,
        "pull": _packed(model.pull),
        "hessian": _packed(model.hessian),
        "data": model.data,
        "influence": _packed(table),
        "references": [
            {
                "name": name,
                "values": [a.values.get(p, answer.values[p]) for p in model.paths],
                "characteristics": _packed(np.nan_to_num(a.characteristics)),
                "curves": _packed(drawn_curves(a.curves, answer.curves)),
            }
            for name, a in references
        ],
        "shapes": _shapes(session, model),
    }


def _without_loops(model: FirstOrder) -> FloatArray:
    """Its slopes, those of the half-widths left out where none of them moves: half of the page's size."""
    half = len(model.curves) // 2
    return model.slopes if model.slopes[half:].any() else model.slopes[:half]


def _own_variables(model: FirstOrder) -> list[Variable]:
    """(k,) variables of the space that the places u are of."""
    return [model.answer.model.space.variables[i] for i in model.columns]


def _slider(row: dict[str, Any], session: Session, place: int) -> dict[str, Any]:
    """The announced slider with the bounds that hold now; it starts at the design that is written."""
    variable = session.space.variables[place]
    start = session.present.values[variable.path]
    return row | {"start": start, "lower": variable.lower, "upper": variable.upper}


def _sentence(model: FirstOrder, checked: CheckedRange) -> str:
    fixed = model.space.dimension - len(model.columns)
    sentence = (
        "Approximation: this file has no solver. It shows, dashed, the first-order model with exact slopes "
        f"about the design it was written at. Checked against the true model with {checked.designs} designs: "
        f"one slider at its bounds, largest error {number(100.0 * checked.curve_error, 2)} % of a curve's "
        f"range; all sliders anywhere between them, {number(100.0 * checked.joint_error, 2)} % "
        f"(worst: {checked.where})."
    )
    if checked.unsolved:
        sentence += f" {checked.unsolved} designs had no equilibrium."
    if fixed:
        sentence += f" {fixed} sliders of less influence are left out."
    return sentence


def _shapes(session: Session, model: FirstOrder) -> dict[str, Any]:
    """Points as `views.shape_frame` at some inputs of every load case, and their slopes by differences of the
    true model: (rows, n) and (rows, k, n)."""
    answer = model.answer
    rows = {
        case: np.unique(np.linspace(0, c.input.size - 1, SHAPE_ROWS).round().astype(int)).tolist()
        for case, c in answer.curves.cases.items()
    }
    base = _drawn(answer, rows)
    slopes = np.zeros((len(base), len(model.columns), base.shape[1]))
    everything = {v.path: answer.values[v.path] for v in model.space.variables}
    for k, variable in enumerate(_own_variables(model)):
        step = SHARE_OF_STEP * variable.parameter.step
        ends, places = [], []
        for sign in (1.0, -1.0):
            values = everything | {variable.path: everything[variable.path] + sign * step}
            solved = solve_live(answer.model, values, session.compilation)
            if not isinstance(solved, str):
                ends.append(_drawn(solved, rows))
                places.append(variable.place(values[variable.path]))
        if len(ends) == 2:
            slopes[:, k] = (ends[0] - ends[1]) / (places[0] - places[1])
    return {
        "rows": [[case, row] for case, chosen in rows.items() for row in chosen],
        "inputs": [float(answer.curves.cases[c].input[r]) for c, chosen in rows.items() for r in chosen],
        "length": base.shape[1],
        "points": _packed(base),
        "slopes": _packed(slopes),
    }


def _drawn(answer: LiveAnswer, rows: dict[str, list[int]]) -> FloatArray:
    frames = [
        views.shape_frame(answer, answer.curves, case, row, 0).drawn
        for case, chosen in rows.items()
        for row in chosen
    ]
    return np.array(frames)
