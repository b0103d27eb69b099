"""Correction of the copies of ADAMS/Car files: numbers, curves, switches that the axle has else than they."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from doe_kc.adams.bushings import adams_axis
from doe_kc.adams.conversion import Conversion, ElementPlace, NumberPlace
from doe_kc.adams.property_files import read_bushing_file, read_spring_file, read_stop_file
from doe_kc.adams.springs import deflection_at
from doe_kc.adams.write_back import (
    FileChanges,
    number_text,
    point_to,
    set_number,
    split_sides,
    tuned_name,
    write_property,
    write_xml_spring,
)
from doe_kc.axle.model import BUSHING_AXES, Axle
from doe_kc.workflow.adams_difference import (
    STOPS,
    AxleDifference,
    axle_differences,
    differs,
    folded,
    other_curves,
)
from doe_kc.workflow.import_adams import AdamsImport, design_spring_force


class ExportRemarks:
    """What an export says on the way, and the property files that it makes. sentences: each once, in order.
    made_files: new path by kind and usage of the element."""

    def __init__(self) -> None:
        self.sentences: dict[str, None] = {}
        self.made_files: dict[str, Path] = {}

    def add(self, sentence: str) -> None:
        """A sentence for the user, said once however many passes come to it."""
        self.sentences[sentence] = None

    def file_for(self, place: ElementPlace, path: Path) -> Path:
        """The element's own new property file: one, however many passes it takes."""
        key = f"{place.element.kind} {place.element.usage}"
        if key not in self.made_files:
            self.made_files[key] = tuned_name(path)
        return self.made_files[key]


def correct_copies(wanted: Axle, result: AdamsImport, remarks: ExportRemarks) -> bool:
    """One pass over the copies of an export; whether anything was changed.

    wanted: the axle, folded. result: import of the copies as they are. remarks: gains what has no place.
    InputError for a spring whose force does not rise; RunError where the axle has no static state, and where
    a copy cannot be split by side.
    """
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
    c: Conversion, wanted: Axle, now: Axle, head: str, files: dict[Path, FileChanges], remarks: ExportRemarks
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
