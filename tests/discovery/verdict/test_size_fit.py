"""The fit that sizes are told of: its errors, its scatter and what it grants the laws."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.discovery.thresholds import DISCREPANCY_LENGTH, LAW_MIDDLE
from doe_kc.discovery.verdict.size_fit import size_fit
from doe_kc.discovery.verdict.systematic_errors import systematic_scales
from doe_kc.measurement.noise import smooth_correlation
from tests.discovery.cases import discovery


def test_it_has_the_errors_and_the_scatter_of_the_records() -> None:
    search = discovery("pair").search
    last = search.with_law_discrepancy
    found, shares = size_fit(search)
    assert found.converged
    assert found.model.members == last.model.members
    assert set(shares) == {h.name for h in last.model.members}
    assert found.model.own_scatter is not None
    scales = systematic_scales(last)
    assert min(scales.values()) < 0.5, "records made without a rig's hysteresis"
    for before, after in zip(
        search.with_effects.model.likelihood.curves, found.model.likelihood.curves, strict=True
    ):
        for kind, error in before.systematic.items():
            np.testing.assert_allclose(after.systematic[kind], scales[kind] * error)


def test_sizes_stay_within_what_was_assumed() -> None:
    """Narrower errors of the same records: no size moves by more than it was open by, each gets sharper."""
    search = discovery("pair").search
    last = search.with_law_discrepancy
    found, _ = size_fit(search)
    before, after = (np.sqrt(np.diag(f.covariance))[f.model.dimension :] for f in (last, found))
    assert np.all(np.abs(found.amplitudes - last.amplitudes) < 2.0 * before)
    assert np.all(after < 1.05 * before)


def test_the_middle_of_a_law_is_off_by_its_share_of_the_discrepancy() -> None:
    """A fit weighs a law by the square of what it makes, which grows with the input; its middle is a mean."""
    at = np.linspace(-1.0, 1.0, 41)
    centred = np.eye(at.size) - 1.0 / at.size
    balanced = centred @ smooth_correlation(at, DISCREPANCY_LENGTH) @ centred
    weights = at**2 / np.sum(at**2)
    assert np.sqrt(weights @ balanced @ weights) == pytest.approx(LAW_MIDDLE, rel=0.02)
