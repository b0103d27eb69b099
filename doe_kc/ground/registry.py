"""Registries that fill themselves: a module of a package registers its unit when it is imported."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator, Mapping
from types import ModuleType
from typing import Generic, TypeVar

T = TypeVar("T")


def import_members(package: ModuleType) -> None:
    """Import every public module of `package`, in alphabetical order, so that each registers its unit."""
    for info in sorted(pkgutil.iter_modules(package.__path__), key=lambda i: i.name):
        if not info.name.startswith("_"):
            importlib.import_module(f"{package.__name__}.{info.name}")


class Members(Mapping[str, T], Generic[T]):
    """Id -> unit of a package whose modules are named as the unit that each registers.

    A module is imported when its unit is asked for, the names are known without.
    """

    def __init__(self, package: str) -> None:
        """package: dotted name."""
        self._package = package
        self._units: dict[str, T] = {}

    def add(self, name: str, unit: T) -> None:
        """Register a unit; ValueError when the id is taken."""
        if name in self._units:
            raise ValueError(f"{name} of {self._package} is registered twice")
        self._units[name] = unit

    def __getitem__(self, name: str) -> T:
        if name not in self._units and name in self._names():
            importlib.import_module(f"{self._package}.{name}")
        return self._units[name]

    def __contains__(self, name: object) -> bool:
        return name in self._units or name in self._names()

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def _names(self) -> list[str]:
        path = importlib.import_module(self._package).__path__
        return sorted(info.name for info in pkgutil.iter_modules(path) if not info.name.startswith("_"))
