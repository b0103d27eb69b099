from __future__ import annotations

from pathlib import Path

import pytest

from doe_kc.ground.errors import InputError
from doe_kc.measurement import load_manifest
from tests.measurement.synthetic import EXAMPLE

GOOD = 'name = "a"\n[records]\nvertical = ["v.csv"]\n'


def manifest_with(folder: Path, text: str) -> Path:
    path = folder / "test.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_shipped_manifest_is_read() -> None:
    manifest = load_manifest(EXAMPLE / "test.toml")
    assert manifest.name == "car_a"
    assert len(manifest.records) == 8
    assert manifest.records["roll"] == ("roll.csv", "roll_repeat1.csv", "roll_repeat2.csv")
    assert manifest.alignment is not None and manifest.alignment.left is not None
    assert manifest.alignment.left.caster_deg == 4.34
    assert manifest.setup.rack_mm_per_rev == 52.0
    assert manifest.sensor_resolution.tyre_load_N == 4.0


def test_the_shortest_manifest_has_defaults(tmp_path: Path) -> None:
    manifest = load_manifest(manifest_with(tmp_path, 'name = "a"\n[records]\nvertical = "v.csv"\n'))
    assert manifest.alignment is None
    assert manifest.records == {"vertical": ("v.csv",)}
    assert manifest.sensor_resolution.angle_deg == 0.003


def test_the_benchs_accuracy_can_be_stated(tmp_path: Path) -> None:
    manifest = load_manifest(manifest_with(tmp_path, GOOD + "[alignment]\nsd = { toe_deg = 0.05 }\n"))
    assert manifest.alignment is not None
    assert (manifest.alignment.sd.toe_deg, manifest.alignment.sd.caster_deg) == (0.05, 0.02)


def test_further_setup_keys_are_kept_as_notes(tmp_path: Path) -> None:
    manifest = load_manifest(manifest_with(tmp_path, GOOD + "[setup]\nroom_temperature_C = 21.5\n"))
    assert manifest.setup.model_extra == {"room_temperature_C": 21.5}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["key name is missing"]),
        ('name = "a"\n', ["key records is missing"]),
        ('name = "a"\n[records]\n', ["records"]),
        ('name = "a"\n[records]\nvertcal = ["v.csv"]\n', ["vertcal", "no load case", '"vertical"']),
        ('name = "a"\n[records]\nvertical = []\n', ["records.vertical", "no file"]),
        ('name = "a"\n[records]\nvertical = ["v", "v"]\n', ["records.vertical", "same file twice"]),
        ('name = "a"\n[records]\nvertical = 3\n', ["records.vertical", "3", "expected"]),
        ("name = 3\n[records]\nvertical = ['v']\n", ["key name = 3", "string"]),
        (GOOD + "[setup]\nrack_mm_per_rew = 3\n", ["setup.rack_mm_per_rew", '"rack_mm_per_rev"']),
        (GOOD + "[setup]\nrack_mm_per_rev = 0\n", ["setup.rack_mm_per_rev = 0", "greater than 0"]),
        (GOOD + "[setup]\nrack_mm_per_rev = '52'\n", ["setup.rack_mm_per_rev", "number"]),
        (GOOD + "[alignment]\nlefft = {}\n", ["alignment.lefft", '"left"']),
        (GOOD + "[alignment]\nleft = { toe = 0.1 }\n", ["alignment.left.toe", '"toe_deg"']),
        (GOOD + "[alignment]\nleft = { toe_deg = nan }\n", ["alignment.left.toe_deg", "finite"]),
        (GOOD + "[sensor_resolution]\nangle_deg = -1\n", ["sensor_resolution.angle_deg = -1"]),
        ('name = "a"\nrecord = 1\n', ["key record is unknown", '"records"']),
        ("name = ", ["not readable TOML"]),
    ],
)
def test_a_faulty_manifest_is_one_sentence(tmp_path: Path, text: str, words: list[str]) -> None:
    path = manifest_with(tmp_path, text)
    with pytest.raises(InputError) as caught:
        load_manifest(path)
    message = str(caught.value)
    assert str(path) in message and "\n" not in message
    for word in words:
        assert word in message


def test_missing_file_folder_and_wrong_encoding_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        load_manifest(tmp_path / "test.toml")
    with pytest.raises(InputError, match="is a folder"):
        load_manifest(tmp_path)
    path = tmp_path / "latin.toml"
    path.write_bytes('name = "Z\xfcrich"'.encode("latin-1"))
    with pytest.raises(InputError, match="UTF-8"):
        load_manifest(path)
