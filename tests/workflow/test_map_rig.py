"""A folder of a rig's own files becomes a test.toml that reads as the package's own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.errors import InputError
from doe_kc.measurement import load_manifest
from doe_kc.measurement.channels import Heading
from doe_kc.measurement.map_proposal import guess_case, guess_channel
from doe_kc.measurement.reduction import case_records
from doe_kc.workflow.map_rig import propose_map
from tests.cli.runner import invoke, succeeds
from tests.measurement.synthetic import EXAMPLE

GERMAN = {
    "toe": "Spur", "camber": "Sturz", "caster": "Nachlauf", "wc_x": "Radmitte X", "wc_y": "Radmitte Y",
    "wc_z": "Radmitte Z", "tyre_load": "Radlast", "pad_z": "Stempelweg", "roll": "Wankwinkel",
    "force_y": "Seitenkraft", "force_x": "Laengskraft", "steering_wheel": "Lenkradwinkel", "time": "Zeit",
}  # fmt: skip
FILES = {
    "vertical": "Hub", "roll": "Wanken", "lateral": "Querkraft", "lateral_opposite": "Querkraft gegensinnig",
    "lateral_offset": "Querkraft Versatz 30", "drive": "Antrieb", "brake": "Bremsen", "steer": "Lenken",
}  # fmt: skip


def german(heading: str) -> str:
    name, unit = heading[:-1].split(" [")
    side = {"_L": " links", "_R": " rechts"}.get(name[-2:], "")
    own = GERMAN[name[:-2] if side else name] + side
    return f"{own} [{unit.replace('deg', '°').replace('N', 'kN') if name[:4] == 'tyre' else unit}]"


def foreign(folder: Path) -> Path:
    """The shipped example in German names, kN, ISO axes, decimal comma, an old code page."""
    folder.mkdir()
    for case, name in FILES.items():
        for run, suffix in enumerate(("", "_repeat1")):
            frame = pd.read_csv(EXAMPLE / f"{case}{suffix}.csv")
            for column in frame.columns:
                if column.startswith("tyre_load"):
                    frame[column] /= 1000.0
                if column.startswith(("wc_x", "wc_y")):
                    frame[column] *= -1.0
            frame.columns = [german(c) for c in frame.columns]
            frame["Temperatur [°C]"] = 21.5
            text = "Prüfstand;Halle 3\n\n" + frame.to_csv(index=False, sep=";", decimal=",")
            (folder / f"{name} {run + 1}.txt").write_bytes(text.encode("cp1252"))
    return folder


def test_german_files_are_mapped_with_reasons_and_read_as_ours(tmp_path: Path) -> None:
    rig = foreign(tmp_path / "rig")
    outcome = succeeds("map", rig)
    assert "sign by its slopes" in outcome.out and "ignored: Temperatur" in outcome.out
    manifest = load_manifest(rig / "test.toml")
    assert set(manifest.records) == set(FILES)
    assert manifest.records["lateral"] == ("Querkraft 1.txt", "Querkraft 2.txt")
    for case in ("lateral", "steer"):
        ours = case_records(EXAMPLE / "test.toml", load_manifest(EXAMPLE / "test.toml"), case)[0]
        theirs = case_records(rig / "test.toml", manifest, case)[0]
        for r in RIG_RESPONSES:
            np.testing.assert_allclose(theirs.channels[r], ours.channels[r], atol=1e-6)
    assert invoke("map", rig).code == 2


@pytest.mark.parametrize(
    ("name", "unit", "slot"),
    [
        ("FrontLHwheeltoeindeg", None, ("toe", "L")),
        ("FrontRHwheelforceYN", None, ("force_y", "R")),
        ("FLHwheeltobodyZdisplacementmm", None, ("wc_z", "L")),
        ("CentreTableZDisplacementmm", None, ("pad_z", None)),
        ("steeringwheelpositiondeg", None, ("steering_wheel", None)),
        ("FrontTrackchangemm", None, None),
        ("Spurweite", "mm", None),
        ("Fz_L", None, ("tyre_load", "L")),
        ("toe", "deg", None),
        ("toe_L", "N", None),
        ("Oil temperature L", "C", None),
    ],
)
def test_names_that_tell_what_a_channel_is(
    name: str, unit: str | None, slot: tuple[str, str | None] | None
) -> None:
    guess = guess_channel(Heading(name, unit))
    assert (None if guess is None else guess.slot) == slot


def test_names_of_files() -> None:
    names = ["Std bounce", "test 3 lateral anti-phase", "lateral_offset_repeat1", "Bremsen", "x"]
    assert [guess_case(n) for n in names] == ["vertical", "lateral_opposite", "lateral_offset", "brake", None]


def test_what_two_channels_claim_stays_open(tmp_path: Path) -> None:
    frame = pd.read_csv(EXAMPLE / "vertical.csv")
    frame["toe angle L [deg]"] = frame["toe_L [deg]"]
    frame.to_csv(tmp_path / "sweep.csv", index=False)
    proposal = propose_map(tmp_path)
    assert any("toe_L" in q and "toe angle L" in q for q in proposal.open)
    assert any("sweep.csv" in q or "vertical" in proposal.records for q in ["sweep.csv", *proposal.open])
    assert "toe_L" not in [c.name for c in proposal.channels]


def test_folders_without_records_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("hello")
    for folder in (tmp_path, tmp_path / "none"):
        with pytest.raises(InputError):
            propose_map(folder)
