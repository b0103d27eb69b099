"""The contract of an element, and helpers that several elements share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, Literal

import casadi as ca

from doe_kc.axle.structure import of_side
from doe_kc.solver.builder import Builder

DEG = 180 / ca.pi

Stage = Literal["body", "force", "output"]
STAGES: tuple[Stage, ...] = ("body", "force", "output")


class Element(ABC):
    """Stateless: `assemble` adds bodies, forces or outputs of one kind to the builder."""

    id: ClassVar[str]
    stage: ClassVar[Stage]
    rank: ClassVar[int] = 50
    """Order inside the stage: a body is assembled after the bodies it hangs on."""

    @abstractmethod
    def assemble(self, b: Builder) -> None:
        """Add this element to `b`."""


ELEMENTS: list[Element] = []


def element(cls: type[Element]) -> type[Element]:
    """Class decorator: register an element, kept in the order of assembly."""
    ELEMENTS.append(cls())
    ELEMENTS.sort(key=lambda e: (STAGES.index(e.stage), e.rank, e.id))
    return cls


def mirror(side: str) -> int:
    """-1 for the right side, +1 for the left and for what is of no side."""
    return -1 if side == "R" else 1


def reflection(side: str) -> ca.SX:
    """Matrix that takes left-side vectors to this side."""
    return ca.diag(ca.SX([1, mirror(side), 1]))


def hardpoint(b: Builder, name: str, side: str) -> ca.SX:
    """Design position (3,) of a hardpoint in the chassis frame, mm; side empty: of a single point."""
    key = of_side(name, side)
    if key not in b.points:
        x, y, z = (b.parameter(of_side(f"{name}.{axis}", side)) for axis in "xyz")
        b.points[key] = b.constant(ca.vertcat(x, mirror(side) * y, z))
    return b.points[key]
