"""What a discovery leaves behind: files, data for other programs, lines for a terminal."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.discovery.result import Finding, ParameterEstimate
from doe_kc.discovery.verdict.exclusion import HypothesisStatus
from doe_kc.discovery.verdict.sentences import odds_words
from doe_kc.effects import EFFECTS
from doe_kc.ground.errors import RunError
from doe_kc.reports.discovery.effects import effect_table
from doe_kc.reports.render.csv import table_frame
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.study import Study, read_study
from doe_kc.workflow.discovery_document import discovery_document, discovery_lines, effect_entry, not_testable
from doe_kc.workflow.write_discovery import DISCOVERY_TABLES, axle_note, write_discovery
from tests.discovery.cases import AXLE, LOAD_CASES, discovery, library, records

CARS = ["none", "named", "class", "unexplained", "lead", "two"]
KEYS = [
    "verdict", "effects", "leads", "traces", "classes", "adequacy", "excluded", "unresolved",
    "not_testable", "unexplained_at", "gap", "held_out", "points_to",
    "beyond_bounds", "next_test", "further_tests", "axle",
]  # fmt: skip


def study(folder: Path) -> Study:
    (folder / "study.toml").write_text(f"name = 'Car'\naxle = {str(AXLE)!r}\n", encoding="utf-8")
    return read_study(folder)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    folder = tmp_path_factory.mktemp("discovery")
    return write_discovery(study(folder), discovery("two"), records("two"), folder / "out", workers=1)


def test_everything_is_written(written: list[Path]) -> None:
    names = [p.name for p in written]
    first = ["axle.toml", "axle_effects_only.toml", *DISCOVERY_TABLES, "discovery.xlsx", "report.html"]
    assert names[: len(first)] == first
    assert {Path(n).stem for n in names[len(first) :]} == {
        "disagreement", "gap", "evidence", "worst_curves", "isolability", "parameters", "held_out",
    }  # fmt: skip
    assert all(p.stat().st_size > 100 for p in written)


def test_the_axle_with_nothing_but_the_effects_differs_by_a_few_lines(written: list[Path]) -> None:
    before = AXLE.read_text(encoding="utf-8").splitlines()
    after = written[1].read_text(encoding="utf-8").splitlines()
    added = [line for line in after if line not in before]
    assert any(line.startswith("[effects.strut_friction]") for line in added)
    assert len(added) <= 7
    assert all(line in after for line in before)


def test_the_axle_is_the_fitted_one(written: list[Path]) -> None:
    found = discovery("two")
    fitted = found.fitted.model.axle_at(found.fitted.z)
    again = read_axle(written[0])
    assert again.topology == fitted.topology
    assert set(again.effects) == {i for i in fitted.effects if not EFFECTS[i].on_rig} == {"strut_friction"}
    for name, value in fitted.values.items():
        assert again.values[name] == pytest.approx(value, rel=1e-12)
    one, two = curve_set(solve(fitted)), curve_set(solve(again))
    for name in LOAD_CASES:
        for response, curve in one.cases[name].mean.items():
            np.testing.assert_allclose(two.cases[name].mean[response], curve, rtol=0, atol=1e-9)
    assert written[0].read_text().splitlines()[0].endswith(axle_note(found))


def test_tables_hold_the_numbers(written: list[Path]) -> None:
    found = discovery("two")
    tables = {p.name: pd.read_csv(p) for p in written if p.suffix == ".csv"}
    assert len(tables["disagreement.csv"]) == len(found.nominal_map.names)
    assert len(tables["library.csv"]) == len(found.statuses)
    assert tables["gap.csv"]["tuned"][0] == pytest.approx(found.gap.tuned, rel=1e-9)
    assert list(tables["held_out.csv"]["load_case"]) == list(LOAD_CASES)
    assert len(tables["parameters.csv"]) == len(found.fitted.model.space.paths)


@pytest.mark.parametrize("car", CARS)
def test_the_document_has_its_keys_and_is_plain_json(car: str) -> None:
    found = discovery(car)
    document = discovery_document(found, Path("out/axle.toml"))
    assert list(document) == KEYS
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert document["verdict"] == found.verdict
    named, leads = document["effects"], document["leads"]
    assert (leads if found.verdict == "unexplained" else named) == [effect_entry(f) for f in found.findings]
    assert (named if found.verdict == "unexplained" else leads) == []
    assert set(document["gap"]) == {"nominal", "tuned", "with_effect", "noise_floor", "best_decoy"}
    assert bool(document["unexplained_at"]) is bool(found.unexplained)
    assert document["axle"] == str(Path("out/axle.toml"))
    assert discovery_document(found, None)["axle"] is None


def test_an_effect_states_value_sd_and_unit() -> None:
    (entry,) = discovery_document(discovery("named"), None)["effects"]
    assert (entry["id"], entry["location"]) == ("hub_compliance", None)
    assert 0.9 < entry["probability"] <= 1.0
    assert entry["log10_odds"] == 6.0
    assert entry["against"] in (None, *EFFECTS)
    camber = entry["parameters"]["camber_Nm_deg"]
    assert camber["unit"] == "Nm/deg"
    assert abs(camber["value"] - 5000.0) < 4.0 * camber["sd"]


@pytest.mark.parametrize(
    ("log10_odds", "against", "words"),
    [
        (3.21, "strut_bending", "log10 odds 3.2 against strut bending at the clamp in its place"),
        (240.0, "", "log10 odds > 6 against its removal"),
    ],
)
def test_odds_are_said_alike_everywhere(log10_odds: float, against: str, words: str) -> None:
    found = discovery("named")
    finding = replace(found.findings[0], log10_odds=log10_odds, against=against)
    changed = replace(found, findings=(finding,))
    assert any(line.endswith(words) for line in discovery_lines(changed) if line.startswith("effect:"))
    assert odds_words(finding) == words
    entry = effect_entry(finding)
    assert (entry["log10_odds"], entry["against"]) == (min(log10_odds, 6.0), against or None)
    frame = table_frame(effect_table(changed))
    assert (frame["log10_odds"] == min(log10_odds, 6.0)).all()
    assert words.endswith(f"against {frame['against'].iloc[0]}")


def test_the_adequacy_is_one_line_of_the_verdict() -> None:
    found = discovery("named")
    said = [s for s in found.sentences if s.startswith("Adequacy:")]
    assert said == [line for line in discovery_lines(found) if line.startswith("Adequacy:")]
    assert len(said) == 1
    assert "2 % assumed before the records" in said[0]
    document = discovery_document(found, None)["adequacy"]
    assert document["map_chance"] >= 0.01
    assert document["worst_held_out"] in LOAD_CASES
    assert 0.0 < document["held_out_chance"] <= 1.0
    lost = discovery("unexplained")
    assert discovery_document(lost, None)["adequacy"]["unlisted"] is None
    assert any("does not list, or a law of another shape, is at work" in s for s in lost.sentences)


def test_nothing_is_excluded_where_the_records_are_not_explained() -> None:
    document = discovery_document(discovery("unexplained"), None)
    assert document["excluded"] == []
    assert document["unresolved"]
    assert discovery_document(discovery("none"), None)["unresolved"] == []


def test_a_list_option_becomes_one_parameter() -> None:
    finding = discovery("progression").findings[0]
    entry = effect_entry(finding)
    assert entry["location"] == "UPB"
    assert list(entry["parameters"]) == ["UPB"]
    assert len(entry["parameters"]["UPB"]["value"]) == len(entry["parameters"]["UPB"]["sd"]) == 3
    assert entry["parameters"]["UPB"]["unit"] == "1/mm^2"


def test_the_rest_of_the_effects_table_is_in_its_options() -> None:
    """Its law, and that a preload comes on top of the file's."""
    friction, preload = (next(iter(library(ident))) for ident in ("steering_friction", "bushing_preload"))
    by_law = next(v for v in EFFECTS["steering_friction"].variants(friction) if v.law == "iwan")
    none = replace(discovery("lead").findings[0], estimates=())
    assert effect_entry(replace(none, hypothesis=friction))["options"] == {}
    assert effect_entry(replace(none, hypothesis=by_law))["options"] == {"law": "iwan"}
    assert effect_entry(replace(none, hypothesis=preload))["options"] == {"added": True}


