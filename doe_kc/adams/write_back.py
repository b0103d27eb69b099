"""Changes of ADAMS/Car files: single numbers, rows and blocks split by side, property files of a new name."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from doe_kc.adams.conversion import ElementPlace, NumberPlace
from doe_kc.adams.orientation import VECTOR_COMMENT
from doe_kc.adams.property_files import parsed_xml, xml_name
from doe_kc.adams.teim_orbit import Cell, OrbitBlock, TeimOrbitFile, read_teim_orbit
from doe_kc.ground.errors import RunError
from doe_kc.ground.files import read_bytes
from doe_kc.ground.output import write_whole
from doe_kc.ground.typing import FloatArray

TUNED = "_tuned"
"""What the name of a changed property file ends with."""


@dataclass
class FileChanges:
    """Changes of one file, not yet written: (start, end) in characters -> text."""

    file: TeimOrbitFile
    changes: dict[tuple[int, int], str] = field(default_factory=dict)

    def set_cell(self, cell: Cell, text: str) -> None:
        """Another text in a cell's place, quoted as it was; a row's columns stay where they are."""
        start, width = cell.start, cell.end - cell.start
        if cell.quoted:
            text = f"'{text:<{width - 2}}'"
        elif "=" not in self.file.text[self.file.text.rfind("\n", 0, start) + 1 : start]:
            while len(text) > cell.end - start and self.file.text[start - 2 : start] == "  ":
                start -= 1
            text = text.rjust(cell.end - start)
        self.changes[start, cell.end] = text

    def write(self) -> None:
        """The file with its changes."""
        content = self.file.replaced(self.changes)
        write_whole(self.file.path, lambda p: p.write_bytes(content))


def number_text(value: float) -> str:
    """A number with all its digits, as short as reads back the same."""
    return repr(float(value))


def set_number(changes: FileChanges, place: NumberPlace, value: float) -> None:
    """The number that makes a parameter have that value."""
    changes.set_cell(place.cell, number_text((value - place.shift) / place.gain))


def split_sides(changes: FileChanges, place: NumberPlace) -> None:
    """A row or block of both sides becomes one of the left and one of the right, with equal numbers.

    The y coordinate of a hardpoint's right row has the other sign.
    """
    text = changes.file.text
    if place.block is not None:
        _split(changes, place.block.start, place.block.end, place.side_cell, ())
        return
    start = text.rfind("\n", 0, place.cell.start) + 1
    end = text.find("\n", place.cell.end)
    end = len(text) if end < 0 else end + 1
    lateral = tuple(c for c in _row_cells(changes.file, place) if c is not None)
    _split(changes, start, end, place.side_cell, lateral)


def _row_cells(file: TeimOrbitFile, place: NumberPlace) -> Iterator[Cell]:
    """The y cell of a hardpoint's row; none of a parameter's."""
    for block in file.blocks:
        for table in block.tables:
            if "y_value" not in table.columns:
                continue
            for row in table.rows:
                if any(cell.start == place.cell.start for cell in row):
                    yield row[table.columns.index("y_value")]


def _split(changes: FileChanges, start: int, end: int, side: Cell, lateral: tuple[Cell, ...]) -> None:
    text = changes.file.text
    if not text.endswith("\n") and end == len(text):
        raise RunError(
            f"{changes.file.path}: its last line has no end, so it cannot be split by side; add one."
        )
    in_row = "=" not in text[text.rfind("\n", 0, side.start) + 1 : side.start]
    width = side.end - side.start if in_row else 0
    words = {s: f"'{s}'".ljust(width) for s in ("left", "right")}
    right = text[start:end]
    edits = [(side.start, side.end, words["right"])]
    edits += [(c.start, c.end, _negated(c.text).rjust(c.end - c.start)) for c in lateral]
    for first, last, new in sorted(edits, reverse=True):
        right = right[: first - start] + new + right[last - start :]
    changes.changes[side.start, side.end] = words["left"]
    changes.changes[end, end] = right


def _negated(number: str) -> str:
    return number[1:] if number.startswith("-") else f"-{number.removeprefix('+')}"


def rewrite_comment(changes: FileChanges, block: OrbitBlock, z: FloatArray) -> bool:
    """The ZP vector in a bushing's comment set to another; whether there was one."""
    lines = changes.file.text.split("\n")
    starts = np.cumsum([0, *(len(line) + 1 for line in lines)])
    for line, comment in block.comments:
        match = VECTOR_COMMENT.match(comment)
        if match and match[1].upper() == "ZP":
            text = lines[line - 1]
            at = text.index(match[2], text.upper().index("ZP"))
            last = text.index(match[4], text.index(match[3], at + len(match[2])) + len(match[3])) + len(
                match[4]
            )
            begin = int(starts[line - 1])
            changes.changes[begin + at, begin + last] = ",  ".join(f"{v:.10f}" for v in z)
            return True
    return False


def tuned_name(path: Path) -> Path:
    """Path for a changed property file beside the original, of a name that is free."""
    for number in range(1, 1000):
        name = path.with_name(f"{path.stem}{TUNED}{number if number > 1 else ''}{path.suffix}")
        if not name.exists():
            return name
    raise RunError(f"{path.parent}: holds a thousand files like {path.stem}{TUNED}; remove some.")


def write_property(path: Path, new: Path, factors: dict[str, FloatArray]) -> None:
    """A property file of a new name whose curves have other forces.

    factors: block (`FX_CURVE`) -> (n,) force of each row over what it was. Rows without force stay.
    """
    file = read_teim_orbit(path, "property file")
    changes = FileChanges(file)
    for name, factor in factors.items():
        for row, ratio in zip(file.table(file.one(name)).rows, factor, strict=True):
            number = file.number(row[1])
            if number != 0.0 and ratio != 1.0:
                changes.set_cell(row[1], number_text(number * float(ratio)))
    content = file.replaced(changes.changes)
    write_whole(new, lambda p: p.write_bytes(content))


def write_xml_spring(path: Path, new: Path, ratio: float) -> None:
    """An XML spring of a new name whose rate, or whose spline's forces, are `ratio` times what they were."""
    text = read_bytes(path, "spring file").decode("utf-8")
    root = parsed_xml(text.encode("utf-8"), path)
    spring = next(e for e in root.iter() if xml_name(e.tag) == "SpringProperties")
    if spring.get("method") == "linear":
        head = re.search(r'(\brate\s*=\s*["\'])([^"\']+)', text)
        assert head is not None
        text = text[: head.start(2)] + number_text(float(head[2]) * ratio) + text[head.end(2) :]
    else:
        spline = re.search(
            r"(<(?:\w+:)?Spline\b[^>]*>\s*(?:<!\[CDATA\[)?)(.*?)((?:\]\]>)?\s*</(?:\w+:)?Spline>)", text, re.S
        )
        assert spline is not None
        numbers = list(re.finditer(r"[^\s,;]+", spline[2]))
        body = spline[2]
        for word in reversed(numbers[1::2]):
            body = body[: word.start()] + number_text(float(word[0]) * ratio) + body[word.end() :]
        text = text[: spline.start(2)] + body + text[spline.end(2) :]
    write_whole(new, lambda p: p.write_bytes(text.encode("utf-8")))


def point_to(changes: FileChanges, place: ElementPlace, new: Path) -> None:
    """The element's PROPERTY_FILE with the last name exchanged."""
    cell = place.element.block.entries["PROPERTY_FILE"]
    cut = max(cell.text.rfind("/"), cell.text.rfind("\\"))
    changes.set_cell(cell, cell.text[: cut + 1] + new.name)
