"""The 27 characteristics of Appendix B and the 21 columns of Appendix C are there, once each."""

from __future__ import annotations

import csv
from collections import Counter
from pathlib import Path

import pytest

from doe_kc.characteristics import CHARACTERISTICS, Characteristic, appendix_c
from doe_kc.characteristics.registry import by_id

DATA = Path(__file__).parents[1] / "data"
CASES = {
    "Vertical motion": "vertical",
    "Roll motion": "roll",
    "Drive force": "drive",
    "Brake force": "brake",
    "Lateral force": "lateral",
    "Lateral force opp.": "lateral_opposite",
    "Lateral force offset": "lateral_offset",
    "Steering input": "steer",
}
RESPONSES = {
    "Toe angle": {"toe"},
    "Camber angle": {"camber"},
    "Caster angle": {"caster", "spin"},
    "Tyre load": {"tyre_load"},
    "Wheel center": {"wc_x", "wc_y", "wc_z"},
}


def rows() -> list[dict[str, str]]:
    with (DATA / "appendix_b_characteristics.csv").open() as file:
        return list(csv.DictReader(file))


APPENDIX_B = [c for c in CHARACTERISTICS.values() if c.in_appendix_b]


def matching(row: dict[str, str]) -> list[Characteristic]:
    static = row["load_case"] == "Static equilibrium"
    return [
        c
        for c in APPENDIX_B
        if (c.kind == "static") == static
        and (static or c.load_case == CASES[row["load_case"]])
        and c.response in RESPONSES[row["response"]]
        and c.unit == row["unit"]
    ]


def test_twenty_seven_and_twenty_one() -> None:
    assert len(APPENDIX_B) == len(rows()) == 27
    assert len(appendix_c()) == 21
    assert len({c.id for c in APPENDIX_B}) == 27


@pytest.mark.parametrize("row", rows(), ids=lambda r: f"{r['load_case']} {r['characteristic']}")
def test_every_row_of_appendix_b_is_exactly_one_entry(row: dict[str, str]) -> None:
    (entry,) = matching(row)
    assert entry.objective == (row["objective"] == "Yes")
    assert entry.constraint == (row["constraint"] == "Yes")


def test_every_entry_of_appendix_b_has_its_row() -> None:
    assert Counter(c.id for row in rows() for c in matching(row)) == Counter(c.id for c in APPENDIX_B)


def test_the_columns_of_appendix_c_in_their_order() -> None:
    with (DATA / "appendix_c_influence.csv").open() as file:
        header = next(csv.reader(file))
    assert [c.id for c in appendix_c()] == header[1:]
    assert {c.id for c in CHARACTERISTICS.values() if c.in_appendix_c} == set(header[1:])


def test_an_id_is_registered_once() -> None:
    entries = list(CHARACTERISTICS.values())
    assert by_id(entries) == CHARACTERISTICS
    with pytest.raises(ValueError, match="registered twice"):
        by_id([*entries, entries[0]])


def test_arrays_keep_their_layout() -> None:
    """Load cases by name, each as the thesis lists it."""
    assert list(CHARACTERISTICS)[:3] == ["brake.brake_steer", "brake.wind_up", "brake.anti_dive"]
    assert list(dict.fromkeys(c.load_case for c in CHARACTERISTICS.values())) == [
        *("brake", "drive", "lateral", "lateral_offset", "lateral_opposite"),
        *("roll", "static", "steer", "vertical"),
    ]


def test_objectives_outside_appendix_b_are_no_default() -> None:
    for c in CHARACTERISTICS.values():
        assert c.in_appendix_b or not (c.objective or c.constraint)
        assert c.in_appendix_b or c.in_appendix_c
