"""One module a command; each registers itself with the application."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Sequence


def register(arguments: Sequence[str]) -> None:
    """Import the command that `arguments` begin with, or all of them when it is none (help, a typo).

    The commands bring solver, tables and pictures along; importing all of them takes seconds.
    """
    names = sorted(info.name for info in pkgutil.iter_modules(__path__))
    chosen = [name for name in names if name in arguments[:1]] or names
    for name in chosen:
        importlib.import_module(f"{__name__}.{name}")
