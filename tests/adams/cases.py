"""The two databases of the examples, copied and changed."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from doe_kc.adams.import_axle import AdamsSource

ADAMS = Path(__file__).parents[2] / "examples" / "adams"
MCPHERSON_DATABASE, WISHBONE_DATABASE = ADAMS / "mcpherson.cdb", ADAMS / "double_wishbone.cdb"
RACK_OF_MCPHERSON = (("steering.rack_mm_per_rev", 52.0),)
RACK_OF_WISHBONE = (("steering.rack_mm_per_rev", 54.0),)


def mcpherson_source(path: Path = MCPHERSON_DATABASE, **more: object) -> AdamsSource:
    return AdamsSource((path,), values=RACK_OF_MCPHERSON, **more)  # type: ignore[arg-type]


def wishbone_source(path: Path = WISHBONE_DATABASE, **more: object) -> AdamsSource:
    return AdamsSource((path,), values=RACK_OF_WISHBONE, **more)  # type: ignore[arg-type]


def changed(database: Path, folder: Path, file: str, change: Callable[[str], str]) -> Path:
    """A copy of a database below `folder` with one file's text changed."""
    copy = folder / database.name
    if not copy.exists():
        shutil.copytree(database, copy)
    path = copy / file
    text = path.read_text(encoding="utf-8")
    after = change(text)
    assert after != text, f"{file}: nothing was changed"
    path.write_text(after, encoding="utf-8")
    return copy


def replaced(old: str, new: str) -> Callable[[str], str]:
    return lambda text: text.replace(old, new, 1)
