"""ADAMS/Car files become the axle that they were written from."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from doe_kc.adams.import_axle import AdamsSource, convert
from doe_kc.axle.model import Axle
from doe_kc.axle_file import read_axle
from doe_kc.ground.errors import InputError
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.workflow.import_adams import import_adams, write_import
from tests.adams.cases import (
    MCPHERSON_DATABASE,
    WISHBONE_DATABASE,
    changed,
    mcpherson_source,
    replaced,
    wishbone_source,
)
from tests.axle_type_reference import nominal as nominal_of
from tests.reference import nominal

FRONT = "subsystems.tbl/front.sub"


def apart(one: Axle, other: Axle) -> dict[str, float]:
    """Largest difference by response over all load cases, of curves and static angles."""
    first, second = curve_set(solve(one)), curve_set(solve(other))
    assert first.cases.keys() == second.cases.keys()
    out: dict[str, float] = {}
    for name, case in second.cases.items():
        assert np.abs(first.cases[name].input - case.input).max() <= 1e-9 * np.abs(case.input).max()
        for response, curve in case.mean.items():
            gap = float(np.abs(first.cases[name].mean[response] - curve).max())
            out[response] = max(out.get(response, 0.0), gap)
    assert first.static is not None and second.static is not None
    for response, values in second.static.items():
        assert np.abs(first.static[response] - values).max() < 1e-8
    return out


def test_the_mcpherson_axle_is_the_shipped_one_number_by_number() -> None:
    axle, shipped = import_adams(mcpherson_source()).axle, nominal()
    assert axle.values.keys() == shipped.values.keys()
    for name, value in shipped.values.items():
        assert axle.values[name] == pytest.approx(value, rel=1e-11, abs=1e-11), name
    assert axle.topology == shipped.topology and axle.follow == shipped.follow


def test_the_double_wishbone_has_the_curves_of_the_shipped_one() -> None:
    """Its bushings keep the axes of ADAMS (z along the arm), so that numbers stand under other names."""
    axle, shipped = import_adams(wishbone_source()).axle, nominal_of("double_wishbone_front")
    assert axle.values["llf.stiffness.Fz@L"] == shipped.values["llf.stiffness.Fy@L"] == 2500.0
    gaps = apart(axle, shipped)
    assert max(gaps[r] for r in ("toe", "camber", "caster", "spin")) < 1e-8
    assert max(gaps[r] for r in ("wc_x", "wc_y", "wc_z")) < 1e-7
    assert gaps["tyre_load"] < 1e-5


def test_the_axle_file_reads_back_and_says_where_numbers_came_from(tmp_path: Path) -> None:
    result, (axle_path, map_path) = write_import(mcpherson_source(), tmp_path)
    assert read_axle(axle_path).values == result.axle.values
    text = axle_path.read_text(encoding="utf-8")
    assert re.search(r"LLF = \[-2.0, -395.0, 212.0\] +# front.sub: lca_front", text)
    assert "arm_rear.bus" in text and "spring.spr" in text
    again = import_adams(AdamsSource((MCPHERSON_DATABASE,), map_path=map_path))
    assert again.axle.values == result.axle.values


def test_subsystems_named_one_by_one_are_joined_at_the_tie_rod() -> None:
    paths = tuple(MCPHERSON_DATABASE / "subsystems.tbl" / f"{n}.sub" for n in ("front", "rack", "bar"))
    result = import_adams(
        AdamsSource(paths, values=(("steering.rack_mm_per_rev", 52.0), ("tyre.rate", 220.0)))
    )
    assert "front.sub and rack.sub are joined at tierod_inner" in result.conversion.inferred
    assert result.axle.values["tyre.static_load"] == pytest.approx(4300.0, rel=1e-11)


def test_points_of_one_name_that_lie_apart_are_told(tmp_path: Path) -> None:
    place = changed(MCPHERSON_DATABASE, tmp_path, "subsystems.tbl/rack.sub", replaced("279.0", "283.5"))
    remarks = convert(mcpherson_source(place)).inferred
    assert any("tierod_inner of front.sub and rack.sub are 4.5 mm apart" in r for r in remarks)


def test_an_unknown_unit_of_the_rack_ratio_is_asked_for(tmp_path: Path) -> None:
    source = AdamsSource((MCPHERSON_DATABASE,))
    with pytest.raises(InputError, match=r"unit of REDUCTION_RATIO .* 52 mm per turn if rad/mm.*ratio_unit"):
        write_import(source, tmp_path)
    names = tmp_path / "name_map.toml"
    names.write_text(names.read_text().replace('ratio_unit = ""', 'ratio_unit = "rad/mm"'))
    result = import_adams(AdamsSource((MCPHERSON_DATABASE,), map_path=names))
    assert result.axle.rack_mm_per_rev == pytest.approx(52.0, rel=1e-12)
    assert result.axle.values["steering.column"] == pytest.approx(2070.0, rel=1e-11)


def turned_frame(text: str) -> str:
    """The hardpoints in ISO 8855: x and y with the other sign, 1000 mm higher; bushing axes likewise."""

    def row(match: re.Match[str]) -> str:
        x, y, z = (float(v) for v in match[2].split())
        return f"{match[1]} {-x} {-y} {z + 1000.0}"

    text = re.sub(r"(?m)^( '\w+ *'  '(?:left/right|single)') +((?:[-\d.]+ +){2}[-\d.]+)$", row, text)
    return re.sub(r"(ORIENTATION_[ZX]P[12] +=  )([-\d.]+)", lambda m: f"{m[1]}{-float(m[2])}", text)


@pytest.mark.parametrize("database", [MCPHERSON_DATABASE, WISHBONE_DATABASE], ids=["mcpherson", "wishbone"])
def test_another_frame_gives_the_same_axle(database: Path, tmp_path: Path) -> None:
    for name in ("front", "rack", "bar"):
        place = changed(database, tmp_path, f"subsystems.tbl/{name}.sub", turned_frame)
    names = tmp_path / "names.toml"
    kind = "mcpherson_front" if database is MCPHERSON_DATABASE else "double_wishbone_front"
    shipped = Path(convert.__code__.co_filename).parent / "name_maps" / f"{kind}.toml"
    names.write_text(shipped.read_text().replace("# ground_z = 0.0", "ground_z = 1000.0"))
    make = mcpherson_source if database is MCPHERSON_DATABASE else wishbone_source
    here, there = convert(make(database)), convert(make(place, map_path=names))
    assert "the frame is X forwards, Y left, Z up" in " ".join(there.inferred)
    assert there.document["hardpoints"] == here.document["hardpoints"]
    assert there.document["bushings"] == here.document["bushings"]


def test_other_units_give_the_same_axle(tmp_path: Path) -> None:
    def inches(text: str) -> str:
        def row(match: re.Match[str]) -> str:
            return f"{match[1]} " + " ".join(repr(float(v) / 25.4) for v in match[2].split())

        text = re.sub(r"(?m)^( '\w+ *'  '(?:left/right|single)') +((?:[-\d.]+ +){2}[-\d.]+)$", row, text)
        text = re.sub(r"(USER_DISTANCE +=  )([\d.]+)", lambda m: f"{m[1]}{float(m[2]) / 25.4!r}", text)
        text = re.sub(
            r"(USER_VALUE +=  )([\d.]+)", lambda m: f"{m[1]}{float(m[2]) / 4.4482216152605!r}", text
        )
        return text.replace("'mm'", "'inch'").replace("'newton'", "'pound_force'")

    place = changed(MCPHERSON_DATABASE, tmp_path, FRONT, inches)
    here, there = convert(mcpherson_source()), convert(mcpherson_source(place))
    for point, values in here.document["hardpoints"].items():
        assert there.document["hardpoints"][point] == pytest.approx(values, abs=1e-9), point
    assert there.spring_force == pytest.approx(here.spring_force, rel=1e-12)
    assert there.document["bump_stop"]["clearance"] == pytest.approx(22.0, rel=1e-12)


def test_axes_against_the_types_turn_unsymmetric_curves_and_preloads(tmp_path: Path) -> None:
    """llf of the McPherson axle: local y is ADAMS z, local z is against ADAMS y."""

    def softer_one_way(text: str) -> str:
        return text.replace("-4.0                 -40000.0\n", "-4.0                 -20000.0\n")

    place = changed(MCPHERSON_DATABASE, tmp_path, "bushings.tbl/arm_front.bus", softer_one_way)
    changed(
        MCPHERSON_DATABASE, tmp_path, FRONT, replaced("T_PRELOAD_Y             =  0.0", "T_PRELOAD_Y = 50.0")
    )
    table = convert(mcpherson_source(place)).document["bushings"]["llf"]
    assert table["table"]["Fx"][0] == [-4.0, -20000.0]
    assert table["table"]["Fz"][-1] == [4.0, 20000.0]
    assert table["preload"] == {"Fz": 50.0}
    assert table["stiffness"]["Fy"] == 2000.0


def test_the_i_part_turns_curves_and_preloads(tmp_path: Path) -> None:
    place = changed(
        MCPHERSON_DATABASE, tmp_path, FRONT, replaced("T_PRELOAD_X             =  0.0", "T_PRELOAD_X = 50.0")
    )
    names = tmp_path / "names.toml"
    shipped = Path(convert.__code__.co_filename).parent / "name_maps" / "mcpherson_front.toml"
    text = shipped.read_text()
    names.write_text(
        text.replace(
            'llf = { usage = ["lca_front"], i_part = "outer"',
            'llf = { usage = ["lca_front"], i_part = "inner"',
        )
    )
    outer = convert(mcpherson_source(place)).document["bushings"]["llf"]["preload"]
    inner = convert(mcpherson_source(place, map_path=names)).document["bushings"]["llf"]["preload"]
    assert outer == {"Fx": -50.0} and inner == {"Fx": 50.0}


def test_factors_sides_switches_and_zeros(tmp_path: Path) -> None:
    def edit(text: str) -> str:
        text = text.replace("FX_SCALING_FACTOR       =  1.0", "FX_SCALING_FACTOR       =  1.25", 1)
        text = text.replace("TY_SCALING_FACTOR       =  1.0", "TY_SCALING_FACTOR       =  0.0", 1)
        row = " 'lca_rear                    '  'left/right'       300.0      -370.0       218.0"
        assert row in text
        right = row.replace("'left/right'", "'right'").replace("-370.0", "371.0")
        text = text.replace(row, row.replace("'left/right'", "'left'") + "\n" + right)
        return text.replace(
            "'subframe_active             '  'single'  'integer'  1",
            "'subframe_active             '  'single'  'integer'  0",
        )

    c = convert(mcpherson_source(changed(MCPHERSON_DATABASE, tmp_path, FRONT, edit)))
    llf = c.document["bushings"]["llf"]
    assert llf["factor"] == {"Fx": 1.25}
    assert llf["stiffness"]["Tz"] == 1e-3  # ADAMS y is local z
    assert c.document["right"] == {"LLR.y": 371.0}
    assert c.document["bushings"]["sff"]["stiffness"]["Fx"] == 1e6
    assert any("sff is rigid: subframe_active = 0" in r for r in c.inferred)
    assert any("Tz is taken as free to turn: its factor is 0" in r for r in c.inferred)


def test_orientation_from_the_comment_and_from_the_points(tmp_path: Path) -> None:
    def comment(text: str) -> str:
        return re.sub(
            r"( ORIENTATION_ZP1.*?XP3[^\n]*\n)",
            "$   ZP vector = 1.0,  0.0,  0.0\n",
            text,
            count=1,
            flags=re.S,
        )

    place = changed(WISHBONE_DATABASE, tmp_path, FRONT, comment)
    c = convert(wishbone_source(place))
    assert "bushing llf: orientation from its comment" in c.inferred
    assert any("llf" in r and "beside the points it depends on" in r for r in c.inferred)
    assert c.axes["llf"][:, 2] == pytest.approx([1.0, 0.0, 0.0])
    place = changed(
        WISHBONE_DATABASE, tmp_path, FRONT, lambda t: t.replace("$   ZP vector = 1.0,  0.0,  0.0\n", "")
    )
    c = convert(wishbone_source(place))
    along = np.subtract(c.document["hardpoints"]["LLR"], c.document["hardpoints"]["LLF"])
    assert c.axes["llf"][:, 2] == pytest.approx(along / np.linalg.norm(along))
    assert "bushing llf: orientation from the points it lies between" in c.inferred


def test_a_top_mount_turned_about_its_own_axis_is_the_same(tmp_path: Path) -> None:
    """Equal curves across: 40 deg about z are no difference."""
    x, y = math.cos(math.radians(40.0)), math.sin(math.radians(40.0))

    def turn(text: str) -> str:
        head, mount = text.split(" USAGE                   =  'top_mount'")
        mount = mount.replace("ORIENTATION_XP1         =  1.0", f"ORIENTATION_XP1         =  {x}", 1)
        mount = mount.replace("ORIENTATION_XP2         =  0.0", f"ORIENTATION_XP2         =  {y}", 1)
        return head + " USAGE                   =  'top_mount'" + mount

    here = convert(mcpherson_source())
    there = convert(mcpherson_source(changed(MCPHERSON_DATABASE, tmp_path, FRONT, turn)))
    assert there.document["bushings"]["upb"] == here.document["bushings"]["upb"]


def test_a_hub_bushing_that_is_switched_on_is_the_effect(tmp_path: Path) -> None:
    off = convert(wishbone_source())
    assert "effects" not in off.document and any("hub_compliance_active = 0" in r for r in off.left_out)
    on = changed(
        WISHBONE_DATABASE, tmp_path, FRONT,
        lambda t: re.sub(r"('hub_compliance_active +' .*)0", r"\g<1>1", t),
    )  # fmt: skip
    result = import_adams(wishbone_source(on))
    assert result.conversion.document["effects"] == {
        "hub_compliance": {"camber_Nm_deg": 6000.0, "toe_Nm_deg": 9000.0}
    }
    assert result.axle.topology.hub


def test_a_spring_that_is_not_straight_has_its_rate_at_design(tmp_path: Path) -> None:
    def progressive(text: str) -> str:
        return re.sub(
            r"(?m)^ +(-?\d+\.0) +(-?[\d.]+)$",
            lambda m: f" {m[1]} {28.0 * float(m[1]) + 0.01 * float(m[1]) * abs(float(m[1]))}",
            text,
        )

    place = changed(MCPHERSON_DATABASE, tmp_path, "springs.tbl/spring.spr", progressive)
    c = convert(mcpherson_source(place))
    assert 28.0 < c.document["spring"]["rate"] < 36.0
    assert any("is not straight" in r for r in c.inferred)


def test_the_type_is_told_by_the_hardpoints() -> None:
    assert convert(mcpherson_source()).names.type == "mcpherson_front"
    assert convert(wishbone_source()).names.type == "double_wishbone_front"


def test_every_type_with_a_name_map_has_every_name() -> None:
    from doe_kc.adams.name_map import MAPPED_TYPES, name_map_path, read_name_map
    from doe_kc.axle_types import read_axle_type

    for kind in set(MAPPED_TYPES) - {"mcpherson_front"}:
        names, s = read_name_map(name_map_path(kind)), read_axle_type(kind, Path(), source=kind).structure
        assert set(names.hardpoints) == {*s.points, *s.single_points}
        assert set(names.bushings) == {b.name for b in s.bushings}
        assert set(names.springs) == {p.name for p in s.springs}


def test_the_racks_mount_is_the_slope_of_its_bushings_along_y(tmp_path: Path) -> None:
    """Its local z lies along Y; two of them carry the rack, and a curve counts by its slope at zero."""

    def mount(text: str) -> str:
        block = (
            "[BUSHING_ASSEMBLY]\n USAGE = 'rack_housing'\n SYMMETRY = 'left/right'\n"
            " PROPERTY_FILE = '<OWN>/bushings.tbl/arm_rear.bus'\n FZ_SCALING_FACTOR = 0.5\n"
            " ORIENTATION_ZP1 = 0.0\n ORIENTATION_ZP2 = 1.0\n ORIENTATION_ZP3 = 0.0\n"
            " ORIENTATION_XP1 = 1.0\n ORIENTATION_XP2 = 0.0\n ORIENTATION_XP3 = 0.0\n"
        )
        return text + block

    place = changed(MCPHERSON_DATABASE, tmp_path, "subsystems.tbl/rack.sub", mount)
    c = convert(mcpherson_source(place))
    assert c.document["effects"]["rack_mount_compliance"] == {"k_N_mm": 600.0}  # 2 x 0.5 x 600
    bend = replaced("-2.0                  -1248.0", "-2.0                  -1249.0")
    changed(MCPHERSON_DATABASE, tmp_path, "bushings.tbl/arm_rear.bus", bend)
    curved = convert(mcpherson_source(place))
    slope = curved.document["effects"]["rack_mount_compliance"]["k_N_mm"]
    assert slope == pytest.approx(601.5, rel=1e-6)  # 300.75 N at 0.5 mm
    assert "arm_rear.bus: Fy is not straight; its slope at zero counts" in curved.inferred
