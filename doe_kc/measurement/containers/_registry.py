"""Which reader a file's suffix asks for."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import cast

from doe_kc.ground.errors import InputError
from doe_kc.measurement.tables import ChannelTable

TableReader = Callable[[Path, str | None, str], ChannelTable]
"""File, part of it (sheet, group) or None, load case -> table."""

CONTAINERS: Mapping[str, str] = {
    ".xlsx": "excel:read_sheet_table",
    ".xlsm": "excel:read_sheet_table",
    ".mat": "matlab:read_mat_table",
    ".tdms": "tdms:read_tdms_table",
    ".mf4": "mdf:read_mdf_table",
    ".mdf": "mdf:read_mdf_table",
    ".rsp": "rpc:read_rpc_table",
    ".tim": "rpc:read_rpc_table",
    ".rpc": "rpc:read_rpc_table",
}
"""Suffix -> module and function of this folder; text for all others. Imported when a file asks for it."""
TEXT_READER = "text:read_text_table"
REFUSED: Mapping[str, str] = {
    ".xls": "is in the old Excel format .xls; expected .xlsx or .csv, save it as such",
}


READABLE = frozenset((".csv", ".txt", ".tab", ".asc", *CONTAINERS))
"""Suffixes of files that are looked at in a folder."""


def table_parts(path: Path) -> list[str | None]:
    """Parts of a file that each hold a table: sheets, groups; [None] where it holds one."""
    place = CONTAINERS.get(path.suffix.lower(), TEXT_READER)
    module = importlib.import_module(f"{__package__}.{place.split(':')[0]}")
    return list(getattr(module, "parts", lambda _path: [None])(path))


def read_table(path: Path, part: str | None, load_case: str) -> ChannelTable:
    """The table of channels in a file.

    part: sheet of a workbook, group of a container; None = the only one or that of the load case.
    Raises InputError for a file that cannot be read as what its suffix says.
    """
    suffix = path.suffix.lower()
    if suffix in REFUSED:
        raise InputError(f"{path}: {REFUSED[suffix]}.")
    if part is not None and suffix not in CONTAINERS:
        raise InputError(
            f'{path}: a sheet ("#{part}") is named of a file that is no .xlsx; '
            "remove the part from # or name a workbook."
        )
    return _reader(CONTAINERS.get(suffix, TEXT_READER))(path, part, load_case)


def _reader(place: str) -> TableReader:
    module, name = place.split(":")
    return cast(TableReader, getattr(importlib.import_module(f"{__package__}.{module}"), name))
