"""Measured curves beside those of the nominal, the re-tuned and the extended model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from doe_kc.correlation.curve_data import Branches, CurveData
from doe_kc.curves import RESPONSE_UNITS, TYRE_LOAD, response_name
from doe_kc.discovery.result import Discovery
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.correlation.curves import BAND_SDS
from doe_kc.reports.discovery.gaps import MODEL_COLOURS
from doe_kc.reports.discovery.words import MODEL_LABELS
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Dash, PageBox, Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.words import POINTS


@dataclass(frozen=True)
class ModelView:
    """One response of one load case; arrays (2, n), left wheel first, in the response's unit.

    branches: mean of both branches of the loop, or half their difference, (falling - rising) / 2.
    sd: of the measured points. models: by the names of `Gap`; only those that there are.
    """

    load_case: str
    response: str
    branches: Branches
    input_label: str
    input: FloatArray
    measured: FloatArray
    sd: FloatArray
    models: Mapping[str, FloatArray]

    def deviation(self, model: str) -> FloatArray:
        """(2, n) (model - measured) / sd, point by point."""
        return np.asarray((self.models[model] - self.measured) / self.sd)

    def rms(self, model: str) -> FloatArray:
        """(2,) RMS of model - measured, in the response's unit."""
        return np.asarray(np.sqrt(np.mean((self.models[model] - self.measured) ** 2, axis=1)))


def model_names(discovery: Discovery) -> list[str]:
    """Models that there are, by the names of `Gap`."""
    names = ["nominal", "tuned"]
    if discovery.fitted.model.members:
        names.append("with_effect")
    return names if discovery.decoy is None else [*names, "best_decoy"]


def model_values(discovery: Discovery) -> dict[str, list[FloatArray]]:
    """Every model's curves in their units, in the order of the records'.

    Each fit's residual is in units of its own errors: those of a model with effects grant the shape of
    their laws.
    """
    tuned = discovery.search.tuned
    fits = {"nominal": (tuned.model.likelihood, discovery.nominal)}
    each = {"tuned": tuned, "with_effect": discovery.fitted}
    if discovery.decoy is not None:
        each["best_decoy"] = discovery.decoy.fit
    fits |= {name: (fit.model.likelihood, fit.residual) for name, fit in each.items()}
    return {
        name: [curve.value + curve.root @ residual[place] for curve, place in likelihood.slices()]
        for name, (likelihood, residual) in fits.items()
        if name in model_names(discovery)
    }


def model_views(discovery: Discovery) -> dict[tuple[str, str, Branches], ModelView]:
    """Every load case and response of the records, by (load case, response, branches)."""
    model = discovery.search.tuned.model
    pairs: dict[tuple[str, str, Branches], list[tuple[int, CurveData]]] = {}
    for i, curve in enumerate(model.likelihood.curves):
        pairs.setdefault((curve.load_case, curve.response, curve.branches), []).append((i, curve))
    values = model_values(discovery)
    labels = {name: f"{case.input_label} [{case.unit}]" for name, case in model.axle.load_cases.items()}
    return {key: _view(key, labels[key[0]], members, values) for key, members in pairs.items()}


def view_gaps(discovery: Discovery) -> dict[tuple[str, str, Branches], dict[str, float]]:
    """Whitened RMS of both wheels, in units of the records' own errors, by model."""
    likelihood = discovery.search.tuned.model.likelihood
    squares: dict[tuple[str, str, Branches], dict[str, list[FloatArray]]] = {}
    for name, values in model_values(discovery).items():
        for curve, value in zip(likelihood.curves, values, strict=True):
            key = (curve.load_case, curve.response, curve.branches)
            each = squares.setdefault(key, {}).setdefault(name, [])
            each.append(curve.whitened(value - curve.value) ** 2)
    return {
        key: {name: float(np.sqrt(np.mean(np.concatenate(parts)))) for name, parts in models.items()}
        for key, models in squares.items()
    }


def _view(
    key: tuple[str, str, Branches],
    label: str,
    members: list[tuple[int, CurveData]],
    values: Mapping[str, list[FloatArray]],
) -> ModelView:
    curves = [c for _, c in members]
    models = {name: np.array([each[i] for i, _ in members]) for name, each in values.items()}
    measured, level = np.array([c.value for c in curves]), np.array([c.level for c in curves])
    return ModelView(*key, label, curves[0].input, measured, level, models)


CURVES_SHOWN = 6
PER_CASE = 2
COLUMNS = 3
PAGE_HEAD, PAGE_FOOT, PAIR_HEIGHT = 0.45, 0.5, 3.65
"""Inches of the title of all, of the legend, and of a curve with its deviation."""
TITLE_HEIGHT, CURVE_HEIGHT, PAIR_GAP, DEVIATION_HEIGHT = 0.42, 1.72, 0.13, 0.8
"""Inches of the parts of a pair from above; numbers and name of the input have the rest."""
DASHES: Mapping[str, Dash] = {"tuned": "--", "with_effect": "-", "best_decoy": ":"}
WHEEL_WORDS = ("left wheel", "right wheel")


@dataclass(frozen=True)
class WorstView:
    """A curve of one wheel. gaps: whitened RMS of both wheels by model. half: measured half-width for the
    branches of a mean curve, (n,), else None."""

    view: ModelView
    side: int
    gaps: Mapping[str, float]
    half: FloatArray | None

    @property
    def title(self) -> str:
        """Load case and wheel, and the gap."""
        place = f"{case_label(self.view.load_case)}, {WHEEL_WORDS[self.side]}"
        place += ", loop" if self.view.branches == "half_width" else ""
        gap = f"{self.gaps['tuned']:.1f} re-tuned"
        if "with_effect" in self.gaps:
            gap += f", {self.gaps['with_effect']:.1f} with the effect"
        return f"{place}\ngap {gap}"

    @property
    def label(self) -> str:
        """Response with its unit."""
        view = self.view
        name, unit = response_name(view.response), RESPONSE_UNITS[view.response]
        if view.branches == "half_width":
            return f"{name}, half-width [{unit}]"
        return f"{'' if view.response == TYRE_LOAD else 'Δ '}{name} [{unit}]"


