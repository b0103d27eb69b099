"""What a correlation method is: asked for candidates, told what the true solver says of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from doe_kc.correlation.options import Gradients
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.registry import Members

if TYPE_CHECKING:
    from doe_kc.correlation.problem import Candidate, Evaluated, Problem


@dataclass(frozen=True)
class MethodSettings:
    """What every method is given beside the problem; `CorrelationOptions` in numbers."""

    seed: int
    budget: int
    batch: int = 1
    first: int | None = None
    gradients: Gradients = "auto"


class Method(ABC):
    """One search. The first `tell` holds the baseline (index 0) and designs known from before (< 0)."""

    id: ClassVar[str]
    label: ClassVar[str]
    needs_exact: ClassVar[bool] = False

    @abstractmethod
    def __init__(self, problem: Problem, settings: MethodSettings) -> None: ...

    @property
    @abstractmethod
    def stopped(self) -> str:
        """Why the search is over; empty while it goes on."""

    @abstractmethod
    def ask(self) -> Sequence[Candidate]:
        """The next candidates, at least one unless `stopped`."""

    @abstractmethod
    def tell(self, evaluated: Sequence[Evaluated]) -> None:
        """Answers to the last candidates, in their order; failures among them."""

    def best(self, history: Sequence[Evaluated]) -> int:
        """Place of the design to hand over, see `best_design`."""
        return best_design(history)


def best_design(history: Sequence[Evaluated]) -> int:
    """Place of the best merit, the earlier one of equals, among the designs that meet every constraint and
    limit; where none does, among those that harm nothing, else among all."""
    return max(
        range(len(history)),
        key=lambda i: (history[i].feasible, history[i].harmless, history[i].merit, -i),
    )


METHODS: Members[type[Method]] = Members(__package__)


def register(kind: type[Method]) -> type[Method]:
    """Register a method; ValueError when the id is taken."""
    METHODS.add(kind.id, kind)
    return kind


def method_class(name: str, *, source: str) -> type[Method]:
    """The method of that id; InputError naming `source` when there is none."""
    check_method(name, source=source)
    return METHODS[name]


def check_method(name: str, *, source: str) -> None:
    """InputError naming `source` when there is no method of that id; imports none."""
    if name not in METHODS:
        raise InputError(
            f"{source}: {name!r} is no correlation method; known are {', '.join(METHODS)}."
            f"{nearest(name, METHODS)}"
        )
