"""The report that puts the example's matrix beside the published one: solves, asserts, draws."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import pandas as pd
import pytest

REPORTS = Path(__file__).parents[2] / "reports"


@pytest.fixture(scope="module")
def report() -> ModuleType:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(REPORTS))
        return importlib.import_module("appendix_c")


def test_agreement_is_that_of_independent_solvers_and_as_committed(report: ModuleType) -> None:
    found = report.agreement()
    report.check(found)
    committed = pd.read_csv(REPORTS / "appendix_c.csv", index_col="characteristic")
    for column in ("absolute", "absolute_without_slips", "signed"):
        pd.testing.assert_series_equal(found.table[column], committed[column], atol=2e-3, rtol=0.0)
    figure = report.side_by_side(found)
    assert [ax.get_title() for ax in figure.axes[:2]] == ["Published (thesis, Appendix C)", "This example"]


def test_check_fails_for_a_worse_matrix(report: ModuleType) -> None:
    published = pd.read_csv(report.PUBLISHED, index_col="parameter").astype(float)
    worse = published.sample(frac=1.0, random_state=1).set_index(published.index)
    rows = [report._column(c, worse[c], published[c]) for c in published]
    table = pd.DataFrame(rows).set_index("characteristic")
    with pytest.raises(AssertionError):
        report.check(report.Agreement(published, worse, table, 0.9))


def test_published_slip_rows_repeat_their_neighbour(report: ModuleType) -> None:
    published = pd.read_csv(report.PUBLISHED, index_col="parameter")
    for slip in report.SLIPS:
        difference = published.loc[slip] - published.loc[slip.replace("Tz", "Fy")]
        assert difference.abs().max() <= 1, slip


def test_published_matrix_is_complete(report: ModuleType) -> None:
    published = pd.read_csv(report.PUBLISHED, index_col="parameter")
    assert published.shape == (57, 21)
    assert (published.abs().max() == 100).all()