def worst_views(discovery: Discovery) -> list[WorstView]:
    """Curves with the largest gaps after re-tuning, at most two of a load case, each of its worse wheel."""
    views = model_views(discovery)
    gaps = view_gaps(discovery)
    out: list[WorstView] = []
    taken: dict[str, int] = {}
    for key in sorted(gaps, key=lambda k: -gaps[k]["tuned"]):
        view = views[key]
        if taken.get(view.load_case, 0) >= PER_CASE:
            continue
        loop = views.get((view.load_case, view.response, "half_width"))
        side = int(np.argmax(np.mean(view.deviation("tuned") ** 2, axis=1)))
        half = None
        if view.branches == "mean" and loop is not None:
            half = np.interp(view.input, loop.input, loop.measured[side])
        out.append(WorstView(view, side, gaps[key], half))
        taken[view.load_case] = taken.get(view.load_case, 0) + 1
        if len(out) == CURVES_SHOWN:
            break
    return out


def curve_figure(worst: Sequence[WorstView], study: str) -> Sheet:
    """Two rows of three curves, each with its deviation from the measured one below."""
    rows = max(1, -(-len(worst) // COLUMNS))
    height = PAGE_HEAD + PAIR_HEIGHT * rows + PAGE_FOOT
    margins = {"left": 0.065, "right": 0.985, "wspace": 0.3}
    page, panels = sheet(2 * rows, COLUMNS, size=(11.69, height), share_x=False, margins=margins)
    _place(panels, height)
    for k, one in enumerate(worst):
        row, column = divmod(k, COLUMNS)
        _curve(panels[2 * row, column], one)
        _deviation(panels[2 * row + 1, column], one)
    shown = [p for k in range(len(worst)) for p in panels[2 * (k // COLUMNS) :, k % COLUMNS][:2]]
    page.panels[:] = [p for p in page.panels if any(p is s for s in shown)]
    page.add_legend(_handles(worst), 6, 7.5)
    page.set_heading(f"Curves that re-tuning explains worst: {study}", 1.0 - 0.12 / height)
    return page


def _place(panels: NDArray[Any], height: float) -> None:
    """A deviation close below its curve, room for a title above the curve and for the input's name between
    the pairs; height: of the page, inches."""
    for row, members in enumerate(panels):
        pair, below = divmod(row, 2)
        tall, low = (
            (DEVIATION_HEIGHT, CURVE_HEIGHT + PAIR_GAP + DEVIATION_HEIGHT)
            if below
            else (CURVE_HEIGHT, CURVE_HEIGHT)
        )
        bottom = height - PAGE_HEAD - PAIR_HEIGHT * pair - TITLE_HEIGHT - low
        for panel in members:
            panel.box = PageBox(panel.box.left, bottom * POINTS, panel.box.width, tall * POINTS)


def _curve(panel: Panel, worst: WorstView) -> None:
    view, side = worst.view, worst.side
    mean, sd = view.measured[side], view.sd[side]
    panel.fill_between(
        view.input, mean - BAND_SDS * sd, mean + BAND_SDS * sd, color="#BBBBBB", alpha=0.7, lw=0
    )
    if worst.half is not None:
        for sign in (-1.0, 1.0):
            panel.plot(view.input, mean + sign * worst.half, color=style.PALETTE["grey"], lw=0.6)
    for name, dash in DASHES.items():
        if name in view.models:
            panel.plot(view.input, view.models[name][side], dash, color=MODEL_COLOURS[name], lw=1.4)
    step = max(1, mean.size // 22)
    panel.plot(view.input[::step], mean[::step], "", marker="o", color="black", ms=2.4, mew=0.0, zorder=4)
    panel.set_title(worst.title, size=8.5)
    panel.set_labels(None, worst.label, 7.0)
    panel.numbers["x"] = False
    panel.x.set_locator(ticks(6))
    panel.y.set_locator(ticks(6))


def _deviation(panel: Panel, worst: WorstView) -> None:
    view = worst.view
    panel.hspan(-BAND_SDS, BAND_SDS, color="#DDDDDD", zorder=0)
    panel.hline(0.0, color="black", lw=0.6)
    for name, dash in DASHES.items():
        if name in view.models:
            panel.plot(view.input, view.deviation(name)[worst.side], dash, color=MODEL_COLOURS[name], lw=1.2)
    panel.set_labels(view.input_label, None)
    panel.set_labels(None, "model − measured\n[sd of the noise]", 6.5)
    panel.x.set_locator(ticks(6))
    panel.y.set_locator(ticks(4))


def _handles(worst: Sequence[WorstView]) -> list[Line2D | Patch]:
    models = worst[0].view.models if worst else {}
    out: list[Line2D | Patch] = [
        Line2D([], [], color="black", ls="", marker="o", ms=3, label="measured"),
        Line2D([], [], color=style.PALETTE["grey"], lw=0.8, label="its branches, input rising and falling"),
        Patch(color="#BBBBBB", label=f"±{BAND_SDS:g} sd of the noise"),
    ]
    out += [
        Line2D([], [], color=MODEL_COLOURS[m], ls=dash, lw=1.4, label=MODEL_LABELS[m])
        for m, dash in DASHES.items()
        if m in models
    ]
    return out
