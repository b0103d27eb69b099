"""Fits and screenings come back from their arrays as they were."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from doe_kc.discovery.result_arrays import (
    fit_arrays,
    fit_of_arrays,
    screening_arrays,
    screening_of_arrays,
)
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import discovery


def test_a_fit_comes_back() -> None:
    fit = discovery("named").search.with_effects
    again = fit_of_arrays(fit.model, fit_arrays(fit))
    assert again is not None and again.cost == fit.cost and again.converged == fit.converged
    assert np.array_equal(again.z, fit.z) and np.array_equal(again.residual, fit.residual)
    assert np.array_equal(again.jacobian.own, fit.jacobian.own) and again.evaluations == fit.evaluations


def test_one_without_an_equilibrium_is_none() -> None:
    model = discovery("named").search.with_effects.model
    assert fit_of_arrays(model, fit_arrays(None)) is None


def test_a_screening_comes_back() -> None:
    for screening in discovery("named").search.screened[:5]:
        again = screening_of_arrays(screening.hypothesis, screening_arrays(screening))
        for field in fields(screening):
            one, other = getattr(again, field.name), getattr(screening, field.name)
            numeric = not isinstance(one, (str, Hypothesis))
            assert np.array_equal(one, other, equal_nan=numeric), field.name
