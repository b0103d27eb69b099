"""A tuned axle goes back into copies of its files, which import as the same axle."""

from __future__ import annotations

import difflib
from pathlib import Path

import pytest

from doe_kc.adams.import_axle import AdamsSource
from doe_kc.axle import with_values
from doe_kc.axle.model import Axle
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError
from doe_kc.workflow.adams_difference import folded
from doe_kc.workflow.export_adams import AdamsExport, export_adams
from doe_kc.workflow.import_adams import design_spring_force, import_adams
from tests.adams.cases import (
    MCPHERSON_DATABASE,
    WISHBONE_DATABASE,
    changed,
    mcpherson_source,
    wishbone_source,
)
from tests.axle_type_reference import nominal as nominal_of

FRONT = "subsystems.tbl/front.sub"


def imported(source: AdamsSource) -> Axle:
    return import_adams(source).axle


def assert_same(axle: Axle, other: Axle, *, but: tuple[str, ...] = ()) -> None:
    """Equal numbers, what ADAMS has one number for folded into one."""
    one, two = folded(axle), folded(other)
    for name, value in one.values.items():
        if not name.startswith(but or ("-",)):
            assert two.values[name] == pytest.approx(value, rel=1e-9, abs=1e-9), name


def changed_lines(database: Path, out: Path) -> list[str]:
    """`+` lines of `diff` between the originals and the copies, new files left out."""
    lines: list[str] = []
    for old in sorted(p for p in database.rglob("*") if p.is_file()):
        new = out / old.relative_to(database)
        pair = [p.read_text(encoding="utf-8").splitlines() for p in (old, new)]
        diff = list(difflib.unified_diff(*pair, lineterm="", n=0))[2:]
        lines += [line[1:] for line in diff if line.startswith("+")]
    return lines


def test_an_unchanged_axle_gives_the_files_byte_for_byte(tmp_path: Path) -> None:
    result = export_adams(imported(mcpherson_source()), mcpherson_source(), tmp_path)
    assert not result.changed and not result.added and not result.unwritten
    for old in (p for p in MCPHERSON_DATABASE.rglob("*") if p.is_file()):
        assert (tmp_path / old.relative_to(MCPHERSON_DATABASE)).read_bytes() == old.read_bytes()


def test_a_tuned_mcpherson_axle_makes_the_round_trip(tmp_path: Path) -> None:
    values = {
        **{"LLF.z": 213.25, "RIB.z": 280.4, "llr.Fx": 0.8, "llr.Fy": 1.3, "upb.Tz": 0.7, "spring.rate": 29.1},
        **{"bump_stop.clearance": 20.5, "bump_stop.factor": 1.15, "static.toe": 0.08},
        **{"tyre.rate": 231.0, "arb.radius": 12.0, "scb.Tz": 1.1},
        **{"right.LLR.y": 371.5, "right.sff.Fx": 1.2, "right.static.camber": -0.6, "llr.cubic.Fx": 0.02},
        "llf.stiffness.Fz": 9000.0,
    }  # fmt: skip
    axle = with_values(imported(mcpherson_source()), values)
    axle = apply_effect(axle, "bushing_preload", {"LLR": [0.0, 600.0, 0.0]}, source="test")
    result = export_adams(axle, mcpherson_source(), tmp_path)
    assert not result.unwritten
    assert_same(axle, result.axle)
    assert_same(axle, imported(mcpherson_source(tmp_path)))
    assert {p.name for p in result.added} == {
        "arm_front_tuned.bus",
        "arm_rear_tuned.bus",
        "bump_tuned.bum",
        "spring_tuned.spr",
    }
    lines = changed_lines(MCPHERSON_DATABASE, tmp_path)
    assert " 'lca_front                   '  'left/right'        -2.0      -395.0      213.25" in lines
    assert " 'lca_rear                    '  'right'            300.0       371.5       218.0" in lines
    assert "  T_PRELOAD_Z             =  -600.0".strip() in [line.strip() for line in lines]
    assert len([line for line in lines if "tierod_inner" in line]) == 2  # in both subsystems


def test_hardpoints_and_factors_change_their_lines_and_the_preload_alone(tmp_path: Path) -> None:
    axle = with_values(imported(mcpherson_source()), {"LLF.z": 213.25, "ROB.y": -713.5, "llr.Fx": 0.8})
    export_adams(axle, mcpherson_source(), tmp_path)
    lines = changed_lines(MCPHERSON_DATABASE, tmp_path)
    assert len(lines) == 5  # SAH follows ROB; the preload holds the static load
    force = next(float(line.split("=")[1]) for line in lines if "USER_VALUE" in line)
    assert force == pytest.approx(design_spring_force(axle), rel=1e-12)


def test_a_tuned_double_wishbone_makes_the_round_trip(tmp_path: Path) -> None:
    values = {
        "LLF.z": 215.25,
        "UPS.z": 701.0,
        "llr.Fx": 0.8,
        "spring.rate": 75.0,
        "bump_stop.clearance": 18.0,
    }
    axle = with_values(
        imported(wishbone_source()), values | {"ulf.stiffness.Fx": 6000.0, "llr.cubic.Fz": 0.02}
    )
    axle = apply_effect(axle, "hub_compliance", {"camber_Nm_deg": 5000.0}, source="test")
    result = export_adams(axle, wishbone_source(), tmp_path)
    assert not result.unwritten
    assert_same(axle, result.axle)
    text = (tmp_path / FRONT).read_text()
    assert "'hub_compliance_active       '  'single'  'integer'  1" in text
    assert "TX_SCALING_FACTOR       =  0.8333333333333334" in text


