"""What takes part: a search, what it sees, how many evaluations it may use."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from optimizers.counting import CountingSolver

Sees = Literal["outputs and slopes", "outputs", "rating"]
Search = Callable[[CountingSolver, int], str]


@dataclass(frozen=True)
class Peer:
    """search: given the solver and a seed, runs until it stops or `BudgetSpent`; returns why it stopped.

    needs: package that must be installed, with its name in a registry if that differs. seeds: how many are
    run. seconds: wall time of one run, for peers too slow to use their budget.
    """

    id: str
    label: str
    sees: Sees
    search: Search
    budget: int
    ours: bool = False
    needs: str = ""
    package: str = ""
    seeds: int = 5
    seconds: float = float("inf")

    @property
    def installed(self) -> bool:
        """Whether its package is there."""
        return not self.needs or importlib.util.find_spec(self.needs) is not None
