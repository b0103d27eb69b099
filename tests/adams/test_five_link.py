"""A five-link axle, written with the names of its map and oblique bushings, is read as the shipped one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from doe_kc.adams.import_axle import AdamsSource
from doe_kc.adams.name_map import NameMap, name_map_path, read_name_map
from doe_kc.axle.model import BUSHING_AXES, Axle
from doe_kc.workflow.adams_difference import folded
from doe_kc.workflow.export_adams import export_adams
from doe_kc.workflow.import_adams import design_spring_force, import_adams
from tests.adams.test_import import apart
from tests.axle_type_reference import nominal as nominal_of

UNITS = "[UNITS]\n LENGTH='mm'\n FORCE='newton'\n ANGLE='degrees'\n"


def header(kind: str) -> str:
    return f"[MDI_HEADER]\n FILE_TYPE = '{kind}'\n FILE_FORMAT = 'ASCII'\n{UNITS}"


def write_database(axle: Axle, names: NameMap, folder: Path) -> Path:
    """One subsystem and its property files; every number with all its digits."""
    v = axle.values
    lines = [
        header("sub"),
        "[SUBSYSTEM_HEADER]\n TEMPLATE_NAME = 'own.tpl'\n MAJOR_ROLE = 'suspension'\n MINOR_ROLE = 'rear'",
        "[HARDPOINT]\n{hardpoint_name symmetry x_value y_value z_value}",
    ]
    for point, words in names.hardpoints.items():
        place = " ".join(repr(v[f"{point}.{a}@L"]) for a in "xyz")
        lines.append(f" '{words[0]}' 'left/right' {place}")
    for bushing, entry in names.bushings.items():
        lines += bushing_block(axle, bushing, entry.usage[0])
        (folder / f"{bushing}.bus").write_text("\n".join(bushing_file(axle, bushing)) + "\n")
    rate = v["spring.rate@L"]
    spring = "\n".join(f"{d} {rate * d!r}" for d in (-300.0, 0.0, 300.0))
    (folder / "own.spr").write_text(header("spr") + f"[CURVE]\n{{disp force}}\n{spring}\n")
    force = float(design_spring_force(axle))
    lines.append(
        "[NSPRING_ASSEMBLY]\n USAGE = 'spring'\n SYMMETRY = 'left/right'\n PROPERTY_FILE = 'own.spr'\n"
        f" VALUE_TYPE = 'preload'\n USER_VALUE = {force!r}"
    )
    for stop, block, file in (
        ("bump_stop", "BUMPSTOP", "own.bum"),
        ("rebound_stop", "REBOUNDSTOP", "own.reb"),
    ):
        points = sum(name.startswith(f"{stop}.table.x") for name in v)
        rows = "\n".join(f"{v[f'{stop}.table.x{i}']!r} {v[f'{stop}.table.y{i}']!r}" for i in range(points))
        (folder / file).write_text(header(file[-3:]) + f"[CURVE]\n{{disp force}}\n{rows}\n")
        lines.append(
            f"[{block}_ASSEMBLY]\n USAGE = '{stop}'\n SYMMETRY = 'left/right'\n PROPERTY_FILE = '{file}'\n"
            f" DISTANCE_TYPE = 'clearance'\n USER_DISTANCE = {v[f'{stop}.clearance@L']!r}"
        )
    lines.append("[PARAMETER]\n{parameter_name symmetry type value}")
    lines += [f" '{n}_angle' 'left/right' 'real' {v[f'static.{n}@L']!r}" for n in ("toe", "camber")]
    path = folder / "rear.sub"
    path.write_text("\n".join(lines) + "\n")
    return path


def bushing_block(axle: Axle, name: str, usage: str) -> Iterator[str]:
    (axes,) = (np.array(b.axes) for b in axle.topology.structure.bushings if b.name == name)
    yield f"[BUSHING_ASSEMBLY]\n USAGE = '{usage}'\n SYMMETRY = 'left/right'\n PROPERTY_FILE = '{name}.bus'"
    for key, column in (("ZP", 2), ("XP", 0)):
        yield from (f" ORIENTATION_{key}{i + 1} = {float(axes[i, column])!r}" for i in range(3))
    yield from (f" {axis.upper()}_SCALING_FACTOR = 1.0" for axis in BUSHING_AXES)


def bushing_file(axle: Axle, name: str) -> Iterator[str]:
    yield header("bus")
    for axis in BUSHING_AXES:
        k = axle.values[f"{name}.stiffness.{axis}@L"] * (1.0 if axis.startswith("F") else 1000.0)
        c = axle.values.get(f"{name}.cubic.{axis}@L", 0.0)
        yield f"[{axis.upper()}_CURVE]\n{{x force}}"
        yield from (f"{d} {k * (d + c * d**3)!r}" for d in (-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0))


def source_of(folder: Path) -> AdamsSource:
    folder.mkdir(parents=True, exist_ok=True)
    names = read_name_map(name_map_path("five_link_rear"))
    path = write_database(nominal_of("five_link_rear"), names, folder)
    return AdamsSource((path,), values=(("tyre.rate", 225.0), ("arb.rate", 14.0)))


def test_the_curves_are_those_of_the_shipped_axle(tmp_path: Path) -> None:
    result = import_adams(source_of(tmp_path))
    assert result.conversion.names.type == "five_link_rear"
    gaps = apart(result.axle, nominal_of("five_link_rear"))
    assert max(gaps[r] for r in ("toe", "camber", "caster", "spin")) < 1e-8
    assert max(gaps[r] for r in ("wc_x", "wc_y", "wc_z")) < 1e-7
    assert gaps["tyre_load"] < 1e-4


def test_it_goes_back(tmp_path: Path) -> None:
    from doe_kc.axle import with_values

    source = source_of(tmp_path / "in")
    axle = with_values(import_adams(source).axle, {"TLO.z": 229.5, "ufi.Fy": 1.4, "lfi.cubic.Fx": 0.012})
    result = export_adams(axle, source, tmp_path / "out")
    assert not result.unwritten
    for name, value in folded(axle).values.items():
        assert abs(folded(result.axle).values[name] - value) <= 1e-9 * max(1.0, abs(value)), name
