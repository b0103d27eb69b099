"""Which further load case would tell two explanations apart that these records do not.

What one explanation predicts is taken for the record of the other, after both were fitted to the records
that there are. Separation z^2 = d' (I + J S J')^-1 d, d the difference in the records' errors, J the other's
derivatives and S its covariance: what is left when it is re-tuned with the further load case.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag, cho_factor, cho_solve

from doe_kc.correlation.curve_data import CurveData
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.derivatives import own_columns
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import AMPLITUDE_FACTOR, TEST_WORTH, TESTS_LISTED
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LOAD_CASES, LoadCase
from doe_kc.load_cases.force import LateralOffset
from doe_kc.solver.result import NotConverged


@dataclass(frozen=True)
class ExtraTest:
    """A further load case that would tell two explanations apart."""

    words: str
    """The load case in words."""
    separation: float
    """Standard deviations between the two explanations, the other one re-tuned."""
    case: LoadCase
    """The load case to run."""


def extra_tests(one: Fit, other: Fit) -> tuple[ExtraTest, ...]:
    """Further load cases that separate two fits, best first; none when no load case does."""
    tests = []
    for words, case, like in _candidates(one.model):
        try:
            tests.append(ExtraTest(words, _separation(one, other, case, like), case))
        except NotConverged:
            continue
    tests.sort(key=lambda t: -t.separation)
    return tuple(t for t in tests[:TESTS_LISTED] if t.separation >= TEST_WORTH)


def _candidates(model: EffectModel) -> Iterator[tuple[str, LoadCase, str]]:
    """Words, the load case, and the measured one whose errors it is given."""
    cases = model.axle.load_cases
    for ident, case in cases.items():
        more = case.amplitude * AMPLITUDE_FACTOR
        yield f"{ident} up to {more:.4g} {case.unit}", replace(case, amplitude=more), ident
        if isinstance(case, LateralOffset):
            for offset in (-case.offset, 2.0 * case.offset):
                where = "ahead of" if offset < 0 else "behind"
                words = f"{ident} with the force {abs(offset):.4g} mm {where} the contact point"
                yield words, replace(case, offset=offset), ident
    for ident, case in LOAD_CASES.items():
        alike = [k for k, c in cases.items() if c.unit == case.unit]
        if ident not in cases and alike:
            yield ident, replace(case, conditioning=model.axle.conditioning), alike[0]


def _separation(one: Fit, other: Fit, case: LoadCase, like: str) -> float:
    likelihood = _predicted(one, case, like)
    model = _alone(other.model, case, likelihood)
    free, count = model.dimension - model.parameters, model.parameters
    z = _point(model, other)
    difference = model.residual(z)
    jacobian = own_columns(model, z, difference)
    kept = np.r_[0:count, other.model.dimension : other.z.size]
    known = other.covariance[np.ix_(kept, kept)]
    covariance = block_diag(known[:count, :count], np.eye(free), known[count:, count:])
    covariance[:count, count + free :] = known[:count, count:]
    covariance[count + free :, :count] = known[count:, :count]
    total = np.eye(difference.size) + jacobian @ covariance @ jacobian.T
    return float(np.sqrt(difference @ cho_solve(cho_factor(total), difference)))


def _predicted(fit: Fit, case: LoadCase, like: str) -> Likelihood:
    """What a fit predicts of a load case, with the errors of the measured one at the same relative input."""
    measured = [c for c in fit.model.likelihood.curves if c.load_case == like]
    largest = fit.model.axle.load_cases[like].amplitude
    curves = tuple(
        replace(c, load_case=case.id, input=c.input * case.amplitude / largest, value=np.zeros(c.size))
        for c in measured
    )
    empty = Likelihood(curves, ())
    model = _alone(fit.model, case, empty)
    whitened = model.residual(_point(model, fit))
    values = [_valued(c, whitened[at]) for c, at in empty.slices()]
    return Likelihood(tuple(values), ())


def _point(model: EffectModel, fit: Fit) -> FloatArray:
    """The fit's parameters and amplitudes in a model of one load case, whose nuisances are its own."""
    nuisances = np.zeros(model.dimension - model.parameters)
    return np.concatenate([fit.z[: model.parameters], nuisances, fit.z[fit.model.dimension :]])


def _valued(curve: CurveData, whitened: FloatArray) -> CurveData:
    return replace(curve, value=np.asarray(curve.root @ whitened))


def _alone(model: EffectModel, case: LoadCase, likelihood: Likelihood) -> EffectModel:
    """The model with nothing but one load case."""
    axle = replace(model.axle, load_cases={case.id: case})
    return replace(model, axle=axle, likelihood=likelihood, nuisances=None, left_out=None)
