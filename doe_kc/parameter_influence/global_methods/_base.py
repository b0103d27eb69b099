"""The contract of a method: points of the unit cube, and indices of what the model says there."""

from __future__ import annotations

import importlib
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.registry import Members
from doe_kc.ground.typing import FloatArray

RESAMPLES = 100
"""Bootstrap samples behind every confidence interval (the default of SALib)."""


@dataclass(frozen=True)
class GlobalIndex:
    """values: (d, k) of d variables for k outputs. error: (d, k) half width of the 95 % confidence interval,
    by bootstrap; nan where the method gives none."""

    id: str
    label: str
    values: FloatArray
    error: FloatArray


class GlobalMethod(ABC):
    """main: id of the index that is drawn and compared. distributed: whether points are cumulative
    probabilities of the variables, or places between their bounds."""

    id: ClassVar[str]
    label: ClassVar[str]
    main: ClassVar[str]
    distributed: ClassVar[bool] = True

    @abstractmethod
    def block(self, d: int) -> int:
        """Points that belong together: if one has no result, none of them counts."""

    @abstractmethod
    def points(self, d: int, size: int, seed: int) -> FloatArray:
        """(blocks times block, d) points in [0, 1]; size: trajectories, base samples or designs."""

    @abstractmethod
    def indices(
        self, points: FloatArray, values: FloatArray, plane: FloatArray, seed: int
    ) -> tuple[GlobalIndex, ...]:
        """Of whole blocks: points (n, d), values (n, k) that are finite and not constant; plane (n, k): what
        the slopes at the start say there."""


GLOBAL_METHODS: Members[GlobalMethod] = Members(__name__.rpartition(".")[0])
"""By id."""


def global_method(cls: type[GlobalMethod]) -> type[GlobalMethod]:
    """Class decorator: register a method."""
    GLOBAL_METHODS.add(cls.id, cls())
    return cls


def find_global_method(method: str, source: str) -> GlobalMethod:
    """The method of an id; InputError naming `source` for an unknown one, or without the extra that it
    needs."""
    if method not in GLOBAL_METHODS:
        raise InputError(
            f"{source}: {method!r} is no method of global sensitivity; known are {', '.join(GLOBAL_METHODS)}."
            f"{nearest(method, GLOBAL_METHODS)}"
        )
    return GLOBAL_METHODS[method]


def salib(module: str, method: str) -> Any:
    """A module of SALib; InputError without it."""
    try:
        return importlib.import_module(f"SALib.{module}")
    except ImportError:
        raise InputError(
            f"global sensitivity by {method}: needs the extra `sensitivity`; install doe-kc[sensitivity], or "
            "leave the method out."
        ) from None


def problem(d: int) -> dict[str, Any]:
    """Of d variables in the unit cube, as SALib asks for it; a new one every time, as SALib adds to it."""
    return {"num_vars": d, "names": [f"x{i}" for i in range(d)], "bounds": [[0.0, 1.0]] * d}


def stacked(columns: list[Any], key: str) -> FloatArray:
    """(d, k) of one entry of the results of k outputs."""
    return np.column_stack([np.asarray(c[key], dtype=float) for c in columns])