def test_an_index_alone_keeps_its_place() -> None:
    finding: Finding = discovery("lead").findings[0]
    one = replace(finding, estimates=(ParameterEstimate("LLR", 1, 600.0, 20.0, "N"),))
    expected = {"value": [0.0, 600.0], "sd": [0.0, 20.0], "limit": [None, None], "shown": [True, True]}
    assert effect_entry(one)["parameters"]["LLR"] == expected | {"unit": "N"}


def test_a_number_that_is_not_told_from_none_has_its_limit() -> None:
    finding: Finding = discovery("named").findings[0]
    camber, toe = finding.estimates
    own = replace(finding, estimates=(camber, replace(toe, limit=20000.0, shown=False)))
    parameters = effect_entry(own)["parameters"]
    assert [parameters[k]["limit"] for k in ("camber_Nm_deg", "toe_Nm_deg")] == [None, 20000.0]
    assert [parameters[k]["shown"] for k in ("camber_Nm_deg", "toe_Nm_deg")] == [True, False]


def test_what_is_excluded_has_a_limit_for_each_size() -> None:
    found = discovery("none")
    (preload,) = (h for h in EFFECTS["bushing_preload"].hypotheses() if h.location == "LLR")
    standing = HypothesisStatus(preload, "excluded", 0.5, 0.0, (), (), (0.5, float("inf"), 4.0))
    (entry,) = discovery_document(replace(found, statuses=(standing,)), None)["excluded"]
    first = preload.sizes[0].value(0.5)
    assert entry["above"] == {"LLR": {"value": [first, None, None], "unit": "N"}}


