"""Traces of other effects that are not seen widen what is said of a size, no more than they could be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.thresholds import PRESENT
from doe_kc.discovery.unseen import unseen
from tests.discovery.cases import discovery


def test_each_trace_moves_a_size_as_a_refit_to_first_order_says() -> None:
    found = discovery("named").search
    (one,) = [s for s in found.steps[-1].screened if s.hypothesis.effect == "strut_bending"]
    last = replace(found.steps[-1], screened=(one,))
    alone = replace(found, steps=(*found.steps[:-1], last))
    final = found.final
    share = min(PRESENT, 4.0 / one.detectability)
    weight = np.diag(final.model.prior_sd**-1.0)
    stacked = np.vstack([final.jacobian, weight])
    change = np.concatenate([share * one.change, np.zeros(final.z.size)])
    moved = np.linalg.lstsq(stacked, change, rcond=None)[0][final.model.dimension :]
    assert unseen(alone) == pytest.approx(np.abs(moved), rel=1e-6)
    assert np.all(unseen(found) >= unseen(alone) * (1.0 - 1e-12))


def test_with_nothing_else_in_the_library_nothing_is_added() -> None:
    found = discovery("named").search
    last = replace(found.steps[-1], screened=())
    assert not unseen(replace(found, steps=(*found.steps[:-1], last))).any()
