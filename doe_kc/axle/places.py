"""Where on an axle effects can sit, by name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from doe_kc.axle.model import Axle
from doe_kc.axle.structure import Structure


@dataclass(frozen=True)
class Places:
    """What effects of an axle can be on. structure: of its type.

    bushings: of either side; single_bushings: of which there is one. balls: ball joints with their side:
    `TLO_L`, upper case, but that named BALL_JOINT, which has an effect of its own.
    """

    structure: Structure
    bushings: tuple[str, ...]
    single_bushings: tuple[str, ...] = ()
    balls: tuple[str, ...] = ()

    @property
    def rack(self) -> bool:
        """Whether the axle is steered, so that it has the load case steer."""
        return self.structure.rack is not None

    @property
    def all_bushings(self) -> tuple[str, ...]:
        """Those of either side and the single ones."""
        return (*self.bushings, *self.single_bushings)

    @property
    def bushing_sides(self) -> dict[str, tuple[str, str]]:
        """`LLR_R` -> (`llr`, `R`) of every bushing that has a twin on the other side."""
        return {f"{name.upper()}_{side}": (name, side) for name in self.bushings for side in "LR"}

    def sides(self, bushing: str) -> tuple[str, ...]:
        """Sides of a bushing: L and R, or none."""
        return ("",) if bushing in self.single_bushings else ("L", "R")


BALL_JOINT = "ball_joint"
"""Name of the ball joint below a strut."""


def places_of(axle: Axle) -> Places:
    """The places of an axle."""
    return structure_places(axle.topology.structure)


@lru_cache
def structure_places(structure: Structure) -> Places:
    """The places of every axle of a type."""
    return Places(
        structure,
        tuple(bush.name for bush in structure.bushings if not bush.single),
        tuple(bush.name for bush in structure.bushings if bush.single),
        ball_names(structure),
    )


def ball_names(structure: Structure, among: Sequence[str] | None = None) -> tuple[str, ...]:
    """`TLO_L` of every ball joint of a side, `PHA` of a single one."""
    balls = [ball for ball in structure.balls if ball.name != BALL_JOINT]
    chosen = [ball for ball in balls if among is None or ball.name in among]
    return tuple(
        f"{ball.name}_{side}".upper() if side else ball.name.upper()
        for ball in chosen
        for side in structure.sides(single=ball.single)
    )


def internal_ball(name: str) -> str:
    """`TLO_L` -> `tlo@L`, `PHA` -> `pha`."""
    head, _, side = name.rpartition("_")
    return f"{head.lower()}@{side}" if head and side in ("L", "R") else name.lower()
