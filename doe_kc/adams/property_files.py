"""Property files of an ADAMS/Car database: force curves of bushings, springs, stops and dampers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from doe_kc.adams.teim_orbit import OrbitBlock, TeimOrbitFile, read_teim_orbit
from doe_kc.adams.units import ANGLE_WORDS, FORCE_WORDS, LENGTH_WORDS, FileUnits, file_units
from doe_kc.axle.force_curve import STEEPEST_CURVE
from doe_kc.axle.model import BUSHING_AXES
from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_bytes
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class ForceTable:
    """Points of a force curve: x in mm (deg about an axis), rising; y in N (Nm). path: of their file."""

    x: FloatArray
    y: FloatArray
    path: Path


@dataclass(frozen=True)
class SpringProperty:
    """free_length: mm, None where none is stated. curve: deflection, compression positive, to force.

    remark: what was assumed in reading it; empty for nothing.
    """

    free_length: float | None
    curve: ForceTable
    remark: str = ""


def read_bushing_file(path: Path) -> dict[str, ForceTable]:
    """Axis (`Fx` … `Tz`) -> curve of a `.bus`; InputError when one is missing or no curve."""
    file = read_teim_orbit(path, "bushing file (.bus)")
    _check_type(file, "bus")
    units = file_units(file)
    out = {}
    for axis in BUSHING_AXES:
        turn = axis.startswith("T")
        block = file.one(f"{axis.upper()}_CURVE")
        factors = (units.angle, units.torque) if turn else (units.length, units.force)
        out[axis] = _curve(file, block, factors)
    return out


def read_stop_file(path: Path) -> ForceTable:
    """Curve of a `.bum` or `.reb`: deflection after contact, both positive; InputError for a formula."""
    file = read_teim_orbit(path, "stop file (.bum, .reb)")
    _check_type(file, "bum", "reb")
    units = file_units(file)
    if not file.has("CURVE"):
        raise InputError(
            f"{path}: has no [CURVE]; a stop as a polynomial is not read. Save it as a curve in ADAMS/Car. "
            "Is the file cut off?"
        )
    return _curve(file, file.one("CURVE"), (units.length, units.force))


def read_damper_file(path: Path) -> None:
    """Checks that a `.dpr` is one; a quasi-static axle has nothing of it."""
    file = read_teim_orbit(path, "damper file (.dpr)")
    _check_type(file, "dpr")
    file_units(file)
    _curve(file, file.one("CURVE"), (1.0, 1.0))


def read_spring_file(path: Path) -> SpringProperty:
    """A `.spr`, or an XML spring; InputError for anything else."""
    if read_bytes(path, "spring file (.spr, .xml)").lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        return _xml_spring(path)
    file = read_teim_orbit(path, "spring file (.spr)")
    _check_type(file, "spr")
    units = file_units(file)
    free = None
    if file.has("SPRING_DATA"):
        block = file.one("SPRING_DATA")
        if "FREE_LENGTH" in block.entries:
            free = file.number(block.entries["FREE_LENGTH"]) * units.length
    return _spring(free, _curve(file, file.one("CURVE"), (units.length, units.force)), "")


def _spring(free: float | None, curve: ForceTable, remark: str) -> SpringProperty:
    odd = np.allclose(np.interp(-curve.x, curve.x, curve.y), -curve.y, rtol=1e-6, atol=1e-6 * _size(curve.y))
    reaches = curve.x[0] <= -curve.x[-1] * (1.0 - 1e-9) and curve.x[-1] > 0.0
    if reaches and not odd:
        remark = "; ".join(filter(None, (remark, "the table is not odd: compression taken as positive")))
    return SpringProperty(free, curve, remark)


def _size(values: FloatArray) -> float:
    return float(np.abs(values).max())


def _check_type(file: TeimOrbitFile, *types: str) -> None:
    """InputError for a header that names another type or a binary format."""
    header = file.one("MDI_HEADER")
    kind = file.cell(header, "FILE_TYPE")
    if kind.text.lower() not in types:
        raise InputError(
            f"{file.path}: line {kind.line}: FILE_TYPE is {kind.text!r}, expected {' or '.join(types)}; "
            "name a file of that kind."
        )


def _curve(file: TeimOrbitFile, block: OrbitBlock, factors: tuple[float, float]) -> ForceTable:
    """The first two columns of a block's table in the project's units, in rising order."""
    table = file.table(block)
    if len(table.columns) < 2 or len(table.rows) < 2:
        raise InputError(
            f"{file.path}: line {table.line}: the table of [{block.name}] has {len(table.rows)} rows of "
            f"{len(table.columns)} columns; expected two columns and two rows at least. Is the file cut off?"
        )
    points = np.array([[file.number(cell) for cell in row[:2]] for row in table.rows]) * factors
    return _checked_curve(points, f"{file.path}: line {table.line}: the table of [{block.name}]", file.path)


def _checked_curve(points: FloatArray, where: str, path: Path) -> ForceTable:
    if points[0, 0] > points[-1, 0]:
        points = points[::-1]
    if np.any(np.diff(points[:, 0]) <= 0.0):
        row = int(np.argmax(np.diff(points[:, 0]) <= 0.0)) + 2
        raise InputError(f"{where} does not rise in its first column at row {row}; correct it.")
    with np.errstate(over="ignore"):
        steep = ~(np.abs(np.diff(points[:, 1]) / np.diff(points[:, 0])) <= STEEPEST_CURVE)
    if steep.any():
        row = int(np.argmax(steep)) + 2
        raise InputError(
            f"{where} is steeper than {STEEPEST_CURVE:g} N/mm or Nm/deg before row {row}; correct it."
        )
    return ForceTable(points[:, 0], points[:, 1], path)


def xml_name(tag: str) -> str:
    """Tag without its name space."""
    return tag.rpartition("}")[2]


def _xml_spring(path: Path) -> SpringProperty:
    """A spring of newer releases; entities are refused unread."""
    content = read_bytes(path, "spring file (.xml)")
    root = parsed_xml(content, path)
    springs = [e for e in root.iter() if xml_name(e.tag) == "SpringProperties"]
    if len(springs) != 1:
        raise InputError(f"{path}: has {len(springs)} elements SpringProperties, expected one.")
    spring, units = springs[0], _xml_units(root, path)
    free = spring.get("freeLength")
    length = None if free is None else _xml_number(free, "freeLength", path) * units.length
    method = spring.get("method", "")
    if method == "linear":
        rate = _xml_number(spring.get("rate", ""), "rate", path) * units.force / units.length
        x = np.array([-100.0, 100.0])
        return _spring(length, ForceTable(x, rate * x, path), "")
    if method != "non_linear":
        raise InputError(f"{path}: method is {method[:40]!r}, expected linear or non_linear.")
    pairs = _xml_pairs(spring, path) * (units.length, units.force)
    return _spring(
        length, _checked_curve(pairs, f"{path}: the spline", path), "its attribute rate is ignored"
    )


def parsed_xml(content: bytes, path: Path) -> ElementTree.Element:
    """Root of an XML text; InputError for what is none, or declares entities."""
    if re.search(rb"<!\s*(DOCTYPE|ENTITY)", content.replace(b"\0", b""), re.IGNORECASE):
        raise InputError(f"{path}: declares entities, which are not read; remove its DOCTYPE.")
    try:
        return ElementTree.fromstring(content)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise InputError(f"{path}: is not whole XML ({error}). Is the file cut off?") from None


def _xml_units(root: ElementTree.Element, path: Path) -> FileUnits:
    words = {
        e.get("name", ""): e.get("current", "").lower()
        for e in root.iter()
        if xml_name(e.tag) == "UnitSetting"
    }

    def factor(name: str, known: Mapping[str, float], default: float | None) -> float:
        if name not in words and default is not None:
            return default
        if words.get(name) not in known:
            raise InputError(
                f"{path}: UnitSetting {name} is {words.get(name)!r}, expected one of {', '.join(known)}."
            )
        return known[words[name]]

    length, force = factor("length", LENGTH_WORDS, None), factor("force", FORCE_WORDS, None)
    return FileUnits(length, force, factor("angle", ANGLE_WORDS, 1.0))


def _xml_pairs(spring: ElementTree.Element, path: Path) -> FloatArray:
    splines = [e for e in spring.iter() if xml_name(e.tag) == "Spline"]
    words = re.split(r"[\s,;]+", "".join(splines[0].itertext()).strip()) if len(splines) == 1 else []
    numbers = [_xml_number(word, "the spline", path) for word in words if word]
    if len(numbers) < 4 or len(numbers) % 2:
        raise InputError(
            f"{path}: has {len(splines)} splines with {len(numbers)} numbers; expected one, of pairs of "
            "deflection and force. Is the file cut off?"
        )
    return np.array(numbers).reshape(-1, 2)


def _xml_number(text: str, what: str, path: Path) -> float:
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not abs(value) < 1e15:
        raise InputError(f"{path}: {what} holds {text[:40]!r}, expected a number; correct it.")
    return value
