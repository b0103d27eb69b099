"""Measured curves beside those of the nominal, the re-tuned and the extended model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.likelihood import Branches, CurveData
from doe_kc.discovery.result import Discovery
from doe_kc.typing import FloatArray


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


def residuals(found: Discovery) -> dict[str, FloatArray]:
    """(M,) whitened residual of every model that there is, by the names of `Gap`."""
    out = {"nominal": found.nominal, "tuned": found.search.tuned.residual}
    if found.fitted.model.members:
        out["with_effect"] = found.fitted.residual
    if found.decoy is not None:
        out["best_decoy"] = found.decoy.fit.residual
    return out


def model_views(found: Discovery) -> dict[tuple[str, str, Branches], ModelView]:
    """Every load case and response of the records, by (load case, response, branches)."""
    pairs: dict[tuple[str, str, Branches], list[tuple[CurveData, slice]]] = {}
    for curve, place in found.fitted.model.likelihood.slices():
        pairs.setdefault((curve.load_case, curve.response, curve.branches), []).append((curve, place))
    each = residuals(found)
    cases = found.fitted.model.axle.load_cases
    labels = {name: f"{case.input_label} [{case.unit}]" for name, case in cases.items()}
    return {key: _view(key, labels[key[0]], members, each) for key, members in pairs.items()}


def _view(
    key: tuple[str, str, Branches],
    label: str,
    members: list[tuple[CurveData, slice]],
    each: Mapping[str, FloatArray],
) -> ModelView:
    curves = [c for c, _ in members]
    models = {
        name: np.array([c.value + c.root @ residual[place] for c, place in members])
        for name, residual in each.items()
    }
    measured, level = np.array([c.value for c in curves]), np.array([c.level for c in curves])
    return ModelView(*key, label, curves[0].input, measured, level, models)
