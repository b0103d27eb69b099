"""Writing results: whole files or none, and one sentence when a disk is full or read-only."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from doe_kc.ground.errors import RunError

if TYPE_CHECKING:
    import pandas as pd


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