def test_numbers_that_are_not_finite_are_none() -> None:
    assert discovery_document(discovery("none"), None)["gap"]["best_decoy"] is None


def test_excluded_places_say_from_which_size_on() -> None:
    excluded: list[dict[str, Any]] = discovery_document(discovery("named"), None)["excluded"]
    by_place = {(e["id"], e["location"]): e["above"] for e in excluded}
    assert list(by_place[("strut_bending", None)]) == ["k_Nm_deg", "torsion_Nm_deg"]
    assert list(by_place[("steering_friction", None)]) == ["force_N"]
    assert by_place[("rig_channel_gain", "toe")]["toe"]["value"] > 1.0


def test_an_effect_is_not_testable_where_no_place_is() -> None:
    one, two = discovery("named").statuses[:2]
    both = [replace(s, hypothesis=one.hypothesis) for s in (one, two)]
    assert not_testable([replace(s, status="not testable") for s in both]) == [one.hypothesis.effect]
    assert not_testable([both[0], replace(both[1], status="not testable")]) == []


@pytest.mark.parametrize("car", CARS)
def test_the_terminal_says_verdict_gap_and_what_next(car: str) -> None:
    found = discovery(car)
    lines = discovery_lines(found)
    assert found.sentences[0] in lines[0]
    gap = next(line for line in lines if line.startswith("gap: "))
    assert ("with the effect" in gap) is bool(found.fitted.model.members)
    assert sum(line.startswith(("effect: ", "lead: ")) for line in lines) == len(found.findings)
    assert any(line.startswith("next test: ") for line in lines) is bool(found.next_tests)
    assert all("\n" not in line for line in lines)


def test_the_terminal_says_what_speaks_against_a_name() -> None:
    found = discovery("none")
    against = "Against a name: strut bending would have to be 3.3 times its typical size."
    (line,) = set(discovery_lines(replace(found, sentences=(*found.sentences, against)))) - set(
        discovery_lines(found)
    )
    assert line == "against a name: strut bending would have to be 3.3 times its typical size"


def test_the_axle_says_when_its_effects_are_leads_only() -> None:
    assert axle_note(discovery("none")) == "no effect missing; re-tuned"
    assert "leads, not confirmed: tie-rod compliance" in axle_note(discovery("lead"))


def test_an_unwritable_folder_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    with pytest.raises(RunError, match="out"):
        write_discovery(study(tmp_path), discovery("none"), records("none"), tmp_path / "out", workers=1)
