"""The generic scan points to the interface where the effect works, in words."""

from __future__ import annotations

import pytest

from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.screening.scan import Place, Scan, scanned_places
from doe_kc.discovery.thresholds import PLACE_PROBABILITY
from tests.discovery.cases import model


def test_the_place_is_found_without_a_library() -> None:
    tuned = fit(model("named"), model("named").centre)
    found = Scan.of(scanned_places(tuned))
    assert (found.places[0].interface, found.places[0].law) == ("wheel|knuckle", "compliance")
    assert found.interface == "wheel|knuckle"
    assert sum(p.probability for p in found.places) == pytest.approx(1.0)


def test_a_friction_is_told_from_everything_else() -> None:
    """Which of the steering's parts rubs, four load cases do not say."""
    tuned = fit(model("friction"), model("friction").centre)
    found = Scan.of(scanned_places(tuned))
    assert sum(p.probability for p in found.places if p.law == "friction") > PLACE_PROBABILITY
    assert {p.interface for p in found.places[:4]} & {"rack|housing", "ball joint"}


def test_rubber_is_told_from_friction_at_one_place() -> None:
    tuned = fit(model("rubber"), model("rubber").centre)
    found = Scan.of(scanned_places(tuned))
    assert (found.places[0].interface, found.places[0].law) == ("all bushings", "friction")
    assert found.places[0].words == "an unlisted friction along x, y and z at all bushings"


def test_a_place_in_words() -> None:
    place = Place("wheel|knuckle", "compliance", "both", ("rx", "z"), 10.0, 0.9, 1.0)
    assert place.words == "an unlisted compliance about x and along z between wheel and knuckle"
    one = Place("llr", "progression", "L", ("y",), 10.0, 0.9, 1.0)
    assert one.words == "an unlisted progression along y at llr, left"
