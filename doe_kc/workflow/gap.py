"""How far the axle handed in and the one handed over are from the records, together and by load case."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from doe_kc.correlation.answer_record import CaseGap, GapRecord
from doe_kc.correlation.likelihood import Likelihood, record_likelihood
from doe_kc.correlation.result import Correlation
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.model import NO_CHARACTERISTICS
from doe_kc.discovery.result import Discovery
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.workflow.discover import recorded


def answer_gap(
    study: Study, measurement: Measurement, correlation: Correlation, discovery: Discovery | None
) -> GapRecord | None:
    """The gap of the records before and after. With a discovery, the calibrations of the rig, the differences
    between the wheels and the traces of effects are the most probable ones beside the axle handed over."""
    before, after = correlation.baseline.outcome.curves, correlation.best.outcome.curves
    if before is None or after is None:
        return None
    if discovery is not None:
        fitted, known = discovery.fitted, discovery.gap
        if correlation.problem.exact:
            left = fitted.model.residual_of(recorded(correlation.axle, measurement), fitted.z)
            final = beside_nuisances(fitted, left, fitted.z)
        else:
            left = fitted.model.likelihood.residual(after, NO_CHARACTERISTICS)
            final = beside_nuisances(fitted, left, fitted.model.centre)
        return GapRecord(
            nominal=known.nominal,
            tuned=known.tuned,
            final=_rms(final),
            noise_floor=known.noise_floor,
            cases=_case_gaps(fitted.model.likelihood, discovery.nominal, final),
        )
    data = record_likelihood(study.axle, measurement)
    if not data.curves:
        return None
    first, last = (data.residual(curves, NO_CHARACTERISTICS) for curves in (before, after))
    return GapRecord(
        nominal=_rms(first),
        tuned=None,
        final=_rms(last),
        noise_floor=1.0,
        cases=_case_gaps(data, first, last),
    )


def beside_nuisances(fit: Fit, residual: FloatArray, z: FloatArray) -> FloatArray:
    """(M,) residuals of an axle with the most probable calibrations and linear nuisances beside it.

    Along the derivatives J of the fit, min |r + J dz|^2 + |z + dz|^2, their priors of standard deviation 1.
    residual: (M,) r, with the nuisances as at z (d + m,).
    """
    nuisances = slice(fit.model.calibrations.start, fit.model.dimension)
    rows, start = fit.jacobian.rows(slice(None))[:, nuisances], z[nuisances]
    hessian = rows.T @ rows + np.eye(start.size)
    step = cho_solve(cho_factor(hessian), -(rows.T @ residual + start))
    return np.asarray(residual + rows @ step)


def _case_gaps(data: Likelihood, before: FloatArray, after: FloatArray) -> dict[str, CaseGap]:
    """Load case -> its gap; static angles under `static`. before, after: (M,) residuals of the same data."""
    places: dict[str, list[int]] = {}
    end = 0
    for curve, place in data.slices():
        places.setdefault(curve.load_case, []).extend(range(place.start, place.stop))
        end = place.stop
    if end < before.size:
        places["static"] = list(range(end, before.size))
    return {case: CaseGap(nominal=_rms(before[at]), final=_rms(after[at])) for case, at in places.items()}


def _rms(residual: FloatArray) -> float:
    return float(np.sqrt(np.mean(residual**2)))
