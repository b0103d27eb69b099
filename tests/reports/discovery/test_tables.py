"""The numbers of a discovery as rows and words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.search.decision import HypothesisGain
from doe_kc.discovery.verdict.exclusion import HypothesisStatus, Status
from doe_kc.discovery.verdict.size_words import size_estimates, size_words
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.effects.words import hypothesis_label, place_words
from doe_kc.reports.discovery.curves import model_values, model_views, view_gaps
from doe_kc.reports.discovery.effects import effect_rows, effect_table
from doe_kc.reports.discovery.evidence import candidate_label, evidence_steps
from doe_kc.reports.discovery.heat_map import discovery_grids
from doe_kc.reports.discovery.isolability import (
    Isolability,
    isolability,
    isolability_rows,
)
from doe_kc.reports.discovery.library import LIBRARY_COLUMNS, LibraryRow, library_table
from doe_kc.reports.discovery.parameters import tuned_parameters, tuned_table
from doe_kc.reports.discovery.tables import disagreement_table, gap_table, held_out_table
from doe_kc.reports.discovery.words import headline, limit_words
from doe_kc.reports.render.csv import table_frame
from tests.discovery.cases import LOAD_CASES, discovery, library, records


def test_disagreement_has_every_contrast_and_every_map() -> None:
    found = discovery("named")
    frame = table_frame(disagreement_table(found))
    assert len(frame) == len(found.nominal_map.names)
    np.testing.assert_array_equal(frame["z_tuned"], found.tuned_map.z)
    np.testing.assert_array_equal(frame["z_with_effect"], found.residual_map.z)
    assert table_frame(disagreement_table(discovery("none")))["z_with_effect"].isna().all()


def test_a_grid_holds_the_largest_of_each_load_case_and_response() -> None:
    found = discovery("named")
    nominal, tuned, final = discovery_grids(found)
    frame = table_frame(disagreement_table(found))
    largest = frame.assign(size=frame["z_tuned"].abs()).groupby(["load_case", "response"])["size"].max()
    assert {key: abs(cell.z) for key, cell in tuned.cells.items()} == pytest.approx(largest.to_dict())
    assert nominal.cases == ["static", *LOAD_CASES]
    assert tuned.beyond > 0 and final.beyond == 0
    assert len(discovery_grids(discovery("none"))) == 2


def test_gaps_of_views_are_those_of_the_engine() -> None:
    found = discovery("named")
    frame = table_frame(gap_table(found)).set_index(["load_case", "response"])
    assert frame.loc[("all", "all"), "with_effect"] == pytest.approx(found.gap.with_effect)
    key = ("lateral", "camber")
    parts = [view_gaps(found)[(*key, branches)] for branches in ("mean", "half_width")]
    sizes = [model_views(found)[(*key, branches)].input.size for branches in ("mean", "half_width")]
    for model in ("nominal", "tuned", "with_effect", "best_decoy"):
        squares = sum(n * p[model] ** 2 for n, p in zip(sizes, parts, strict=True))
        assert np.sqrt(squares / sum(sizes)) == pytest.approx(frame.loc[key, model], rel=1e-6)
    assert table_frame(gap_table(discovery("none")))["with_effect"].isna().all()


def test_views_hold_the_measured_curves_and_the_models_own() -> None:
    found = discovery("named")
    view = model_views(found)[("lateral", "camber", "mean")]
    rig = records("named").curves.cases["lateral"]
    np.testing.assert_array_equal(view.measured[1], np.interp(view.input, rig.input, rig.mean["camber"][1]))
    axle = found.search.tuned.model.curves(found.search.tuned.model.centre).cases["lateral"]
    expected = np.interp(view.input, axle.input, axle.mean["camber"][0])
    np.testing.assert_allclose(view.models["nominal"][0], expected, atol=1e-9)
    assert np.abs(view.deviation("tuned")).max() > 5.0 > np.abs(view.deviation("with_effect")).max()
    assert set(model_values(discovery("none"))) == {"nominal", "tuned"}


def test_library_names_every_hypothesis_once() -> None:
    found = discovery("named")
    frame = table_frame(library_table(found))
    assert len(frame) == len(found.statuses)
    first = frame.iloc[0]
    assert (first["effect"], first["status"]) == ("hub_compliance", "found")
    excluded = frame[frame["status"] == "excluded"]
    assert (excluded["detectable_times_typical"] <= 1.0).all()
    assert excluded["detectable"].str.len().min() > 3
    assert frame["physics"].str.endswith(".").all()


def test_parameters_are_absolute_with_their_distances() -> None:
    found = discovery("named")
    rows = {p.path: p for p in tuned_parameters(found)}
    values = found.fitted.model.space.values(found.fitted.z[: found.fitted.model.parameters])
    assert rows["LLF.z"].with_effect == pytest.approx(values["LLF.z"])
    assert all(p.sd > 0 for p in rows.values())
    assert list(table_frame(tuned_table(found))["path"]) == list(found.fitted.model.space.paths)
    assert table_frame(tuned_table(discovery("none")))["with_effect"].isna().all()


def test_parameters_at_a_bound_are_said_so() -> None:
    found = discovery("named")
    tuned, final, paths = found.search.tuned, found.fitted, list(found.fitted.model.space.paths)

    def between(fit: Fit) -> np.ndarray:
        count, z = fit.model.parameters, fit.z.copy()
        z[:count] = 0.5 * (fit.model.lower + fit.model.upper)[:count]
        return z

    one, two = between(tuned), between(final)
    one[0], one[1], two[1] = tuned.model.lower[0], tuned.model.upper[1], final.model.lower[1]
    fits = {"tuned": replace(tuned, z=one), "with_effects": replace(final, z=two)}
    moved = replace(found, search=replace(found.search, **fits))
    rows = {p.path: p.bound_words for p in tuned_parameters(moved) if p.bound_words}
    assert rows == {
        paths[0]: "re-tuned at its lower",
        paths[1]: "re-tuned at its upper; with the effect at its lower",
    }
    assert not any("effect" in p.bound_words for p in tuned_parameters(discovery("none")))


def test_sizes_that_are_of_no_use_are_not_spelled_out() -> None:
    (column,) = (c for c in LIBRARY_COLUMNS if c.key == "detectable_times_typical")
    row = library_table(discovery("named")).rows[0]
    said = [column.read(replace(row, status=replace(row.status, detectable=v))) for v in (99.0, 17337.0)]
    assert said == [99.0, "> 100"]


def test_held_out_has_a_row_a_load_case() -> None:
    assert list(table_frame(held_out_table(discovery("named")))["load_case"]) == list(LOAD_CASES)
    assert table_frame(held_out_table(discovery("none"))).empty


@pytest.mark.parametrize(
    ("car", "kinds"),
    [
        ("none", []),
        ("named", ["found"]),
        ("lead", ["lead only"]),
        ("class", ["most likely"]),
        ("two", ["found"]),
    ],
)
def test_effects_have_a_row_for_each_number(car: str, kinds: list[str]) -> None:
    found = discovery(car)
    rows = effect_rows(found)
    assert sorted({r.kind for r in rows if r.finding.relevant}) == kinds
    sizes = sum(max(1, len(f.estimates)) for f in (*found.findings, *found.traces))
    assert len(table_frame(effect_table(found))) == len(rows) == sizes


def test_the_headline_says_whether_several_effects_are_named() -> None:
    one = discovery("named")
    (finding,) = one.findings
    assert headline(one) == "Effect named"
    assert headline(replace(one, findings=(finding, finding))) == "Effects named"
    assert headline(replace(one, verdict="unexplained", findings=(finding, finding))) == "Unexplained"


def test_a_size_that_cannot_be_told_from_none_is_a_limit() -> None:
    found = discovery("named")  # its car's hub is rigid in toe for these load cases
    camber, toe = size_estimates(found.findings[0])
    assert camber.seen and "±" in camber.words
    assert not toe.seen
    limited = replace(toe, estimate=replace(toe.estimate, limit=20000.0, shown=True))
    assert not limited.seen and limited.words == "not told from rigid (above 20000 Nm/deg, 95 %)"
    unshown = replace(toe, estimate=replace(toe.estimate, limit=None, shown=False))
    assert not unshown.seen and unshown.words == "not shown by these records"
    assert size_words(found.findings[0]).startswith("camber_Nm_deg = ")


def test_the_sheet_has_no_number_for_a_size_that_is_not_told() -> None:
    """Beside "not shown by these records" a value with its standard deviation would be taken for one."""
    table = effect_table(discovery("named"))
    camber, toe = table.rows[:2]
    for key in ("value", "sd"):
        (column,) = (c for c in table.columns if c.key == key)
        assert column.in_sheet(camber) == column.value(camber)
        assert np.isnan(column.in_sheet(toe)) and np.isfinite(column.value(toe))
    assert camber.size is not None
    assert camber.times_typical == pytest.approx(camber.size.size.typical / camber.value)
    assert np.isnan(toe.times_typical)


def test_the_sheet_says_once_what_an_effect_is() -> None:
    table = effect_table(discovery("named"))
    for key in ("physics", "shown_by", "mistaken_for"):
        (column,) = (c for c in table.columns if c.key == key)
        first, second = table.rows[:2]
        assert column.in_sheet(first) == column.value(first) == column.value(second)
        assert column.in_sheet(second) == ""


def test_steps_are_ranked_and_the_last_takes_nothing() -> None:
    steps = evidence_steps(discovery("two"))
    assert [sum(c.accepted for c in s.candidates) for s in steps][-1] == 0
    for step in steps:
        gains = [c.gain for c in step.candidates if c.refitted]
        assert gains == sorted(gains, reverse=True)
    assert steps[0].candidates[0].label == "Strut friction"


def test_a_candidate_of_several_effects_says_so() -> None:
    """The first step of a car with five had a compliant hub twice, and neither was told to come in with the
    friction of the strut."""
    hub, friction, bending = library("hub_compliance", "steering_friction", "strut_bending")
    alone = HypothesisGain(hub, 9.0, True)
    assert candidate_label(alone) == "Hub and wheel-bearing compliance"
    pair = replace(alone, beside=(friction,))
    assert candidate_label(pair) == "Hub and wheel-bearing compliance + steering friction"
    assert candidate_label(replace(pair, beside=(friction, bending))).endswith("compliance + 2 others")


def test_isolability_is_a_symmetric_table_of_all_hypotheses() -> None:
    found = discovery("two")
    table = isolability(found)
    assert len(table.labels) == len(found.statuses) == table.correlation.shape[0]
    seen = ~np.isnan(np.diag(table.correlation))
    np.testing.assert_allclose(np.diag(table.correlation)[seen], 1.0)
    np.testing.assert_array_equal(table.correlation, table.correlation.T)
    assert "found" in table.statuses


def test_effects_of_which_every_pair_is_alike_are_one_group() -> None:
    r = np.eye(6)
    for i, j, value in ((0, 1, 0.95), (1, 2, 0.9), (0, 2, 0.3), (3, 4, 0.99)):
        r[i, j] = r[j, i] = value
    r[5, :] = r[:, 5] = np.nan
    labels = ("Gain, toe", "Gain, camber", "c", "d", "e", "f")
    statuses: tuple[Status, ...] = ("excluded", "excluded", "excluded", "found", "excluded", "not testable")
    table = Isolability(labels, statuses, np.array([0.1, 0.1, 2.0, 0.1, 0.1, np.inf]), r, tuple("uvwxyz"))
    assert table.groups == ((3, 4), (0, 1))
    assert (table.alone, table.hidden) == ((2,), (5,))
    assert table.least_correlation((0, 1)) == 0.95
    rows = isolability_rows(table)
    assert [row.group for row in rows] == ["A", "A", "B", "B", "told apart", "hidden"]
    assert [row.test for row in rows] == ["x", "y", "u", "v", "w", "z"]
    assert (rows[4].nearest, rows[4].nearest_label) == (0.9, "Gain, camber")
    assert np.isnan(rows[5].nearest)


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (Size("force_N", 100.0, "N"), "force_N above 50.0 N"),
        (Size("offset_mm", 4.0, "mm", signed=True), "|offset_mm| above 2.00 mm"),
        (Size("k_N_mm", 100.0, "N/mm", "compliance"), "k_N_mm below 200 N/mm"),
        (Size("toe", 1.21, "-", "factor", signed=True), "toe below 0.9091 or above 1.100"),
        (Size("x_mm", 1.0, "mm", "shape"), ""),
    ],
)
def test_limits_say_which_way(size: Size, words: str) -> None:
    known = Hypothesis("hub_compliance", None, (size,))
    standing = HypothesisStatus(known, "excluded", 0.5, 0.0, (), (), (0.5,))
    assert limit_words(standing) == words
    assert limit_words(replace(standing, detectable=np.inf)) == "–"


def test_a_component_that_the_records_do_not_show_has_no_limit() -> None:
    sizes = tuple(Size("LLR", 600.0, "N", index=i, signed=True) for i in range(3))
    preload = Hypothesis("bushing_preload", "LLR", sizes)
    standing = HypothesisStatus(preload, "excluded", 0.5, 0.0, (), (), (0.5, 1.5, 40.0))
    assert limit_words(standing) == "|LLR| above 300 (x), 900 (y) N"
    hub = Hypothesis("hub_compliance", None, tuple(Size(k, 6000.0, "Nm/deg", "compliance") for k in "ab"))
    assert limit_words(HypothesisStatus(hub, "excluded", 0.5, 0.0, (), (), (0.5, 4.0))) == (
        "a below 12000 Nm/deg; b not shown"
    )


def test_a_parameter_that_hardly_moves_hides_nothing() -> None:
    """`sff.Fy (−0.0 sd)` stood beside a bushing that the records do not show."""
    moves = (("LLR.x", 0.4), ("sff.Fy", -0.06), ("sfr.Fy", -0.04), ("RIB.z", 0.0))
    standing = HypothesisStatus(Hypothesis("hub_compliance", None, ()), "excluded", 0.5, 0.0, moves, (), ())
    assert LibraryRow(standing, {}, "").hidden_by == "LLR.x (+0.4 sd), sff.Fy (-0.1 sd)"


def test_places_read_well() -> None:
    labels = {h.name: hypothesis_label(h) for e in EFFECTS.values() for h in e.hypotheses()}
    assert labels["bushing_progression LLR"] == "Bushing progression, LLR"
    assert labels["left_right_asymmetry LLF_L"] == "Left/right asymmetry, LLF left"
    assert labels["hub_compliance"] == EFFECTS["hub_compliance"].label
    assert place_words("wc_x") == "wheel centre x"
    assert len(set(labels.values())) == len(labels)
