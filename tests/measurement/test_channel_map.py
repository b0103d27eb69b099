"""A rig's own names, units, signs and axes give the same record as the package's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import openpyxl
import pytest

from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import RigRecord, load_manifest, reduce_measurement
from doe_kc.measurement.channel_map import named_map
from doe_kc.measurement.manifest import manifest_channels
from doe_kc.measurement.map_file import preset_names
from doe_kc.measurement.records import read_record
from tests.measurement.synthetic import csv_text, record_columns

COLUMNS = record_columns("lateral", samples=128)


def record(
    folder: Path, columns: dict[str, FloatArray], channels: str = "", case: str = "lateral"
) -> RigRecord:
    """Of a CSV file through the map of a test.toml."""
    (folder / "r.csv").write_text(csv_text(columns))
    return read_with(folder, "r.csv", channels, case)


def read_with(folder: Path, name: str, channels: str, case: str = "lateral") -> RigRecord:
    path = folder / "test.toml"
    path.write_text(f'name = "a"\n{channels}\n[records]\n{case} = "{name}"\n', encoding="utf-8")
    manifest = load_manifest(path)
    file, _, sheet = name.partition("#")
    own = manifest_channels(path, manifest)
    return read_record(folder / file, case, sheet=sheet or None, channels=own)


def same(one: RigRecord, other: RigRecord, rtol: float = 1e-9) -> None:
    np.testing.assert_allclose(one.input, other.input, rtol=rtol, atol=1e-7)
    for r in RIG_RESPONSES:
        np.testing.assert_allclose(one.channels[r], other.channels[r], rtol=rtol, atol=1e-7)


def renamed(names: dict[str, str], factors: dict[str, float] | None = None) -> dict[str, FloatArray]:
    factors = factors or {}
    return {names.get(k, k): v * factors.get(k, 1.0) for k, v in COLUMNS.items()}


SPMM = {
    "time [s]": "Timesec",
    **{
        f"{ours}_{s} [{unit}]": theirs.replace("{side}", f"{s}H")
        for s in "LR"
        for ours, unit, theirs in (
            ("toe", "deg", "Front{side}wheeltoeindeg"),
            ("camber", "deg", "Front{side}wheelcamberdeg"),
            ("caster", "deg", "Front{side}wheelspindeg"),
            ("wc_x", "mm", "Front{side}wheelcentreXdispmm"),
            ("wc_y", "mm", "Front{side}wheelcentreYdispmm"),
            ("wc_z", "mm", "F{side}wheeltobodyZdisplacementmm"),
            ("tyre_load", "N", "Front{side}wheelforceZN"),
        )
    },
}


def test_spmm_names_in_iso_axes_with_a_force_on_each_wheel(tmp_path: Path) -> None:
    flipped = [k for k in COLUMNS if k.startswith(("wc_x", "wc_y"))]
    columns = renamed(SPMM, dict.fromkeys(flipped, -1.0))
    force = columns.pop("force_y [N]")
    columns |= {"FrontLHwheelforceYN": -force, "FrontRHwheelforceYN": -force, "FrontTrackchangemm": force}
    spmm = record(tmp_path, columns, 'channels = "spmm"')
    same(spmm, record(tmp_path, COLUMNS))
    assert spmm.ignored == ("FrontTrackchangemm",)


@pytest.mark.parametrize(
    ("case", "share"), [("lateral_opposite", (1.0, -1.0)), ("drive", (-1.0, -1.0)), ("brake", (1.0, 1.0))]
)
def test_forces_of_the_wheels_become_the_input_of_each_case(
    tmp_path: Path, case: str, share: tuple[float, float]
) -> None:
    force = COLUMNS["force_y [N]"]
    name = "force_y" if case.startswith("lateral") else "force_x"
    columns = {k: v for k, v in COLUMNS.items() if k != "force_y [N]"}
    columns |= {f"F_{s} [N]": k * force for s, k in zip("LR", share, strict=True)}
    own = f'[channels]\npreset = "doe_kc"\nmap = {{ "F_{{side}}" = {{ quantity = "{name}" }} }}'
    np.testing.assert_allclose(record(tmp_path, columns, own, case).input, force)


def test_units_scale_sign_and_offset(tmp_path: Path) -> None:
    columns = dict(COLUMNS)
    columns["toe_L [rad]"] = np.radians(columns.pop("toe_L [deg]"))
    columns["wc_x_R (in)"] = columns.pop("wc_x_R [mm]") / 25.4
    columns["load left"] = -(columns.pop("tyre_load_L [N]") / 2000.0) + 7.0
    columns["tyre_load_R [kg]"] = columns.pop("tyre_load_R [N]") / 9.80665
    entry = '{ quantity = "tyre_load", side = "L", unit = "kN", sign = -1, scale = 2.0, offset = 7.0 }'
    own = f'[channels]\npreset = "doe_kc"\nmap = {{ "load left" = {entry} }}'
    same(record(tmp_path, columns, own), record(tmp_path, COLUMNS))


def test_one_channel_may_be_two_inputs(tmp_path: Path) -> None:
    columns = {("Kraft [N]" if k.startswith("force") else k): v for k, v in COLUMNS.items()}
    entries = '[{ quantity = "force_y", cases = ["lateral"] }, { quantity = "force_x", cases = ["brake"] }]'
    own = f'[channels]\npreset = "doe_kc"\nmap = {{ "Kraft" = {entries} }}'
    for case in ("lateral", "brake"):
        np.testing.assert_allclose(record(tmp_path, columns, own, case).input, COLUMNS["force_y [N]"])


GERMAN = "Prüfstand;Halle 3\nDatum;01.02.2026\n\n"


def german(units: bool) -> str:
    head, *rows = csv_text(COLUMNS).replace(",", ";").replace(".", ",").strip().split("\n")
    if units:
        cells = head.split(";")
        head = ";".join(c.split(" [")[0] for c in cells) + "\n"
        head += ";".join(c.split("[")[1].replace("deg", "Grad").strip("]") for c in cells)
    return GERMAN + "\n".join([head, *rows]) + "\n"


@pytest.mark.parametrize("units", [True, False])
@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "cp1252"])
@pytest.mark.parametrize("separator", [";", "\t"])
def test_text_files_of_other_countries(tmp_path: Path, units: bool, encoding: str, separator: str) -> None:
    plain = record(tmp_path, COLUMNS)
    (tmp_path / "g.txt").write_bytes(german(units).replace(";", separator).encode(encoding))
    same(read_with(tmp_path, "g.txt", ""), plain, rtol=1e-6)


def test_a_german_sheet_with_settings_above_and_units_below_the_headings(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    sheet = book.active
    for line in german(True).split("\n"):
        sheet.append(line.split(";"))
    book.save(tmp_path / "g.xlsx")
    same(read_with(tmp_path, "g.xlsx", ""), record(tmp_path, COLUMNS), rtol=1e-6)


def test_blanks_as_separators(tmp_path: Path) -> None:
    text = csv_text(COLUMNS).replace(" [", "[").replace(",", "   ")
    (tmp_path / "b.txt").write_text(text)
    same(read_with(tmp_path, "b.txt", ""), record(tmp_path, COLUMNS))


def test_a_bad_cell_among_the_first_samples_is_told_not_skipped(tmp_path: Path) -> None:
    lines = german(True).split("\n")
    lines[7] = "x" + lines[7]
    (tmp_path / "g.txt").write_text("\n".join(lines))
    with pytest.raises(InputError, match=r"row 8, column \"time\""):
        read_with(tmp_path, "g.txt", "")


def test_a_map_file_is_shared_and_builds_on_a_preset(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text('preset = "doe_kc"\nmap = { "Spur" = { quantity = "toe", side = "L" } }')
    columns = renamed({"toe_L [deg]": "Spur [deg]"})
    same(record(tmp_path, columns, 'channels = "m.toml"'), record(tmp_path, COLUMNS))


@pytest.mark.parametrize(
    ("channels", "words"),
    [
        ('channels = "spm"', ["neither a preset", '"spmm"']),
        ('channels = "m.toml"', ["no such TOML file"]),
        ('[channels]\nabsent = ["casters"]', ["absent", '"caster"']),
        ('[channels]\nmap = { "a{side}" = { quantity = "toe", side = "L" } }', ["{side}", "drop one"]),
        ('[channels]\nmap = { "a" = { quantity = "tow" } }', ["quantity", "tow"]),
        ('[channels]\nprest = "spmm"', ["channels.prest", '"preset"']),
        (
            '[channels]\npreset = "doe_kc"\nmap = { "time" = { quantity = "toe", side = "L", unit = "V" } }',
            ["[V]"],
        ),
        (
            '[channels]\nmap = { "time" = { quantity = "toe", side = "L" }, "toe_R" = { quantity = "toe", '
            'side = "L" } }',
            ['"time" and "toe_R"', "both mapped to toe_L"],
        ),
    ],
)
def test_a_wrong_map_is_one_sentence(tmp_path: Path, channels: str, words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        record(tmp_path, COLUMNS, channels)
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value), str(caught.value)


def test_every_preset_can_be_read() -> None:
    assert {"doe_kc", "spmm", "spmm_rear"} <= set(preset_names())
    for name in preset_names():
        slots = {c.slot for c in named_map(name, Path(), "test").channels}
        assert {("toe", "L"), ("tyre_load", "R"), ("force_x", None)} <= slots | {("force_x", None)}


def test_records_with_a_map_are_reduced(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text(csv_text(renamed({"toe_L [deg]": "Spur [deg]"})))
    own = '[channels]\npreset = "doe_kc"\nmap = { "Spur" = { quantity = "toe", side = "L" } }'
    (tmp_path / "test.toml").write_text(f'name = "a"\n{own}\n[records]\nlateral = "r.csv"\n')
    assert "lateral" in reduce_measurement(tmp_path).curves.cases
