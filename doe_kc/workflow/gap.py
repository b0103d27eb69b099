"""How far the axle handed in and the one handed over are from the records, together and by load case."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.answer_record import CaseGap, GapRecord
from doe_kc.correlation.likelihood import Likelihood, record_likelihood
from doe_kc.correlation.result import Correlation
from doe_kc.curves import CurveSet
from doe_kc.discovery.model import NO_CHARACTERISTICS
from doe_kc.discovery.result import Discovery
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.workflow.discover import recorded


def answer_gap(
    study: Study, measurement: Measurement, correlation: Correlation, discovery: Discovery | None
) -> GapRecord | None:
    """The gap of the records before and after. A discovery's calibrations of the rig and differences between
    the wheels are taken as it found them."""
    before, after = correlation.baseline.outcome.curves, correlation.best.outcome.curves
    if before is None or after is None:
        return None
    if discovery is not None:
        fitted, known = discovery.fitted, discovery.gap
        if correlation.problem.exact:
            final = fitted.model.residual_of(recorded(correlation.axle, measurement), fitted.z)
        else:
            final = fitted.model.likelihood.residual(after, NO_CHARACTERISTICS)
        return GapRecord(
            nominal=known.nominal,
            tuned=known.tuned,
            final=_rms(final),
            noise_floor=known.noise_floor,
            cases=_case_gaps(fitted.model.likelihood, discovery.nominal, final),
        )
    data = record_likelihood(study.axle, measurement)

    def left(curves: CurveSet) -> FloatArray:
        return data.residual(curves, NO_CHARACTERISTICS)

    if not data.curves:
        return None
    first, last = left(before), left(after)
    return GapRecord(
        nominal=_rms(first),
        tuned=None,
        final=_rms(last),
        noise_floor=1.0,
        cases=_case_gaps(data, first, last),
    )


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