def test_a_hub_that_stiffens_is_written_with_its_stiffness_at_rest_and_said(tmp_path: Path) -> None:
    options = {"camber_Nm_deg": 5000.0, "law": "stiffening", "loaded_factor": 1.5}
    axle = apply_effect(imported(wishbone_source()), "hub_compliance", options, source="test")
    result = export_adams(axle, wishbone_source(), tmp_path)
    (told,) = result.unwritten
    assert told.startswith("effect hub_compliance: its law stiffening")
    assert result.axle.values["hub.camber@L"] == 5000.0


def test_what_has_no_place_is_listed(tmp_path: Path) -> None:
    axle = with_values(imported(mcpherson_source()), {"ride_height": 3.0, "strut.flexibility": 0.5})
    for ident in ("strut_friction", "hub_compliance"):
        axle = apply_effect(axle, ident, {}, source="test")
    axle = apply_effect(axle, "rack_mount_compliance", {}, source="test")
    result = export_adams(axle, mcpherson_source(), tmp_path)
    told = "\n".join(result.unwritten)
    for words in (
        *("effect strut_friction", "effect hub_compliance: the files have no bushing"),
        *("ride_height = 3", "strut.flexibility", "rack_mount_compliance"),
    ):
        assert words in told, (words, told)


def test_a_second_tuning_starts_from_the_first_export(tmp_path: Path) -> None:
    first = with_values(imported(mcpherson_source()), {"llr.cubic.Fx": 0.02, "LLF.z": 213.0})
    export_adams(first, mcpherson_source(), tmp_path / "one")
    source = mcpherson_source(tmp_path / "one")
    second = with_values(imported(source), {"llr.cubic.Fx": 0.03, "LLF.z": 214.0})
    result = export_adams(second, source, tmp_path / "two")
    assert_same(second, result.axle)
    assert not result.unwritten


def test_an_orientation_comment_follows_the_points(tmp_path: Path) -> None:
    import re

    def comment(text: str) -> str:
        new = "$   ZP vector = 0.9962664021,  0.0824456161,  0.0252402867\n"
        return re.sub(r"( ORIENTATION_ZP1.*?XP3[^\n]*\n)", new, text, count=1, flags=re.S)

    place = changed(WISHBONE_DATABASE, tmp_path, FRONT, comment)
    axle = with_values(imported(wishbone_source(place)), {"LLF.z": 217.0})
    result = export_adams(axle, wishbone_source(place), tmp_path / "out")
    assert any("bushing llf: ADAMS turns it by" in s for s in result.unwritten)
    line = next(t for t in (tmp_path / "out" / FRONT).read_text().splitlines() if "ZP vector" in t)
    z = [float(v) for v in line.split("=")[1].split(",")]
    points = (390.0 - 388.0 + 14.0, 310.0, 5.0)
    length = (310.0**2 + 16.0**2 + 5.0**2) ** 0.5
    assert z == pytest.approx([310.0 / length, points[0] / length, 5.0 / length], abs=1e-9)


def test_line_ends_marks_and_encodings_stay(tmp_path: Path) -> None:
    place = changed(
        MCPHERSON_DATABASE, tmp_path, FRONT, lambda t: t.replace("Invented axle", "Erfundene Achse ä")
    )
    file = place / FRONT
    file.write_bytes(
        b"\xef\xbb\xbf"
        + file.read_text(encoding="utf-8").replace("\n", "\r\n").encode("latin-1").decode("latin-1").encode()
    )
    before = file.read_bytes()
    axle = with_values(imported(mcpherson_source(place)), {"llr.Fx": 0.8})
    export_adams(axle, mcpherson_source(place), tmp_path / "out")
    after = (tmp_path / "out" / FRONT).read_bytes()
    assert after.startswith(b"\xef\xbb\xbf") and after.count(b"\r\n") == before.count(b"\r\n")
    old, new = before.split(b"\r\n"), after.split(b"\r\n")
    assert len([1 for a, b in zip(old, new, strict=True) if a != b]) == 2  # factor and preload


def test_bad_places_and_axles_are_refused(tmp_path: Path) -> None:
    axle = imported(mcpherson_source())
    with pytest.raises(InputError, match="where the original files are"):
        export_adams(axle, mcpherson_source(), MCPHERSON_DATABASE)
    (tmp_path / "old.txt").write_text("x")
    with pytest.raises(InputError, match="not an empty folder"):
        export_adams(axle, mcpherson_source(), tmp_path)
    with pytest.raises(
        InputError, match="is a mcpherson_front, the axle to export is a double_wishbone_front"
    ):
        export_adams(nominal_of("double_wishbone_front"), mcpherson_source(), tmp_path / "new")


def test_the_result_names_its_files(tmp_path: Path) -> None:
    result = export_adams(
        with_values(imported(mcpherson_source()), {"llr.Fx": 0.8}), mcpherson_source(), tmp_path
    )
    assert isinstance(result, AdamsExport)
    assert set(result.changed) == {tmp_path / FRONT} and result.changed[tmp_path / FRONT] == 2
    assert len(result.files) == sum(p.is_file() for p in MCPHERSON_DATABASE.rglob("*"))
