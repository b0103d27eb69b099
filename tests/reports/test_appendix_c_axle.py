"""The axle identified from the published matrix: the stored one has the figures that its report states."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import numpy as np
import pandas as pd
import pytest

REPORTS = Path(__file__).parents[2] / "reports"


@pytest.fixture(scope="module")
def checks() -> ModuleType:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(REPORTS))
        return importlib.import_module("appendix_c_checks")


@pytest.fixture(scope="module")
def published(checks: ModuleType) -> pd.DataFrame:
    return checks.published()


@pytest.fixture(scope="module")
def own(checks: ModuleType, published: pd.DataFrame) -> pd.DataFrame:
    return checks.identified_matrix(published.index)


def test_the_stored_axle_has_the_published_matrix(
    checks: ModuleType, published: pd.DataFrame, own: pd.DataFrame
) -> None:
    turned, cells = checks.x_reversed(published), checks.counted(published)
    assert (~cells).to_numpy().sum() == 3 * 21 + 11
    table = checks.compare(own, turned, cells)
    magnitude, signed = table.means
    assert magnitude >= 0.980 and signed >= 0.982
    committed = pd.read_csv(REPORTS / "appendix_c_axle.csv", index_col="characteristic")
    assert list(committed.index) == list(published)
    np.testing.assert_allclose(table.magnitude, committed["magnitude"], atol=1e-3)
    np.testing.assert_allclose(table.signed, committed["signed"], atol=1e-3)
    fits = pd.read_csv(REPORTS / "appendix_c_axle_fits.csv", index_col="fit").loc["all columns"]
    assert (magnitude, signed) == pytest.approx((fits.magnitude_seen, fits.signed_seen), abs=1e-3)
    everything = checks.compare(own, turned)
    assert min(everything.means) >= 0.925 and everything.means[1] > checks.compare(own, published).means[1]


def test_reversed_rows_have_the_signs_of_the_axle(
    checks: ModuleType, published: pd.DataFrame, own: pd.DataFrame
) -> None:
    turned, cells = checks.x_reversed(published), checks.counted(published)
    assert checks.equal_signs(own, turned, cells) == (90, 90)
    assert checks.equal_signs(own, published, cells) == (67, 90)
    assert checks.caster_of_column(published) == pytest.approx(-4.0, abs=0.1)
    assert checks.caster_of_column(turned) == pytest.approx(4.0, abs=0.1)


def test_cells_that_lost_a_digit_are_off_the_grid_or_break_a_sum(
    checks: ModuleType, published: pd.DataFrame, own: pd.DataFrame
) -> None:
    off = set(checks.off_grid(published.drop(index=list(checks.SLIPS))))
    assert len(off) == 6 and off < set(checks.LOST_DIGITS)
    broken = {(s.column, s.axis) for s in checks.group_sums(published) if s.beyond}
    for row, column in checks.LOST_DIGITS:
        assert (row, column) in off or (column, row.split()[1]) in broken
    turned, cells = checks.x_reversed(published), checks.counted(published)
    predicted = checks.in_published_units(own, turned, cells)
    for row, column in checks.LOST_DIGITS:
        printed, seen = turned.loc[row, column], predicted.loc[row, column]
        assert np.sign(printed) == np.sign(seen), (row, column)
        near = min(checks.with_one_digit_more(printed, column), key=lambda n: abs(n - abs(seen)))
        assert abs(near - abs(seen)) <= max(2.0, 1.5 * checks.step(column)) < abs(seen), (row, column)


def test_where_a_sum_is_broken_that_of_the_axle_is_not(
    checks: ModuleType, published: pd.DataFrame, own: pd.DataFrame
) -> None:
    """The nine hardpoints are not all points of the axle, so that their sums are not quite zero."""
    broken = [s for s in checks.group_sums(published) if s.beyond]
    whole = {(s.column, s.axis): s.total for s in checks.group_sums(own)}
    assert len(broken) == 8
    for entry in broken:
        assert abs(whole[entry.column, entry.axis]) < min(8.0, 0.4 * abs(entry.total)), entry


def test_the_ceiling_is_above_the_axle(
    checks: ModuleType, published: pd.DataFrame, own: pd.DataFrame, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(checks, "CEILING_DRAWS", 40)
    magnitude, signed = checks.rounding_ceiling(own, checks.counted(published))
    assert 0.985 < magnitude < 0.996 and 0.985 < signed < 0.996


def test_the_report_says_what_is_stored(checks: ModuleType) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(REPORTS))
        text = importlib.import_module("appendix_c_axle_text")
    assert text.markdown(REPORTS) == (REPORTS / "appendix_c_axle.md").read_text("utf-8")
