"""Writing results: whole files or none, and one sentence when a disk is full or read-only."""

from __future__ import annotations

import csv
import io
import json
import math
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from doe_kc.ground.errors import RunError

if TYPE_CHECKING:
    import pandas as pd

Columns = Mapping[str, Sequence[Any] | NDArray[Any]]
"""A table: its columns by their heads, all of one length."""


def make_folder(path: Path) -> Path:
    """The folder, made if need be; RunError when that is not possible."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        raise _unwritable(path, "folder cannot be made", error) from None
    return path


def write_whole(path: Path, write: Callable[[Path], object]) -> Path:
    """Let `write` fill a file beside `path`, then put it in place: never a half-written result.

    Links are followed; a pipe or device such as /dev/stdout is written to, not replaced.
    """
    make_folder(path.parent)
    special = path.exists() and not path.is_file() and not path.is_dir()
    place = Path(os.path.realpath(path))
    beside = path if special else place.with_name(f".{place.name}.{os.getpid()}.tmp")
    try:
        write(beside)
        if not special:
            beside.replace(place)
    except OSError as error:
        raise _unwritable(path, "cannot be written", error) from None
    finally:
        if not special:
            beside.unlink(missing_ok=True)
    return path


def write_csv(path: Path, frame: pd.DataFrame) -> Path:
    """CSV with ten significant digits."""
    return write_whole(path, lambda p: frame.to_csv(p, index=False, float_format="%.10g"))


def write_columns(path: Path, columns: Columns) -> Path:
    """The same CSV as `write_csv` makes of a data frame with these columns, without importing pandas, which
    takes as long as drawing five pictures."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*map(_cells, columns.values()), strict=True))
    return write_whole(path, lambda p: p.write_text(text.getvalue(), encoding="utf-8"))


def _cells(values: Sequence[Any] | NDArray[Any]) -> list[str]:
    """Texts of a column: in one of numbers alone ten digits, beside texts all that they have."""
    cells = values.tolist() if isinstance(values, np.ndarray) else list(values)
    plain = [v.item() if isinstance(v, np.generic) else v for v in cells]
    if any(isinstance(v, float) for v in plain) and all(_is_number(v) for v in plain):
        return ["" if v is None or math.isnan(v) else f"{v:.10g}" for v in plain]
    return ["" if v is None or v != v else str(v) for v in plain]


def _is_number(value: Any) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


def write_json(path: Path, document: dict[str, Any]) -> Path:
    """JSON; numbers that are not finite become null."""
    text = json.dumps(_finite(document), indent=2, allow_nan=False, ensure_ascii=False)
    return write_whole(path, lambda p: p.write_text(text + "\n", encoding="utf-8"))


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(k): _finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(v) for v in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _unwritable(path: Path, what: str, error: Exception) -> RunError:
    reason = getattr(error, "strerror", None) or error
    return RunError(
        f"{path}: {what} ({reason}); free disk space, close the file in other programs, "
        "or choose a writable folder with --out."
    )
