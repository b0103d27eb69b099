"""A design of experiments: one row an axle, one column a parameter, absolute values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Design:
    """paths: (d,) parameters. values: (n, d) absolute, in each parameter's unit.

    labels: (n,) what a row is ("LLF.x +1 mm"); seed: None for methods without chance.
    """

    method: str
    paths: tuple[str, ...]
    values: FloatArray
    labels: tuple[str, ...]
    seed: int | None = None

    def rows(self) -> Iterator[dict[str, float]]:
        """Each design as path -> value."""
        for row in self.values:
            yield dict(zip(self.paths, map(float, row), strict=True))
