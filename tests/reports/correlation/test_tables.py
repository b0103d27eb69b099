"""Tables of a correlation against the definitions of the appendices."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from doe_kc.axle import parameter_value
from doe_kc.correlation.result import Correlation
from doe_kc.reports.correlation.characteristics import characteristic_rows, characteristic_table
from doe_kc.reports.correlation.evaluations import evaluation_table, history
from doe_kc.reports.correlation.parameters import parameter_rows, parameter_table, remark_sentences
from doe_kc.reports.correlation.summary import summary
from doe_kc.reports.correlation.terms import curve_table, term_columns
from doe_kc.reports.render.csv import table_frame
from tests.reports.correlations import all_three, odd, real, typed

NAMES = ("real", "odd", "typed")


@pytest.fixture(params=NAMES)
def found(request: pytest.FixtureRequest) -> Correlation:
    return all_three()[request.param]


def by(frame: pd.DataFrame, key: str) -> dict[str, dict[str, object]]:
    return {str(r[key]): r for r in frame.to_dict("records")}


def test_parameters_hold_the_values_of_the_axles(found: Correlation) -> None:
    frame = table_frame(parameter_table(found))
    for row in frame.to_dict("records"):
        assert row["final"] == pytest.approx(parameter_value(found.axle, row["path"]), abs=1e-12)
        assert row["change"] == row["final"] - row["baseline"]
        if row["role"] == "variable":
            assert row["lower"] <= row["final"] <= row["upper"]
    assert list(frame["path"]) == list(found.values)


def test_sd_is_in_the_parameters_unit() -> None:
    case, rows = real().problem, parameter_rows(real())
    seen = real().posterior
    assert seen is not None
    for i, variable in enumerate(case.space.variables):
        step = 1e-6
        slope = (variable.value(rows[i].place + step) - variable.value(rows[i].place - step)) / (2 * step)
        assert rows[i].sd == pytest.approx(seen.sd[i] * slope, rel=1e-6)
        assert rows[i].visible == (seen.sd[i] <= 0.5 * variable.prior_sd)


def test_bounds_ties_and_fixed_ones_are_marked() -> None:
    rows = by(table_frame(parameter_table(odd())), "path")
    assert (rows["llf.Fy"]["at_bound"], rows["llr.Fy"]["at_bound"]) == ("lower", "upper")
    assert [p for p, r in rows.items() if r["at_bound"]] == ["llf.Fy", "llr.Fy"]
    assert (rows["sfr.Fy"]["role"], rows["sfr.Fy"]["tied_to"]) == ("tied", "sff.Fy")
    assert rows["sfr.Fy"]["final"] == rows["sff.Fy"]["final"]
    assert rows["sfr.Fy"]["sd"] == rows["sff.Fy"]["sd"]
    assert (rows["ride_height"]["role"], rows["ride_height"]["final"]) == ("fixed", 1.5)
    text = " ".join(remark_sentences(odd()))
    assert "2 of 18 variables end at a bound: llf.Fy (lower), llr.Fy (upper)" in text
    assert "LLF.x" in text.split("not visible")[1]


def test_of_many_variables_that_are_not_visible_the_first_are_named() -> None:
    unseen = [r.path for r in parameter_rows(real()) if r.visible is False]
    assert len(unseen) > 20
    (text,) = (t for t in remark_sentences(real()) if "not visible" in t)
    named, more = text.split(": ")[1].split(" and ")
    assert named.split(", ") == unseen[:12]
    assert more.startswith(f"{len(unseen) - 12} more (not_visible in parameters.csv).")


def test_without_posterior_nothing_is_said_of_visibility() -> None:
    frame = table_frame(parameter_table(typed()))
    assert frame["sd"].isna().all() and (frame["not_visible"] == "").all()
    assert "No standard deviations" in remark_sentences(typed())[-1]


def test_improvement_is_appendix_d(found: Correlation) -> None:
    for r in table_frame(characteristic_table(found)).to_dict("records"):
        before, after = abs(r["baseline"] - r["target"]), abs(r["final"] - r["target"])
        if before:
            assert r["improvement_percent"] == pytest.approx(100 * (1 - after / before))
        assert r["inside"] == (r["low"] <= r["final"] <= r["high"])
        if r["target_sd"]:
            assert r["final_distance_sd"] * r["target_sd"] == pytest.approx(r["final"] - r["target"])
    assert sorted(r.id for r in characteristic_rows(found)) == sorted(
        t.entry.id for t in found.problem.targets.characteristics
    )


def test_normalised_values_are_ratios_away_from_zero_and_soft_near_it() -> None:
    rows = by(table_frame(characteristic_table(real())), "id")
    caster, toe = rows["static.caster"], rows["static.toe"]
    assert caster["baseline_normalized"] == pytest.approx(caster["baseline"] / caster["target"], abs=1e-3)
    assert toe["target"] == pytest.approx(0.027)
    for row in characteristic_rows(real()):
        places = sorted(row.normalized(v) for v in row.interval)
        assert places == pytest.approx([0.85, 1.15], abs=1e-9)
    camber = next(r for r in characteristic_rows(real()) if r.id == "static.camber")
    assert camber.entry.target.value < 0 and camber.normalized(1.2 * camber.entry.target.value) > 1.0


def test_terms_sum_to_the_rating(found: Correlation) -> None:
    terms = term_columns(found)
    assert sum(terms["final_term"]) == pytest.approx(found.rating, rel=1e-12)
    assert sum(terms["baseline_term"]) == pytest.approx(found.baseline.merit, rel=1e-12)


def test_curves_come_with_their_noise() -> None:
    frame = table_frame(curve_table(real()))
    assert len(frame) == len(real().problem.targets.curves) > 10
    assert (frame["rms_final"] < frame["rms_baseline"]).all()
    assert (frame["rms_final"] / frame["noise_rms"]).median() < 2.0
    assert (
        list(table_frame(curve_table(typed())).columns) == list(frame.columns)
        and table_frame(curve_table(typed())).empty
    )


def test_evaluations_tell_failures_predictions_and_the_best_so_far() -> None:
    frame = table_frame(evaluation_table(odd()))
    assert list(frame["evaluation"]) == list(range(1, 11))
    assert list(np.flatnonzero(frame["failed_because"] != "")) == [2, 6]
    assert frame["merit"].isna().sum() == 2
    assert frame["predicted_merit"].notna().sum() == 6
    best = frame["merit"].cummax().ffill()
    np.testing.assert_allclose(frame["best_so_far"], best)
    assert frame["chosen"].sum() == 1 and frame["chosen"][odd().run.best]
    row = frame.iloc[odd().run.best]
    for path in odd().problem.space.paths:
        assert row[path] == odd().values[path]
    assert history(odd()).first_feasible is None and history(real()).first_feasible == 2


def test_summary_says_what_is_violated() -> None:
    lines = summary(odd())
    assert "vertical.bump_steer" in lines["Constraints"] and "2 had no equilibrium" in lines["Evaluations"]
    assert summary(real())["Constraints"] == "all met" and summary(real())["Beforehand"].startswith(
        "ride_height"
    )
