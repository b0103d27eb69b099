"""One name for every load case, input and response."""

from __future__ import annotations

import pytest

from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES, response_name
from doe_kc.load_cases import LOAD_CASES, case_label
from doe_kc.reports.names import input_label, response_axis, within_sentence


@pytest.mark.parametrize("load_case", LOAD_CASES)
def test_every_load_case_names_itself_and_its_input(load_case: str) -> None:
    case = LOAD_CASES[load_case]
    assert case_label(load_case) == case.label
    assert input_label(load_case, case.unit) == f"{case.input_label} [{case.unit}]"


def test_a_roll_by_pads_is_told_by_its_unit() -> None:
    assert input_label("roll", "mm").startswith("Counter-phase pad travel")
    assert input_label("vertical", "deg") == "Input [deg]", "no such input: nothing is claimed of it"


@pytest.mark.parametrize("response", RIG_RESPONSES)
def test_every_response_has_an_axis_with_its_unit(response: str) -> None:
    assert response_axis(response).endswith(f"{response_name(response)} [{RESPONSE_UNITS[response]}]")
    assert response_axis(response).startswith("Δ ") is (response != "tyre_load")


@pytest.mark.parametrize(("label", "words"), [("Roll steer", "roll steer"), ("WC lateral", "WC lateral")])
def test_a_label_within_a_sentence_keeps_its_abbreviations(label: str, words: str) -> None:
    assert within_sentence(label) == words


def test_static_needs_no_load_case() -> None:
    assert case_label("static") == "Static"
