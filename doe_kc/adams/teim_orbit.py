"""TeimOrbit, the text grammar of ADAMS/Car files: blocks, sub-blocks, tables, keys, comments.

Reads without losing a byte: every cell knows where it stands, so that a writer can replace it alone.
`[NAME]` opens a block (names repeat), `(NAME)` a sub-block, `{columns}` a table; `KEY = value`; strings in
single quotes; `$` and `!` start a comment line.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_bytes

LARGEST_NUMBER = 1e15
"""No length, force or stiffness of a car is larger, in any unit."""
LONGEST_FILE = 64_000_000
"""Bytes; text files of a database have some hundred thousand at most."""
LONGEST_ADAMS_LINE = 1000
"""Characters; ADAMS writes 80 to 200. A longer cell is no name, number or path."""
COMMENT_SIGNS = ("$", "!")
BLOCK_LINE = re.compile(r"\s*\[([^\[\]]*)\]\s*$")
SUB_BLOCK = re.compile(r"\s*\(([^()]*)\)\s*$")
KEY = re.compile(r"[A-Za-z_]\w*")
CELL_WORD = re.compile(r"'([^']*)'|([^\s']+)")
COLUMN_WORD = re.compile(r"<[^>]*>|[^\s<>{}]+")


@dataclass(frozen=True)
class Cell:
    """One value of a file. text: without quotes and the blanks inside them. start, end: of what stands in the
    file, quotes included, in characters. line: counted from 1."""

    text: str
    start: int
    end: int
    line: int
    quoted: bool = False


@dataclass
class CellTable:
    """A table's columns, lower case and without dimension, and its rows. line: of its heading."""

    columns: tuple[str, ...]
    rows: list[tuple[Cell, ...]]
    line: int


@dataclass
class OrbitBlock:
    """A block with all of its sub-blocks. entries: by key in capitals. comments: (line, text after `$`).

    end: where its text ends, in characters. faults: (line, what is wrong), told when the block is used.
    """

    name: str
    line: int
    start: int
    end: int = 0
    entries: dict[str, Cell] = field(default_factory=dict)
    tables: list[CellTable] = field(default_factory=list)
    comments: list[tuple[int, str]] = field(default_factory=list)
    faults: list[tuple[int, str]] = field(default_factory=list)


@dataclass(frozen=True)
class TeimOrbitFile:
    """The whole file. encoding: by which `text` is its bytes again, with `mark` before them."""

    path: Path
    text: str
    encoding: str
    mark: bytes
    blocks: tuple[OrbitBlock, ...]

    def all_of(self, name: str) -> list[OrbitBlock]:
        """Blocks of that name, in order; InputError for one that holds something unreadable."""
        out = [block for block in self.blocks if block.name == name]
        for block in out:
            for line, fault in block.faults:
                raise InputError(f"{self.path}: line {line}: {fault}")
        return out

    def one(self, name: str) -> OrbitBlock:
        """The only block of that name; InputError when there is none, or more than one."""
        blocks = self.all_of(name)
        if not blocks:
            raise InputError(
                f"{self.path}: has no block [{name}]; expected one. Is the file cut off, or another kind?"
            )
        if len(blocks) > 1:
            raise InputError(
                f"{self.path}: line {blocks[1].line}: a second block [{name}]; expected one, remove the "
                "one that does not count."
            )
        return blocks[0]

    def has(self, name: str) -> bool:
        """Whether there is a block of that name."""
        return any(block.name == name for block in self.blocks)

    def cell(self, block: OrbitBlock, key: str) -> Cell:
        """The value of a key; InputError when the block lacks it."""
        if key not in block.entries:
            raise InputError(
                f"{self.path}: line {block.line}: [{block.name}] lacks {key}; expected it there. "
                "Is the file cut off?"
            )
        return block.entries[key]

    def number(self, cell: Cell) -> float:
        """A cell as a number; InputError for text, and for what no length, force or stiffness can be."""
        try:
            value = float(re.sub("[dD]", "e", cell.text) if "_" not in cell.text else "x")
        except ValueError:
            raise InputError(
                f"{self.path}: line {cell.line}: {cell.text[:40]!r} is not a number; correct it."
            ) from None
        if not math.isfinite(value) or abs(value) > LARGEST_NUMBER:
            raise InputError(
                f"{self.path}: line {cell.line}: {cell.text[:40]} is larger than any number of a car; "
                "correct it."
            )
        return value

    def table(self, block: OrbitBlock) -> CellTable:
        """The first table of a block; InputError when there is none, or a row has not one cell a column."""
        if not block.tables:
            raise InputError(
                f"{self.path}: line {block.line}: [{block.name}] has no table; expected a heading in braces "
                "and rows. Is the file cut off?"
            )
        table = block.tables[0]
        for row in table.rows:
            if len(row) != len(table.columns):
                raise InputError(
                    f"{self.path}: line {row[0].line}: {len(row)} cells, expected {len(table.columns)} "
                    f"({', '.join(table.columns)}). Is the file cut off?"
                )
        return table

    def replaced(self, changes: dict[tuple[int, int], str]) -> bytes:
        """The file's bytes with (start, end) -> text changed, nothing else."""
        out, at = [], 0
        for (start, end), text in sorted(changes.items()):
            out += [self.text[at:start], text]
            at = end
        return self.mark + "".join([*out, self.text[at:]]).encode(self.encoding)


