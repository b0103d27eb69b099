"""The shipped example studies, one an axle type."""

from __future__ import annotations

import shutil
from pathlib import Path

from doe_kc.axle_types import BUILT_IN, DEFAULT_TYPE
from doe_kc.ground.errors import InputError, RunError, nearest

FOLDER_OF_TYPE = {DEFAULT_TYPE: "front_axle"}
"""Axle type -> folder of its example, where that is not the type's name."""
EXAMPLE_TYPES = BUILT_IN
"""Axle types that have an example: all that the package describes."""


def example_folder(axle_type: str = DEFAULT_TYPE) -> Path:
    """Where a type's example lies: in the installed package, or in the source tree beside it.

    InputError for a type that has none, RunError where the examples are not installed.
    """
    if axle_type not in EXAMPLE_TYPES:
        raise InputError(
            f"{axle_type!r} is no axle type with an example; expected one of {', '.join(EXAMPLE_TYPES)}."
            f"{nearest(axle_type, EXAMPLE_TYPES)}"
        )
    package, name = Path(__file__).parent, FOLDER_OF_TYPE.get(axle_type, axle_type)
    for folder in (package / "_examples" / name, package.parent / "examples" / name):
        if (folder / "study.toml").is_file():
            return folder
    raise RunError("the example study is not part of this installation; reinstall doe-kc.")


def _reason(error: OSError) -> str:
    """The first cause, when shutil has collected one a file."""
    causes = error.args[0] if isinstance(error, shutil.Error) else None
    return str(causes[0][2] if causes else error.strerror or error)


def copy_example(target: Path, axle_type: str = DEFAULT_TYPE) -> list[Path]:
    """Copy a type's example to a new or empty folder; returns the files written."""
    source = example_folder(axle_type)
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise InputError(f"{target}: exists and is not an empty folder; name another one.")
    try:
        shutil.copytree(
            source,
            target,
            dirs_exist_ok=True,
            ignore=shutil.ignore_patterns("out", "__pycache__"),
        )
    except OSError as error:
        raise RunError(
            f"{target}: the example cannot be written ({_reason(error)}); free disk space or name a writable "
            "folder."
        ) from None
    return sorted(p for p in target.rglob("*") if p.is_file())
