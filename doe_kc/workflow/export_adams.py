"""A tuned axle back into the ADAMS/Car files that it came from: copies with only the changed numbers changed.

Numbers are set one pass after the other, each pass reading its own result back, until the import of the
copies is the axle: what one number moves along with another (a spring's length with a hardpoint) follows.
"""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from doe_kc.adams.bushing_orientation import direction_rule
from doe_kc.adams.bushings import adams_axis
from doe_kc.adams.conversion import Conversion, ElementPlace, NumberPlace
from doe_kc.adams.import_axle import AdamsSource
from doe_kc.adams.property_files import read_bushing_file, read_spring_file, read_stop_file
from doe_kc.adams.springs import deflection_at
from doe_kc.adams.teim_orbit import read_teim_orbit
from doe_kc.adams.write_back import (
    FileChanges,
    number_text,
    point_to,
    rewrite_comment,
    set_number,
    split_sides,
    tuned_name,
    write_property,
    write_xml_spring,
)
from doe_kc.axle.model import BUSHING_AXES, Axle
from doe_kc.axle_types.read import DEFAULT_TYPE
from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_bytes
from doe_kc.ground.output import make_folder, write_whole
from doe_kc.workflow.adams_difference import (
    STOPS,
    AxleDifference,
    axle_differences,
    differs,
    folded,
    other_curves,
    unwritten_sentences,
)
from doe_kc.workflow.import_adams import AdamsImport, design_spring_force, import_adams

PASSES = 8
"""Corrections until the import of the copies is the axle."""


@dataclass(frozen=True)
class AdamsExport:
    """files: written, in the folder. changed: copies that differ, with the number of lines that do. added:
    property files of a new name. unwritten: sentences, what had no place. axle: import of the files."""

    files: tuple[Path, ...]
    changed: Mapping[Path, int]
    added: tuple[Path, ...]
    unwritten: tuple[str, ...]
    axle: Axle


def export_adams(axle: Axle, source: AdamsSource, out: Path) -> AdamsExport:
    """Write copies of the files of `source` into `out` with what `axle` has else.

    InputError as `import_adams`, for an axle of another type, and where `out` holds files already or is
    where the originals are.
    """
    base = import_adams(source)
    own, original = axle.topology.structure.type, base.conversion.structure
    if own != (DEFAULT_TYPE if original is None else original.type):
        raise InputError(
            f"{source.paths[0]}: is a {base.conversion.names.type}, the axle to export is a "
            f"{own}; name the files it was imported from."
        )
    copies, moved = _copy(base.conversion, source, out)
    wanted = folded(axle)
    remarks = _Remarks()
    result = base
    for _ in range(PASSES):
        result = import_adams(moved)
        if not _correct(wanted, result, remarks):
            break
    result = import_adams(moved)
    turned = tuple(_set_comments(base.conversion, result.conversion))
    files = tuple(sorted(p for p in out.rglob("*") if p.is_file()))
    return AdamsExport(
        files,
        {copy: count for old, copy in copies.items() if (count := _lines_changed(old, copy))},
        tuple(path for path in files if path not in copies.values()),
        (*turned, *remarks.sentences, *unwritten_sentences(axle, wanted, result)),
        result.axle,
    )


class _Remarks:
    """What was said on the way, and the property files made, by the place of the element that has each."""

    def __init__(self) -> None:
        self.sentences: dict[str, None] = {}
        self.made_files: dict[str, Path] = {}

    def add(self, sentence: str) -> None:
        self.sentences[sentence] = None

    def file_for(self, place: ElementPlace, path: Path) -> Path:
        """The element's own new property file: one, however many passes it takes."""
        key = f"{place.element.kind} {place.element.usage}"
        if key not in self.made_files:
            self.made_files[key] = tuned_name(path)
        return self.made_files[key]


def _copy(c: Conversion, source: AdamsSource, out: Path) -> tuple[dict[Path, Path], AdamsSource]:
    """Copies of all files below their common folder, and the source that names the copies."""
    originals = list(dict.fromkeys(path.resolve() for path in c.files))
    root = Path(os.path.commonpath([path.parent for path in originals]))
    target = out.resolve()
    if target == root or target in root.parents or root in target.parents:
        raise InputError(f"--out {out}: is where the original files are; name another folder.")
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise InputError(
            f"--out {out}: is not an empty folder; name another, so that nothing old is among it."
        )
    make_folder(out)
    copies = {path: out / path.relative_to(root) for path in originals}
    for path, copy in copies.items():
        content = read_bytes(path, "file")
        write_whole(copy, lambda p, content=content: p.write_bytes(content))  # type: ignore[misc]
    named = [copies[path.resolve()] for path in source.paths if path.resolve() in copies]
    if not named:
        assembly = c.database.assembly
        named = [copies[(assembly.path if assembly else s.path).resolve()] for s in c.database.subsystems]
    return copies, replace(source, paths=tuple(dict.fromkeys([*named, out])), type=c.names.type)