def read_teim_orbit(path: Path, what: str) -> TeimOrbitFile:
    """A file of that grammar; InputError when it cannot be read, is binary, or holds no block."""
    content = read_bytes(path, what)
    if len(content) > LONGEST_FILE:
        raise InputError(
            f"{path}: has {len(content) / 1e6:.0f} MB, expected a text file of an ADAMS database."
        )
    text, encoding, mark = _decoded(content, path, what)
    for number, (_, line) in enumerate(_lines(text), start=1):
        if len(line) > LONGEST_ADAMS_LINE and not line.lstrip().startswith(COMMENT_SIGNS):
            raise InputError(
                f"{path}: line {number}: has {len(line)} characters, expected at most "
                f"{LONGEST_ADAMS_LINE}; correct it."
            )
    blocks = tuple(_blocks(text))
    if not blocks:
        raise InputError(
            f"{path}: holds no block such as [MDI_HEADER]; expected a {what} in TeimOrbit text. "
            "Name another file, or save it as ASCII."
        )
    return TeimOrbitFile(path, text, encoding, mark, blocks)


def is_binary(path: Path) -> bool:
    """Whether a file holds zero bytes, as templates that are saved as binary do."""
    content = read_bytes(path, "template")[:4096]
    return b"\0" in content and not content.startswith((b"\xff\xfe", b"\xfe\xff"))


def _decoded(content: bytes, path: Path, what: str) -> tuple[str, str, bytes]:
    for mark, encoding in (
        (b"\xff\xfe", "utf-16-le"),
        (b"\xfe\xff", "utf-16-be"),
        (b"\xef\xbb\xbf", "utf-8"),
    ):
        if content.startswith(mark):
            try:
                return content[len(mark) :].decode(encoding), encoding, mark
            except UnicodeDecodeError:
                raise InputError(f"{path}: is not {encoding} text as its mark says; save it anew.") from None
    if b"\0" in content:
        raise InputError(f"{path}: is binary, expected a {what} in ASCII; save it as ASCII in ADAMS/Car.")
    try:
        return content.decode("utf-8"), "utf-8", b""
    except UnicodeDecodeError:
        return content.decode("latin-1"), "latin-1", b""


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """(start, text) of every line, without its end."""
    at = 0
    for line in text.split("\n"):
        yield at, line.removesuffix("\r")
        at += len(line) + 1


def _blocks(text: str) -> Iterator[OrbitBlock]:
    block: OrbitBlock | None = None
    for number, (start, line) in enumerate(_lines(text), start=1):
        if opened := BLOCK_LINE.match(line):
            if block is not None:
                block.end = start
                yield block
            block = OrbitBlock(opened[1].strip().upper(), number, start)
        elif block is not None:
            _take(block, line, start, number)
    if block is not None:
        block.end = len(text)
        yield block


def _take(block: OrbitBlock, line: str, start: int, number: int) -> None:
    """One line into its block."""
    plain = line.strip()
    if not plain or SUB_BLOCK.match(line):
        return
    if plain[0] in COMMENT_SIGNS:
        block.comments.append((number, plain[1:].strip()))
    elif plain[0] == "{":
        if not plain.endswith("}"):
            block.faults.append((number, "the table's heading lacks its closing brace; add }."))
            return
        words = (w for w in COLUMN_WORD.findall(plain) if not w.startswith("<"))
        block.tables.append(CellTable(tuple(w.lower() for w in words), [], number))
    elif plain[0] != "'" and "=" in plain:
        _take_entry(block, line, start, number)
    elif plain.count("'") % 2:
        block.faults.append((number, "a quote is not closed; close it. Is the file cut off?"))
    elif block.tables:
        _take_row(block, line, start, number)
    else:
        block.faults.append(
            (number, f"{plain[:40]!r} is neither key, table nor comment; mend the line. Is the file cut off?")
        )


def _take_entry(block: OrbitBlock, line: str, start: int, number: int) -> None:
    head, _, value = line.partition("=")
    key = head.partition("<")[0].strip().upper()
    cells = list(_cells(value, start + len(head) + 1, number))
    if not KEY.fullmatch(key):
        block.faults.append((number, f"{key[:40]!r} is no key; expected letters, digits and _."))
    elif key in block.entries:
        block.faults.append((number, f"{key} is there twice in [{block.name}]; remove one."))
    else:
        block.entries[key] = cells[0] if len(cells) == 1 else _whole(value, start + len(head) + 1, number)


def _whole(value: str, start: int, line: int) -> Cell:
    """A value of no word, or of several."""
    return Cell(value.strip(), start, start + len(value), line)


def _take_row(block: OrbitBlock, line: str, start: int, number: int) -> None:
    table, cells = block.tables[-1], tuple(_cells(line, start, number))
    if len(cells) == 1 and cells[0].quoted and len(table.columns) > 1:
        return  # the description of a parameter, on a line of its own
    table.rows.append(cells)


def _cells(text: str, start: int, line: int) -> Iterator[Cell]:
    for match in CELL_WORD.finditer(text):
        quoted = match[1] is not None
        word = match[1].strip() if quoted else match[2]
        if not quoted and word[0] in "$!":
            return
        yield Cell(word, start + match.start(), start + match.end(), line, quoted)
