"""The rig's own errors, scaled as parts of all errors and estimated from what a fit leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit, rewhitened_fit
from doe_kc.discovery.search.law_discrepancy import marginal
from doe_kc.discovery.verdict.systematic_errors import (
    SYSTEMATIC_ERRORS,
    systematic_scales,
    with_systematic_errors,
)
from tests.discovery.cases import discovery


@pytest.fixture(scope="module")
def last() -> Fit:
    return discovery("pair").search.with_law_discrepancy


def drawn(fit: Fit, scales: dict[str, float]) -> Fit:
    """The fit to what it says itself, with errors of these scales in place of those in its records."""
    rng = np.random.default_rng(7)
    residual = fit.residual.copy()
    for curve, place in with_systematic_errors(fit.model.likelihood, scales).slices():
        residual[place] = curve.root @ rng.standard_normal(curve.size)
    for curve, place in fit.model.likelihood.slices():
        residual[place] = curve.whitened(residual[place])
    return replace(fit, residual=residual)


def test_only_the_systematic_parts_change(last: Fit) -> None:
    likelihood = last.model.likelihood
    for kind in SYSTEMATIC_ERRORS:
        assert any(kind in c.systematic for c in likelihood.curves)
        for before, after in zip(
            likelihood.curves, with_systematic_errors(likelihood, {kind: 0.5}).curves, strict=True
        ):
            part = before.systematic.get(kind, np.zeros(before.size))
            less = before.root @ before.root.T - after.root @ after.root.T
            np.testing.assert_allclose(
                less, 0.75 * np.outer(part, part), atol=1e-9 * np.max(np.diag(before.root) ** 2)
            )


def test_a_scale_is_of_what_the_errors_hold(last: Fit) -> None:
    likelihood = last.model.likelihood
    half = dict.fromkeys(SYSTEMATIC_ERRORS, 0.5)
    twice = dict.fromkeys(SYSTEMATIC_ERRORS, 2.0)
    back = with_systematic_errors(with_systematic_errors(likelihood, half), twice)
    for before, after in zip(likelihood.curves, back.curves, strict=True):
        np.testing.assert_allclose(
            after.root, before.root, atol=1e-8 * np.max(before.root), err_msg=before.response
        )


@pytest.mark.parametrize("scale", [0.1, 0.5, 1.0, 2.0])
def test_a_rig_s_hysteresis_is_found(last: Fit, scale: float) -> None:
    """Of a hundred loops, to the next step of the scale."""
    found = systematic_scales(drawn(last, {"hysteresis": scale}))["hysteresis"]
    assert 0.65 * scale <= found <= 1.5 * scale


def test_it_is_the_scale_of_the_largest_evidence(last: Fit) -> None:
    scales = systematic_scales(last)

    def evidence(scales: dict[str, float]) -> float:
        errors = with_systematic_errors(last.model.likelihood, scales)
        return marginal(rewhitened_fit(last, errors))

    best = evidence(scales)
    for kind in SYSTEMATIC_ERRORS:
        for factor in (0.5, 1.0, 2.0):
            assert evidence({**scales, kind: factor * scales[kind]}) <= best + 0.5