def _lines_changed(old: Path, new: Path) -> int:
    before, lines = (read_bytes(path, "file").splitlines() for path in (old, new))
    blocks = difflib.SequenceMatcher(None, before, lines, autojunk=False).get_matching_blocks()
    return len(lines) - sum(block.size for block in blocks)


def _correct(wanted: Axle, result: AdamsImport, remarks: _Remarks) -> bool:
    """One pass over the copies; whether anything was changed."""
    c = result.conversion
    files: dict[Path, FileChanges] = {}
    now = folded(result.axle)
    heads = [head for head in STOPS if head in other_curves(wanted, now)]
    for d in axle_differences(wanted, now):
        if not _set_places(c, d, files) and not _set_column(c, d, wanted, now, files):
            head, _, rest = d.path.partition(".")
            if rest.partition(".")[0] in ("stiffness", "cubic", "rate"):
                heads.append(head)
    written = False
    if not files:
        for head in dict.fromkeys(heads):
            written |= _new_property(c, wanted, now, head, files, remarks)
    if not files:
        _set_switches(c, wanted, now, files)
    if not files:
        _set_spring_force(c, wanted, now, files)
    for changes in files.values():
        changes.write()
    return bool(files) or written


def _changes(files: dict[Path, FileChanges], place: NumberPlace | ElementPlace) -> FileChanges:
    file = place.file if isinstance(place, NumberPlace) else place.subsystem.file
    return files.setdefault(file.path, FileChanges(file))


def _set_places(c: Conversion, d: AxleDifference, files: dict[Path, FileChanges]) -> bool:
    """Set a value where its number stands; a row of both sides is split where they differ."""
    own = [p for p in c.numbers if p.path == d.path]
    right = [p for p in c.numbers if p.path == f"right.{d.path}"]
    if not own and not right:
        return False
    even = not differs(abs(d.left), abs(d.right))
    for place in own:
        if place.side == "left/right" and not even:
            split_sides(_changes(files, place), place)
        elif d.left_differs or (place.side == "left/right" and d.right_differs):
            set_number(_changes(files, place), place, d.left)
    for place in right:
        if d.right_differs:
            set_number(_changes(files, place), place, d.right)
    return True


def _set_column(
    c: Conversion, d: AxleDifference, wanted: Axle, now: Axle, files: dict[Path, FileChanges]
) -> bool:
    """The column's stiffness by the factor of the torsion bar."""
    place = c.elements.get("torsion_bar")
    key = "TZ_SCALING_FACTOR"
    if d.path != "steering.column" or place is None or key not in place.element.block.entries:
        return False
    ratio = wanted.values["steering.column"] / now.values["steering.column"]
    scale = place.subsystem.number_of(place.element, key)
    _changes(files, place).set_cell(place.element.block.entries[key], number_text(scale * ratio))
    return True


def _new_property(
    c: Conversion, wanted: Axle, now: Axle, head: str, files: dict[Path, FileChanges], remarks: _Remarks
) -> bool:
    """Curves of one element in a property file of a new name, where both sides have the same."""
    place = c.elements.get(head)
    if place is None or place.property_path is None:
        return False
    uneven = [
        name
        for name in (
            n.partition("@")[0] for n in wanted.values if n.startswith(f"{head}.") and n.endswith("@L")
        )
        if name.split(".")[1] in ("stiffness", "cubic", "rate")
        and differs(wanted.values[f"{name}@L"], wanted.values[f"{name}@R"])
    ]
    if uneven:
        remarks.add(
            f"{head}: its curve is another on the right ({', '.join(uneven)}), for which there is no place"
        )
        return False
    path = place.property_path
    new = remarks.file_for(place, path)
    if place.element.kind == "bushing":
        factors = _bushing_factors(place, wanted, now, head)
        if not factors:
            return False
        write_property(path, new, factors)
    elif place.element.kind == "spring":
        ratio = wanted.values[f"{head}.rate@L"] / now.values[f"{head}.rate@L"]
        if path.suffix.lower() == ".xml":
            write_xml_spring(path, new, ratio)
        else:
            count = read_spring_file(path).curve.x.size
            write_property(path, new, {"CURVE": np.full(count, ratio)})
    else:
        factors = _stop_factors(path, wanted, head)
        if not factors:
            return False
        write_property(path, new, factors)
    for each in (place, c.elements.get(f"right.{head}")):
        if each is not None:
            point_to(_changes(files, each), each, new)
    return True


