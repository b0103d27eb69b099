"""Where on an axle effects can sit, by name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from doe_kc.axle.model import BUSHINGS, Axle
from doe_kc.axle.structure import Structure


@dataclass(frozen=True)
class Places:
    """What effects of an axle can be on. structure: of its type, None: the McPherson axle's.

    bushings: of either side; single_bushings: of which there is one. balls: ball joints with their side:
    `TLO_L`, upper case.
    """

    structure: Structure | None
    bushings: tuple[str, ...]
    single_bushings: tuple[str, ...] = ()
    balls: tuple[str, ...] = ()

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


MCPHERSON_PLACES = Places(None, tuple(BUSHINGS))


def places_of(axle: Axle) -> Places:
    """The places of an axle."""
    structure = axle.topology.structure
    if structure is None:
        return MCPHERSON_PLACES
    return Places(
        structure,
        tuple(bush.name for bush in structure.bushings if not bush.single),
        tuple(bush.name for bush in structure.bushings if bush.single),
        ball_names(structure),
    )


def ball_names(structure: Structure, among: Sequence[str] | None = None) -> tuple[str, ...]:
    """`TLO_L` of every ball joint of a side, `PHA` of a single one."""
    chosen = [ball for ball in structure.balls if among is None or ball.name in among]
    return tuple(
        f"{ball.name}_{side}".upper() if side else ball.name.upper()
        for ball in chosen
        for side in structure.sides(single=ball.single)
    )


def internal_ball(name: str) -> str:
    """`TLO_L` -> `tlo@L`, `PHA` -> `pha`."""
    head, _, side = name.rpartition("_")
    return f"{head.lower()}@{side}" if head and side in ("L", "R") else name.lower()
