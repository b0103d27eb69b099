"""TDMS of National Instruments, by npTDMS: one group a table."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.measurement.channels import Heading
from doe_kc.measurement.containers._extra import array_table, extra
from doe_kc.measurement.tables import ArrayTable, read_bytes


def read_tdms_table(path: Path, part: str | None, load_case: str) -> ArrayTable:
    """Channels of a group: the named one, the only one, or that of the load case; unit by `unit_string`."""
    read_bytes(path)
    nptdms = extra("nptdms", "tdms", path)
    try:
        groups = {g.name: g.channels() for g in nptdms.TdmsFile.read(str(path)).groups()}
    except Exception as error:  # a damaged file fails anywhere inside the reader
        raise InputError(
            f"{path}: cannot be read as TDMS ({type(error).__name__}); expected an undamaged file, "
            f"export it again."
        ) from None
    wanted = part or (next(iter(groups)) if len(groups) == 1 else load_case)
    if wanted not in groups:
        raise InputError(
            f'{path}: has no group "{wanted}", its groups are {", ".join(groups)}; write FILE#GROUP.'
        )
    channels = [
        (Heading(c.name, c.properties.get("unit_string") or None), np.asarray(c[:], dtype=float))
        for c in groups[wanted]
        if np.asarray(c[:1]).dtype.kind in "fiu"
    ]
    return array_table(f"{path}#{wanted}", channels)
