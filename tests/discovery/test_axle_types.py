"""Cars of other axle types, from the examples' records: searched once each, few load cases and effects."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import openpyxl
import pytest

from doe_kc.axle.places import places_of
from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.discovery.discover import discover
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.thresholds import PLACE_PROBABILITY
from doe_kc.effects import EFFECTS
from doe_kc.measurement import Measurement
from doe_kc.study import Study, read_study
from doe_kc.workflow.discover import discovery_space, effect_library, recorded
from doe_kc.workflow.measure import study_measurement
from doe_kc.workflow.write_discovery import write_discovery

EXAMPLES = Path(__file__).parents[2] / "examples"
LOAD_CASES = ("lateral", "lateral_opposite")
LIBRARY = ("hub_compliance", "subframe_flexibility", "damper_friction")
HIDDEN = {"camber_Nm_deg": 3400.0, "toe_Nm_deg": 5400.0}
"""Of the hub in both cars."""
FOREIGN = {
    "five_link_rear": r"mcpherson|\bstrut\b|\brack\b|\bsteering|kingpin|tie[ -]rod|top mount|steer arm",
    "double_wishbone_front": r"mcpherson|\bstrut\b|top mount|steer arm|lower link",
}
"""What such an axle does not have."""


@cache
def study(axle_type: str) -> Study:
    """The example with the few load cases."""
    whole = read_study(EXAMPLES / axle_type)
    cases = {name: whole.axle.load_cases[name] for name in LOAD_CASES}
    return replace(whole, axle=replace(whole.axle, load_cases=cases), pictures="none")


@cache
def records(axle_type: str) -> Measurement:
    whole = study_measurement(study(axle_type))
    cases = {name: whole.curves.cases[name] for name in LOAD_CASES}
    return replace(whole, curves=replace(whole.curves, cases=cases))


@cache
def discovery(axle_type: str) -> Discovery:
    """What is found in the example's car."""
    axle = recorded(study(axle_type).axle, records(axle_type))
    library = [h for ident in LIBRARY for h in EFFECTS[ident].hypotheses(places_of(axle))]
    space = discovery_space(axle, study(axle_type).variables, "test")
    return discover(EffectModel(axle, space, record_likelihood(axle, records(axle_type))), library)


@pytest.mark.parametrize("axle_type", FOREIGN)
def test_the_compliant_hub_is_named_with_its_size(axle_type: str) -> None:
    found = discovery(axle_type)
    assert found.verdict == "named"
    (finding,) = found.findings
    assert finding.hypothesis.effect == "hub_compliance"
    for estimate in finding.estimates:
        assert abs(estimate.value - HIDDEN[estimate.key]) < 2.0 * estimate.sd
    camber = next(e for e in finding.estimates if e.key == "camber_Nm_deg")
    assert camber.sd < 0.05 * camber.value


@pytest.mark.parametrize("axle_type", FOREIGN)
def test_the_scan_of_all_interfaces_points_to_the_hub(axle_type: str) -> None:
    """Without a list of effects, over ball joints, bushings, damper and sub-frame too."""
    scan = discovery(axle_type).scan
    assert scan.interface == "wheel|knuckle"
    assert sum(p.probability for p in scan.places if p.law == "compliance") > PLACE_PROBABILITY
    structure = study(axle_type).axle.topology.structure
    tried = {place.interface.split("|")[0] for place in scan.places}
    assert {ball.name for ball in structure.balls} <= tried
    assert {bush.name for bush in structure.bushings} | {"damper"} <= tried


@pytest.mark.parametrize("axle_type", FOREIGN)
def test_nothing_speaks_of_parts_that_the_axle_does_not_have(axle_type: str, tmp_path: Path) -> None:
    written = write_discovery(
        study(axle_type), discovery(axle_type), records(axle_type), tmp_path / "out", workers=1
    )
    page = next(path for path in written if path.suffix == ".html").read_text(encoding="utf-8")
    words = [re.sub(r"<(script|style)\b.*?</\1>", "", page, flags=re.DOTALL)]
    book = openpyxl.load_workbook(next(path for path in written if path.suffix == ".xlsx"))
    words += [str(cell.value) for sheet in book for row in sheet.iter_rows() for cell in row if cell.value]
    words += [path.read_text(encoding="utf-8") for path in written if path.suffix == ".csv"]
    said = [
        text[max(0, hit.start() - 40) : hit.end() + 40]
        for text in words
        for hit in re.finditer(FOREIGN[axle_type], text, re.IGNORECASE)
    ]
    assert not said


def test_the_library_of_an_axle_without_rack_has_no_steering() -> None:
    axle = read_study(EXAMPLES / "five_link_rear").axle
    library = effect_library(axle)
    assert "steer" not in {h.location for h in library}
    assert {"rack_mount_compliance", "steering_friction", "strut_bending"}.isdisjoint(
        h.effect for h in library
    )
    assert {"TLO", "UFO", "URO"} <= {h.location for h in library if h.effect == "ball_compliance"}
