"""Registries that fill themselves: every module of a package registers its unit when imported."""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType


def import_members(package: ModuleType) -> None:
    """Import every public module of `package`, in alphabetical order, so that each registers its unit."""
    for info in sorted(pkgutil.iter_modules(package.__path__), key=lambda i: i.name):
        if not info.name.startswith("_"):
            importlib.import_module(f"{package.__name__}.{info.name}")
