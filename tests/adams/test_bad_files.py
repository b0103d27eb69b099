"""Files that are broken, strange or hostile: one sentence that names file, line and remedy."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from doe_kc.adams.completeness import refuse_missing
from doe_kc.adams.import_axle import AdamsSource, convert
from doe_kc.adams.property_files import read_bushing_file, read_damper_file, read_spring_file, read_stop_file
from doe_kc.adams.subsystem import read_subsystem
from doe_kc.ground.errors import InputError
from tests.adams.cases import (
    MCPHERSON_DATABASE,
    WISHBONE_DATABASE,
    changed,
    mcpherson_source,
    replaced,
    wishbone_source,
)

FRONT, BUS = "subsystems.tbl/front.sub", "bushings.tbl/arm_rear.bus"
BUMP = "bumpstops.tbl/bump.bum"
ASSEMBLY, RACK = "assemblies.tbl/front_axle.asy", "subsystems.tbl/rack.sub"


def after(word: str) -> Callable[[str], str]:
    """Cut off behind a word."""
    return lambda text: text[: text.index(word) + len(word)]


CASES: dict[str, tuple[str, Callable[[str], str], str]] = {
    "subsystem cut in its header": (FRONT, after("FILE_TYPE"), r"front.sub: line 3: .*cut off"),
    "subsystem cut in its points": (FRONT, after(
        "'lca_rear                    '  'left/right'"
    ), r"2 cells, expected 5.*cut off"),
    "subsystem cut in a quote": (FRONT, after(
        " USAGE                   =  'lca_"
    ), r"front.sub: line \d+: .*SYMMETRY|lacks"),
    "subsystem cut in a bushing": (FRONT, after(
        "SYMMETRY                =  'left/right'"
    ), r"lacks PROPERTY_FILE|missing|lacks"),
    "bushing cut off": (BUS, after(
        "[FZ_CURVE]"
    ), r"arm_rear.bus: line \d+: \[FZ_CURVE\] has no table.*cut off"),
    "bushing cut in a row": (BUS, after(
        "[FX_CURVE]\n{     x          fx}\n                     -4.0"
    ), r"1 cells, expected 2|rows"),
    "bushing without a curve": (BUS, replaced("[TZ_CURVE]", "[XX_CURVE]"), r"has no block \[TZ_CURVE\]"),
    "a block twice": (
        BUS, lambda t: t + "[FX_CURVE]\n{x fx}\n-1 -1\n1 1\n",
        r"line \d+: a second block \[FX_CURVE\]",
    ),
    "an unknown unit": (FRONT, replaced("'mm'", "'furlong'"), r"LENGTH is 'furlong', expected one of mm"),
    "a misspelt unit": (FRONT, replaced("'newton'", "'newtn'"), r"FORCE is 'newtn'.*Did you mean \"newton\""),
    "no units": (BUS, replaced("[UNITS]", "[NO_UNITS]"), r"has no block \[UNITS\]"),
    "a missing property file": (
        FRONT, replaced("arm_rear.bus", "not_there.bus"),
        r"not_there.bus is missing; looked in",
    ),
    "a name that no file can have": (
        FRONT, replaced("arm_rear.bus", 300 * "9"),
        r"which is no path of a database",
    ),
    "a line that no program wrote": (
        FRONT, replaced("arm_rear.bus", 300 * "9999/"),
        r"front.sub: line \d+: has \d+ characters, expected at most 1000",
    ),
    "a path out of the database": (
        FRONT, replaced("<OWN>/bushings.tbl/arm_rear.bus", "<OWN>/../../x.bus"),
        r"no path of a database",
    ),
    "a huge number": (BUS, replaced("3.5 ", "1e300 "), r"1e300 is larger than any number"),
    "a number of another kind": (FRONT, replaced("212.0", "nan"), r"nan is larger|not a number"),
    "text for a number": (FRONT, replaced("212.0", "zwei"), r"'zwei' is not a number"),
    "a hardpoint twice": (
        FRONT, replaced("'lca_rear                    '", "'lca_front                   '"),
        r"hardpoint lca_front .* is there already in line",
    ),
    "a bushing twice": (
        FRONT, replaced(
            "USAGE                   =  'lca_rear'",
            "USAGE                   =  'lca_front'",
        ),
        r"bushing lca_front .* is there already",
    ),
    "an unknown symmetry": (
        FRONT, replaced("'left/right'", "'both'"),
        r"symmetry is 'both', expected left/right",
    ),
    "an unknown column": (FRONT, replaced("x_value", "x"), r"no column x_value"),
    "a heading without end": (FRONT, replaced("z_value}", "z_value"), r"lacks its closing brace"),
    "an unknown bushing class": (
        FRONT, replaced(".ACAR.attachments.ac_bushing", ".ARIDE.attachments.ac_frequency_bushing"),
        r"class .ARIDE.*not read.*llf.stiffness.Fx",
    ),
    "a wrong file type": (
        FRONT, replaced("FILE_TYPE     =  'sub'", "FILE_TYPE     =  'tpl'"),
        r"FILE_TYPE is 'tpl', expected 'sub'",
    ),
    "a bushing file that is a spring": (BUS, replaced("'bus'", "'spr'"), r"FILE_TYPE is 'spr', expected bus"),
    "no suspension": (FRONT, replaced("'suspension'", "'body'"), r"no suspension of the front axle"),
    "the rear axle": (
        FRONT, replaced("MINOR_ROLE     =  'front'", "MINOR_ROLE     =  'rear'"),
        r"no suspension of the front axle|none of the types",
    ),
    "a curve that falls": (
        BUS, replaced("                     -2.0", "                     -9.0"),
        r"does not rise in its first column",
    ),
    "a curve steeper than any part": (
        BUS, replaced("                     -2.0", "                     -2.4999999999999"),
        r"steeper than 1e\+12 N/mm .* before row 5",
    ),
    "a falling force": (
        BUS, lambda t: re.sub(r"(?m)^( +4\.0 +)(\S+)$", r"\g<1>1.0", t, count=1),
        r"falls from .* expected a curve that never falls",
    ),
    "a negative factor": (
        FRONT, replaced("FX_SCALING_FACTOR       =  1.0", "FX_SCALING_FACTOR       =  -1.0"),
        r"FX_SCALING_FACTOR is -1, expected 0 or more",
    ),
    "a stop as a formula": (BUMP, replaced("[CURVE]", "[POLYNOMIAL]"), r"a stop as a polynomial is not read"),
    "a stop with force at contact": (
        BUMP, replaced("              0.0              0.0", "              0.0             50.0"),
        r"50 N at contact, expected 0",
    ),
    "an unknown distance": (
        FRONT, replaced("'clearance'", "'gap'"),
        r"DISTANCE_TYPE is 'gap', expected clearance or impact_length",
    ),
    "an unknown spring value": (
        FRONT, replaced("VALUE_TYPE     =  'preload'", "VALUE_TYPE     =  'torque'"),
        r"VALUE_TYPE is 'torque', expected preload or installed_length",
    ),
    "an assembly within itself": (
        ASSEMBLY, replaced("subsystems.tbl/front.sub", "assemblies.tbl/front_axle.asy"),
        r"front_axle.asy, itself; expected a subsystem",
    ),
    "an assembly of nothing": (
        ASSEMBLY, lambda t: t.replace("[SUBSYSTEM]", "[OTHER]"),
        r"no block \[SUBSYSTEM\]",
    ),
    "a ratio of zero": (
        RACK, lambda t: re.sub(r"(REDUCTION_RATIO  =  )\S+", r"\g<1>0.0", t),
        r"REDUCTION_RATIO is 0",
    ),
    "the wheel centre at the origin": (
        FRONT, replaced("-790.0       310.0", "-790.0         0.0"),
        r"ground_z under \[frame\]",
    ),
    "a point of the middle": (
        FRONT, replaced(
            "'wheel_center                '  'left/right'",
            "'wheel_center                '  'single'",
        ),
        r"'single', but WLC of the type is one a side",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", list(CASES))
def test_one_sentence_that_names_the_file(case: str, tmp_path: Path) -> None:
    file, change, pattern = CASES[case]
    place = changed(MCPHERSON_DATABASE, tmp_path, file, change)
    with pytest.raises(InputError) as error:
        refuse_missing(convert(mcpherson_source(place, type="mcpherson_front")))
    message = str(error.value)
    assert re.search(pattern, message), message
    assert "\n" not in message and str(place) in message and message.endswith((".", "?")), message


def test_what_is_unknown_is_listed_and_left_out(tmp_path: Path) -> None:
    def more(text: str) -> str:
        return text + "[NEW_THING]\n KEY = 1\n whatever this is\n[NEW_THING]\n"

    c = convert(mcpherson_source(changed(MCPHERSON_DATABASE, tmp_path, FRONT, more)))
    assert c.left_out.count("front.sub: block [NEW_THING] is not known") == 1
    assert not c.missing


def test_a_bushing_of_an_unread_class_can_be_given_by_values(tmp_path: Path) -> None:
    place = changed(
        MCPHERSON_DATABASE, tmp_path, FRONT,
        replaced(".ACAR.attachments.ac_bushing", ".ARIDE.attachments.ac_frequency_bushing"),
    )  # fmt: skip
    values = tuple((f"llf.stiffness.{axis}", 5.0) for axis in ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz"))
    source = AdamsSource((place,), values=(("steering.rack_mm_per_rev", 52.0), *values))
    c = convert(source)
    assert not c.missing and c.document["bushings"]["llf"]["stiffness"]["Fx"] == 5.0


def test_a_binary_template_is_told_and_not_read(tmp_path: Path) -> None:
    place = tmp_path / "copy.cdb"
    shutil.copytree(MCPHERSON_DATABASE, place)
    (place / "templates.tbl").mkdir()
    (place / "templates.tbl" / "_macpherson.tpl").write_bytes(bytes(range(256)) * 4)
    (place / "templates.tbl" / "_antirollbar.tpl").write_text("! ASCII\n")
    c = convert(mcpherson_source(place))
    assert any("_macpherson.tpl is binary, not read" in r for r in c.left_out)
    assert any("_antirollbar.tpl is there, not read" in r for r in c.left_out)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_marks_and_encodings_are_read(encoding: str, tmp_path: Path) -> None:
    place = changed(MCPHERSON_DATABASE, tmp_path, FRONT, replaced("Invented axle", "Erfundene Achse ä"))
    text = (place / FRONT).read_text(encoding="utf-8")
    (place / FRONT).write_bytes(text.encode(encoding))
    assert convert(mcpherson_source(place)).document == convert(mcpherson_source()).document


def test_names_and_folders_are_found_whatever_their_case(tmp_path: Path) -> None:
    place = tmp_path / "copy.cdb"
    shutil.copytree(MCPHERSON_DATABASE, place)
    (place / "bushings.tbl").rename(place / "BUSHINGS.TBL")
    (place / "BUSHINGS.TBL" / "arm_rear.bus").rename(place / "BUSHINGS.TBL" / "Arm_Rear.BUS")
    assert convert(mcpherson_source(place)).document == convert(mcpherson_source()).document


def test_another_database_is_given_beside(tmp_path: Path) -> None:
    place = tmp_path / "copy.cdb"
    shutil.copytree(MCPHERSON_DATABASE, place)
    (place / "bushings.tbl").rename(tmp_path / "bushings.tbl")
    with pytest.raises(InputError, match="Add the folder of its database"):
        convert(mcpherson_source(place / ASSEMBLY))
    values = (("steering.rack_mm_per_rev", 52.0),)
    c = convert(AdamsSource((place / ASSEMBLY, tmp_path / "bushings.tbl"), values=values))
    assert c.document["bushings"] == convert(mcpherson_source()).document["bushings"]


@pytest.mark.parametrize(
    ("change", "pattern"),
    [
        (replaced("<?xml", '<!DOCTYPE x [<!ENTITY a "b">]><?xml'), "declares entities"),
        (lambda t: t[:400], "not whole XML"),
        (replaced("non_linear", "cubic"), "method is 'cubic'"),
        (replaced('current="newton"', 'current="stone"'), "UnitSetting force is 'stone'"),
        (replaced("-100.0, -7200.0", "-100.0"), "13 numbers; expected one, of pairs"),
        (replaced("-7200.0", "1e300"), "holds '1e300'"),
        (replaced("freeLength", "length"), "has no FREE_LENGTH"),
        (replaced("SpringProperties", "Properties"), "SpringProperties|not whole XML"),
    ],
)
def test_xml_springs_that_are_wrong(change: Callable[[str], str], pattern: str, tmp_path: Path) -> None:
    place = changed(WISHBONE_DATABASE, tmp_path, "springs.tbl/spring.xml", change)
    with pytest.raises(InputError, match=pattern) as error:
        convert(wishbone_source(place))
    assert "spring.xml" in str(error.value)


def test_pipes_and_devices_are_refused_at_once(tmp_path: Path) -> None:
    place = tmp_path / "copy.cdb"
    shutil.copytree(MCPHERSON_DATABASE, place)
    (place / FRONT).unlink()
    os.mkfifo(place / FRONT)
    readers = (read_subsystem, read_bushing_file, read_spring_file, read_stop_file, read_damper_file)
    for reader in readers:
        for path in (place / FRONT, Path("/dev/zero")):
            with pytest.raises(InputError, match="pipe or a device"):
                reader(path)
    code = (
        "import sys; from tests.adams.cases import mcpherson_source; from pathlib import Path\n"
        "from doe_kc.adams.import_axle import convert\n"
        "convert(mcpherson_source(Path(sys.argv[1]), type='mcpherson_front'))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(place)], capture_output=True, text=True, timeout=60, check=False
    )
    assert "InputError" in done.stderr and "pipe or a device" in done.stderr


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"hello",
        b"\0" * 100,
        b"\xff\xfe\x00",
        "[MDI_HEADER]\n".encode("utf-16"),
        b"[" * 100000,
        b"{" * 100000 + b"\n[A]\n" + b"=" * 100000,
    ],
)
def test_no_reader_takes_what_is_no_file_of_its_kind(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "strange.bus"
    path.write_bytes(content)
    for reader in (read_subsystem, read_bushing_file, read_spring_file, read_stop_file, read_damper_file):
        with pytest.raises(InputError, match=r"strange\.bus"):
            reader(path)


def test_paths_that_are_no_start_are_refused(tmp_path: Path) -> None:
    for paths, pattern in (
        ((tmp_path / "none.sub",), "no such file or folder"),
        ((tmp_path / (300 * "9"),), "no such file or folder"),
        ((tmp_path,), "holds 0 assemblies"),
        ((MCPHERSON_DATABASE, WISHBONE_DATABASE), "expected one folder"),
        ((MCPHERSON_DATABASE.parent,), "holds 2 assemblies"),
        ((MCPHERSON_DATABASE / BUS,), "is no subsystem"),
        ((MCPHERSON_DATABASE / ASSEMBLY, WISHBONE_DATABASE / ASSEMBLY), "is a second assembly"),
        ((MCPHERSON_DATABASE / FRONT, WISHBONE_DATABASE / FRONT), "is a second subsystem suspension"),
    ):
        with pytest.raises(InputError, match=pattern):
            convert(AdamsSource(paths, type="mcpherson_front"))


@pytest.mark.parametrize(
    ("old", "new", "pattern"),
    [
        ('type = "mcpherson_front"', 'type = "mcpherson"', "is no axle type"),
        ("WLC = ", "WCL = ", 'hardpoints.WCL is unknown.*Did you mean "WLC"'),
        ("llf = {", "lff = {", "bushings.lff is unknown"),
        ('ratio_unit = ""', 'ratio_unit = "mm"', "steering.ratio_unit"),
        ("[frame] ", '[frame]\nx = "forwards"\n#', "left-handed|contradict"),
        ("[values] ", '[values]\n"llf.Q" = 1.0\n#', "values.llf.Q is no parameter"),
        ('"lca_outer"', '"nowhere"', "no hardpoint for LWB"),
    ],
)
def test_name_maps_that_are_wrong(old: str, new: str, pattern: str, tmp_path: Path) -> None:
    shipped = Path(convert.__code__.co_filename).parent / "name_maps" / "mcpherson_front.toml"
    names = tmp_path / "names.toml"
    text = shipped.read_text()
    assert old in text
    names.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=pattern):
        convert(mcpherson_source(map_path=names))


def test_a_subsystem_of_another_part_may_be_missing_or_broken(tmp_path: Path) -> None:
    def more(text: str) -> str:
        usage = "[SUBSYSTEM]\n USAGE = '<OWN>/subsystems.tbl/{}.sub'\n"
        return text + usage.format("body") + usage.format("brakes")

    place = changed(MCPHERSON_DATABASE, tmp_path, ASSEMBLY, more)
    text = (place / FRONT).read_text().replace("'suspension'", "'brake_system'").replace("'mm'", "'ell'")
    (place / "subsystems.tbl" / "brakes.sub").write_text(text)
    c = convert(mcpherson_source(place / ASSEMBLY))
    assert c.document == convert(mcpherson_source()).document
    assert any("body.sub is not there" in r for r in c.left_out)
    assert any("brakes.sub: subsystem brake_system, front, is of another part" in r for r in c.left_out)


def test_the_tyres_own_file_tells_its_stiffness(tmp_path: Path) -> None:
    place = changed(MCPHERSON_DATABASE, tmp_path, ASSEMBLY, replaced("tire_stiffness", "tyre_of_rig   "))
    changed(
        MCPHERSON_DATABASE,
        tmp_path,
        ASSEMBLY,
        lambda t: t + "[SUBSYSTEM]\n USAGE = '<OWN>/subsystems.tbl/wheel.sub'\n",
    )
    (place / "tires.tbl").mkdir()
    (place / "tires.tbl" / "own.tir").write_text(
        "[MDI_HEADER]\nFILE_TYPE = 'tir'\n! a remark\n[UNITS]\nLENGTH = 'meter'\nFORCE = 'newton'\nANGLE = "
        "'radians'\n"
        "[VERTICAL]\nVERTICAL_STIFFNESS = 2.2e+05  $ N/m\n"
    )
    (place / "subsystems.tbl" / "wheel.sub").write_text(
        "[MDI_HEADER]\nFILE_TYPE = 'sub'\n[UNITS]\nLENGTH = 'mm'\nFORCE = 'newton'\nANGLE = 'deg'\n"
        "[SUBSYSTEM_HEADER]\nTEMPLATE_NAME = '_tire.tpl'\nMAJOR_ROLE = 'wheel'\nMINOR_ROLE = 'front'\n"
        "[WHEEL_ASSEMBLY]\nUSAGE = 'wheel'\nSYMMETRY = 'left/right'\nPROPERTY_FILE = "
        "'<OWN>/tires.tbl/own.tir'\n"
    )
    c = convert(mcpherson_source(place / ASSEMBLY))
    assert c.document["tyre"]["rate"] == 220.0 and not c.missing
