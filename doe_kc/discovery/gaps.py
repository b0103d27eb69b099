"""How large the gap between model and records is, before and after, per load case and response."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import CurveGap, Gap, Returned
from doe_kc.discovery.thresholds import RETURNS_FROM
from doe_kc.ground.typing import FloatArray


def gaps(
    likelihood: Likelihood, nominal: FloatArray, tuned: Fit, final: Fit, decoy: Fit | None
) -> tuple[Gap, tuple[CurveGap, ...]]:
    """Of all records together, and of each load case and response."""
    rows: dict[tuple[str, str], list[int]] = {}
    for curve, place in likelihood.slices():
        at = rows.setdefault((curve.load_case, curve.response), [])
        at.extend(range(place.start, place.stop))
    residuals: Mapping[str, FloatArray | None] = {
        "nominal": nominal,
        "tuned": tuned.residual,
        "with_effect": final.residual,
        "best_decoy": None if decoy is None else decoy.residual,
    }

    def gap(places: slice | list[int], floor: float) -> Gap:
        found = {k: float("nan") if r is None else _rms(r[places]) for k, r in residuals.items()}
        return Gap(noise_floor=floor, **found)

    whole = gap(slice(None), noise_floor(final))
    return whole, tuple(CurveGap(c, r, gap(at, 1.0)) for (c, r), at in rows.items())


def noise_floor(final: Fit) -> float:
    """Whitened RMS expected of the right model: sqrt(1 - parameters used / data)."""
    used = float(np.sum(1.0 - np.diag(final.covariance) / final.model.prior_sd**2))
    return float(np.sqrt(max(0.0, 1.0 - used / final.residual.size)))


def _rms(residual: FloatArray) -> float:
    return float(np.sqrt(np.mean(residual**2)))


def returned(tuned: Fit, final: Fit) -> tuple[Returned, ...]:
    """Parameters that the re-tuned model had moved and that go back once the effects are there."""
    model = final.model
    count = model.parameters
    before = (tuned.z[:count] - model.centre[:count]) / model.prior_sd[:count]
    after = (final.z[:count] - model.centre[:count]) / model.prior_sd[:count]
    nominal = model.space.values(model.centre[:count])
    one, two = model.space.values(tuned.z[:count]), model.space.values(final.z[:count])
    out = [
        Returned(
            v.path,
            nominal[v.path],
            one[v.path],
            two[v.path],
            v.unit,
            float(before[i]),
            float(after[i]),
        )
        for i, v in enumerate(model.space.variables)
        if abs(before[i]) >= RETURNS_FROM and abs(after[i]) < abs(before[i])
    ]
    return tuple(sorted(out, key=lambda r: abs(r.with_effect_distance) - abs(r.tuned_distance)))