def _bushing_factors(place: ElementPlace, wanted: Axle, now: Axle, name: str) -> dict[str, np.ndarray]:
    """Force of each row over what it was, by block, where stiffness or progression differ."""
    assert place.property_path is not None
    curves = read_bushing_file(place.property_path)
    out = {}
    for axis in BUSHING_AXES:
        law = [
            (a.values[f"{name}.stiffness.{axis}@L"], a.values.get(f"{name}.cubic.{axis}@L", 0.0))
            for a in (wanted, now)
        ]
        if not any(differs(x, y) for x, y in zip(*law, strict=True)) or law[1][0] == 0.0:
            continue
        source = adams_axis(axis, place.order)
        d = curves[source].x
        (k1, c1), (k0, c0) = law
        out[f"{source.upper()}_CURVE"] = k1 * (1.0 + c1 * d**2) / (k0 * (1.0 + c0 * d**2))
    return out


def _stop_factors(path: Path, wanted: Axle, head: str) -> dict[str, np.ndarray]:
    """Force of each row over what it was; none where the wanted curve has points that the file has not."""
    curve = read_stop_file(path)
    ratios = np.ones(curve.x.size)
    for i in range(1, sum(name.startswith(f"{head}.table.x") for name in wanted.values)):
        row = np.flatnonzero(np.isclose(curve.x, wanted.values[f"{head}.table.x{i}"], rtol=1e-9))
        force = wanted.values[f"{head}.table.y{i}"]
        if row.size != 1 or (curve.y[row[0]] == 0.0) != (force == 0.0):
            return {}
        ratios[row[0]] = force / curve.y[row[0]] if force else 1.0
    return {"CURVE": ratios}


def _set_switches(c: Conversion, wanted: Axle, now: Axle, files: dict[Path, FileChanges]) -> None:
    """Hub compliance switched on where the files have it switched off."""
    if not wanted.topology.hub or now.topology.hub or c.names.hub is None:
        return
    row = c.parameter([c.names.hub.switch]) if c.names.hub.switch else None
    if row is not None and row[0].number(row[1].cell) == 0.0 and c.element("bushing", c.names.hub.usage):
        file, parameter = row
        files.setdefault(file.path, FileChanges(file)).set_cell(parameter.cell, "1")


def _set_spring_force(c: Conversion, wanted: Axle, now: Axle, files: dict[Path, FileChanges]) -> None:
    """The preload, or installed length, at which the axle stands at its static load."""
    name = next(iter(c.names.springs))
    place = c.elements.get(name)
    if place is None or c.spring_force is None or place.property_path is None:
        return
    force = design_spring_force(wanted)
    if not differs(force, c.spring_force) and not _static_load_differs(c, wanted, now):
        return
    entries, units = place.element.block.entries, place.subsystem.units
    if entries["VALUE_TYPE"].text.lower() == "preload":
        number = force / units.force
    else:
        spring = read_spring_file(place.property_path)
        assert spring.free_length is not None
        number = (spring.free_length - deflection_at(spring.curve, force)) / units.length
    if abs(number - place.subsystem.number_of(place.element, "USER_VALUE")) <= 1e-12 * abs(number):
        return
    _changes(files, place).set_cell(entries["USER_VALUE"], number_text(number))


def _static_load_differs(c: Conversion, wanted: Axle, now: Axle) -> bool:
    return "tyre.static_load" not in c.names.values and differs(
        wanted.values["tyre.static_load"], now.values["tyre.static_load"]
    )


def _set_comments(base: Conversion, c: Conversion) -> Iterator[str]:
    """Orientation comments of bushings that lie between points, brought to where these are; sentences."""
    for name, names in c.names.bushings.items():
        place, before, after = c.elements.get(name), direction_rule(base, names), direction_rule(c, names)
        if place is None or before is None or after is None or np.allclose(before, after, atol=1e-12):
            continue
        z = c.frame.signs * c.axes[name][:, 2]
        if "ORIENTATION_ZP1" in place.element.block.entries:
            continue
        changes = FileChanges(read_teim_orbit(place.subsystem.path, "subsystem file (.sub)"))
        block = next(b for b in changes.file.blocks if b.line == place.element.block.line)
        if rewrite_comment(changes, block, after if z @ after > 0 else -after):
            changes.write()
            angle = float(np.degrees(np.arccos(min(1.0, float(before @ after)))))
            yield (
                f"bushing {name}: ADAMS turns it by {angle:.2g} deg with the points it lies between, the "
                "axle does "
                "not; its comment says where it lies now"
            )
