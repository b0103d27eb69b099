"""MDF of ASAM (`.mf4`, `.mdf`, `.dat`), by asammdf, all channels on the time of the first group."""

from __future__ import annotations

import contextlib
import gc
import io
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.measurement.channels import Heading
from doe_kc.measurement.containers._extra import array_table, extra
from doe_kc.measurement.tables import ArrayTable, read_bytes


def read_mdf_table(path: Path, part: str | None, load_case: str) -> ArrayTable:
    """Channels of a group by its number (`FILE#0`), by default the first with channels, and `time [s]`."""
    read_bytes(path)
    asammdf = extra("asammdf", "mdf", path)
    index = int(part) if part is not None and part.isdigit() else 0
    # what asammdf leaves of a file that it failed to open prints a traceback when it is collected
    with contextlib.redirect_stderr(io.StringIO()):
        signals = _signals(asammdf, path, index)
        gc.collect()
    if isinstance(signals, str):
        raise InputError(
            f"{path}: cannot be read as MDF ({signals}); expected an undamaged file and a group "
            "number after #, export it again."
        )
    numeric = [s for s in signals if s.samples.dtype.kind in "fiu" and s.samples.ndim == 1]
    channels = [(Heading(s.name, s.unit or None), np.asarray(s.samples, dtype=float)) for s in numeric]
    named = {h.name for h, _ in channels}
    if numeric and "time" not in named:
        channels.insert(0, (Heading("time", "s"), np.asarray(numeric[0].timestamps, dtype=float)))
    return array_table(str(path), channels)


def _signals(asammdf: Any, path: Path, group: int) -> list[Any] | str:
    """Signals of a group, or the kind of error that a damaged file ended in, anywhere inside the reader."""
    try:
        with asammdf.MDF(str(path)) as file:
            return list(file.select([(None, group, i) for i in range(len(file.groups[group].channels))]))
    except Exception as error:
        return type(error).__name__
