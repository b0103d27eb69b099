"""MATLAB `.mat`: one struct a channel with data and offset, arrays by name, or a struct of them.

Up to version 7 by scipy, version 7.3 (HDF5) by h5py.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.channels import Heading
from doe_kc.measurement.containers._extra import array_table, extra
from doe_kc.measurement.tables import ArrayTable, read_bytes

DATA_FIELDS = ("data", "Data", "values", "Values", "value", "y")
OFFSET_FIELDS = ("offset", "setup_offset", "setupoffset", "SetupOffset", "Offset")
UNIT_FIELDS = ("unit", "units", "Unit", "Units")
_HDF5 = b"MATLAB 7.3"


def read_mat_table(path: Path, part: str | None, load_case: str) -> ArrayTable:
    """Channels of all arrays of the file's commonest length; a struct's offset is subtracted.

    part: struct that holds them, None = the file. Raises InputError for a file that is none, or holds none.
    """
    data = read_bytes(path)
    content = _hdf5(path) if data.startswith(_HDF5) else _plain(path, data)
    if part is not None:
        if part not in content or not isinstance(content[part], Mapping):
            raise InputError(
                f'{path}: holds no struct "{part}"; its names are {", ".join(content)}; correct it.'
            )
        content = content[part]
    return array_table(f"{path}#{part}" if part else str(path), list(_channels(content)))


def _plain(path: Path, data: bytes) -> Mapping[str, Any]:
    from scipy.io import loadmat

    try:
        content = loadmat(io.BytesIO(data), simplify_cells=True)  # type: ignore[arg-type]
    except Exception as error:  # a damaged file fails anywhere inside scipy
        raise InputError(
            f"{path}: cannot be read as a MATLAB file ({type(error).__name__}); expected an undamaged .mat, "
            "save it again."
        ) from None
    return {k: v for k, v in content.items() if not k.startswith("__")}


def _hdf5(path: Path) -> Mapping[str, Any]:
    h5py = extra("h5py", "hdf5", path)
    try:
        with h5py.File(path, "r") as file:
            return {k: _node(v, h5py) for k, v in file.items() if not k.startswith("#")}
    except (OSError, RuntimeError, KeyError) as error:
        raise InputError(
            f"{path}: cannot be read as a MATLAB 7.3 file ({type(error).__name__}); expected an "
            f"undamaged .mat, "
            "save it again."
        ) from None


def _node(node: Any, h5py: Any) -> Any:
    if isinstance(node, h5py.Group):
        return {k: _node(v, h5py) for k, v in node.items()}
    values = np.asarray(node)
    if node.attrs.get("MATLAB_class") == b"char":
        return "".join(map(chr, values.ravel()))
    return values.squeeze()


def _channels(content: Mapping[str, Any]) -> Iterator[tuple[Heading, FloatArray]]:
    """Named arrays and structs, those inside other structs too."""
    for name, value in content.items():
        if isinstance(value, Mapping):
            data = next((value[f] for f in DATA_FIELDS if f in value), None)
            if data is None:
                yield from _channels(value)
                continue
            offset = next((value[f] for f in OFFSET_FIELDS if f in value), 0.0)
            unit = next((value[f] for f in UNIT_FIELDS if f in value), None)
            array = _numbers(data)
            if array is not None and np.ndim(offset) == 0:
                yield Heading(name, unit if isinstance(unit, str) and unit else None), array - float(offset)
        else:
            array = _numbers(value)
            if array is not None:
                yield Heading(name, None), array


def _numbers(value: Any) -> FloatArray | None:
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" or array.ndim != 1 or array.size < 2:
        return None
    return array.astype(float)
