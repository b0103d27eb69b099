"""What a live page leaves behind: explorations, axle file, workbook, page."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from openpyxl import load_workbook

from doe_kc.axle import parameter_value
from doe_kc.axle_file import read_axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import InputError
from doe_kc.live import keep
from doe_kc.live.messages import read_message
from doe_kc.live.model import LiveModel
from doe_kc.live.session import Session
from tests.live.cases import model


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> LiveModel:
    own = model()
    return replace(own, study=replace(own.study, out=tmp_path_factory.mktemp("out")))


@pytest.fixture
def live(written: LiveModel) -> Session:
    session = Session(written)
    value = session.values()["ROB.z"] + 1.25
    for message in (
        {"kind": "move", "seq": 1, "path": "ROB.z", "value": value},
        {"kind": "snapshot", "name": "high rod"},
        {"kind": "move", "seq": 2, "path": "llr.Fx", "value": 0.8},
        {"kind": "bounds", "path": "llr.Fx", "lower": 0.2, "upper": 3.0},
        {"kind": "lock", "paths": ["LLF.x"], "on": True},
        {"kind": "hold", "characteristic": "roll.roll_rate", "on": True},
    ):
        session.handle(read_message(json.dumps(message)))
        session.solve_now()
    return session


def test_an_exploration_is_reopened_as_it_was(live: Session, written: LiveModel) -> None:
    assert str(keep.live_folder(live)) in keep.save_state(live)
    again = Session(written)
    again.replaced(keep.read_state(again))
    again.solve_now()
    assert again.values() == live.values()
    assert again.state.bounds == live.state.bounds and again.state.locked == {"LLF.x"}
    assert again.state.held == {"roll.roll_rate"}
    (kept,) = again.state.snapshots
    assert kept.name == "high rod" and kept.answer.gap == pytest.approx(live.state.snapshots[0].answer.gap)
    assert again.present.gap == pytest.approx(live.present.gap)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("present", {"values": {"LFF.z": 1.0}, "effects": {}}, "LFF.z is no slider"),
        ("present", {"values": {"LLF.z": "high"}, "effects": {}}, "present.values.LLF.z"),
        ("schema", "doe_kc.live/9", "schema"),
        ("bounds", {"LLF.z": [1.0]}, "bounds.LLF.z"),
        ("bounds", {"LLF.z": [1.0, 2.0]}, "bounds.LLF.z"),
        ("held", ["roll.nothing"], "roll.nothing"),
    ],
)
def test_a_wrong_exploration_is_refused(live: Session, key: str, value: object, words: str) -> None:
    keep.save_state(live)
    path = keep.live_folder(live) / keep.EXPLORATION
    path.write_text(json.dumps(json.loads(path.read_text()) | {key: value}))
    with pytest.raises(InputError, match=words):
        keep.read_state(live)


def test_the_axle_file_reads_back(live: Session) -> None:
    path = Path(keep.export_axle(live).partition(": ")[2])
    axle = read_axle(path)
    assert parameter_value(axle, "ROB.z") == live.values()["ROB.z"]
    assert parameter_value(axle, "llr.Fx") == pytest.approx(0.8)


def test_the_workbook_has_every_design(live: Session) -> None:
    book = load_workbook(keep.export_table(live).partition(": ")[2])
    rows = [[c.value for c in row] for row in book["Characteristics"].iter_rows()]
    head = next(row for row in rows if row[0] == "Name")
    assert head[-3:] == ["Nominal", "high rod", "Present"]
    body = {row[0]: row for row in rows}
    place = list(CHARACTERISTICS).index("vertical.bump_steer")
    shown = body["vertical.bump_steer"][-3:]
    answers = (live.nominal, live.state.snapshots[0].answer, live.present)
    assert shown == [pytest.approx(a.characteristics[place]) for a in answers]
    parameters = {row[0].value: row[-1].value for row in book["Parameters"].iter_rows()}
    assert parameters["ROB.z"] == live.values()["ROB.z"]
