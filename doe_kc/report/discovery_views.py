"""Measured curves beside those of the nominal, the re-tuned and the extended model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.likelihood import Branches, CurveData
from doe_kc.discovery.result import Discovery
from doe_kc.ground.typing import FloatArray


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
