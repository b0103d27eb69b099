"""The shipped example study."""

from __future__ import annotations

import shutil
from pathlib import Path

from doe_kc.ground.errors import InputError, RunError

EXAMPLE_NAME = "front_axle"


def example_folder() -> Path:
    """Where the example lies: in the installed package, or in the source tree beside it."""
    package = Path(__file__).parent
    for folder in (package / "_examples" / EXAMPLE_NAME, package.parent / "examples" / EXAMPLE_NAME):
        if (folder / "study.toml").is_file():
            return folder
    raise RunError("the example study is not part of this installation; reinstall doe-kc.")


def _reason(error: OSError) -> str:
    """The first cause, when shutil has collected one a file."""
    causes = error.args[0] if isinstance(error, shutil.Error) else None
    return str(causes[0][2] if causes else error.strerror or error)


def copy_example(target: Path) -> list[Path]:
    """Copy the example to a new or empty folder; returns the files written."""
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise InputError(f"{target}: exists and is not an empty folder; name another one.")
    try:
        shutil.copytree(
            example_folder(),
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
