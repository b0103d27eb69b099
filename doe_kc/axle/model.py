"""The axle in memory: a topology and a flat table of numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from doe_kc.axle.topology import Topology
from doe_kc.ground.errors import InputError
from doe_kc.load_cases import LoadCase
from doe_kc.load_cases.roll import ROLL_TECHNIQUES

FORCE_AXES = ("Fx", "Fy", "Fz")

NM_PER_DEG = 1000.0 * 180.0 / math.pi
"""1 Nm/deg in N mm/rad."""

HARDPOINTS = {
    "LLF": "Lower link front",
    "LLR": "Lower link rear",
    "LWB": "Lower ball joint",
    "LWD": "Lower damper",
    "LWS": "Lower spring",
    "UPB": "Upper ball joint (top mount)",
    "UPS": "Upper spring",
    "UPBBI": "Upper ball joint bushing inclination",
    "RIB": "Tie rod inner ball joint",
    "ROB": "Tie rod outer ball joint",
    "SAH": "Steer arm",
    "SFF": "Sub-frame front",
    "SFR": "Sub-frame rear",
    "WLC": "Wheel centre",
}
"""The 14 hardpoints of the thesis's Table 1."""

EXTRA_HARDPOINTS = {"ARB": "Anti-roll bar drop link, upper end", "CLAMP": "Strut clamp"}

BUSHINGS = {
    "llf": "Lower link front",
    "llr": "Lower link rear",
    "sff": "Sub-frame front",
    "sfr": "Sub-frame rear",
    "upb": "Upper ball joint (top mount)",
}
BUSHING_AXES = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")
STRUT_BENDING, STRUT_TORSION = 8000.0, 30000.0
"""Nm/deg at the strut clamp for `strut.flexibility` 1; the stiffness is this over the flexibility."""


@dataclass(frozen=True)
class Axle:
    """values: internal name -> number; `@L`/`@R` marks a side's own value, the right side's given as its
        mirror image, so that a symmetric axle has equal pairs. Units: mm, N, N/mm, Nm/deg, deg, factors.
    topology: which bodies and laws there are. follow: hardpoint -> hardpoint that it moves with.
    effects: id -> options of the optional effects that are in. labels: of points and elements by name.
    lines: pairs of hardpoints by the part that they draw; empty: drawn from the connections.
    """

    name: str
    topology: Topology
    values: Mapping[str, float]
    follow: Mapping[str, str]
    load_cases: Mapping[str, LoadCase]
    effects: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)
    lines: Mapping[str, tuple[tuple[str, str], ...]] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"Axle({self.name!r}, effects: {', '.join(self.effects) or 'none'})"

    def changed(self, values: Mapping[str, float]) -> Axle:
        """Copy with some internal values replaced."""
        return replace(self, values={**self.values, **values})

    def conditioned(self, loops: int) -> Axle:
        """Copy whose load cases drive so many loops before the one that counts."""
        cases = {ident: replace(case, conditioning=loops) for ident, case in self.load_cases.items()}
        return replace(self, load_cases=cases)

    @property
    def conditioning(self) -> int:
        """Most loops that a load case drives before the one that counts."""
        return max((case.conditioning for case in self.load_cases.values()), default=0)

    @property
    def half_track(self) -> float:
        """|y| of the left design wheel centre, mm."""
        return abs(self.values["WLC.y@L"])

    @property
    def rack_mm_per_rev(self) -> float:
        """Rack travel per steering-wheel turn, mm; 0 without a rack."""
        return self.values.get("steering.rack_mm_per_rev", 0.0)


CLAMP_HEIGHT = 0.25
"""Share of the way from the wheel centre's height up to that of the strut's lower end."""


def strut_clamp(points: Mapping[str, Sequence[float]], line: tuple[str, str]) -> list[float]:
    """(3,) clamp of a strut in mm, of an axle file that does not give it, from its hardpoints.

    line: lower and upper end of the strut. On that line, produced downwards, a quarter of the way from the
    height of the wheel centre WLC up to the lower end: the two bolts of the knuckle sit just above the wheel
    centre. The lower end when the strut does not rise.
    """
    lower, upper = (points[name] for name in line)
    rise = upper[2] - lower[2]
    if rise <= 0.0:
        return [float(v) for v in lower]
    down = (1.0 - CLAMP_HEIGHT) * (points["WLC"][2] - lower[2]) / rise
    return [float(low + down * (high - low)) for low, high in zip(lower, upper, strict=True)]


def both(name: str, value: float) -> dict[str, float]:
    """The same value on both sides."""
    return {f"{name}@L": value, f"{name}@R": value}


def with_roll(axle: Axle, technique: str | None, *, source: str = "roll") -> Axle:
    """The axle with that roll technique, None: as it is; InputError for an unknown one."""
    if technique is None:
        return axle
    if technique not in ROLL_TECHNIQUES:
        raise InputError(f"{source} {technique}: expected {' or '.join(ROLL_TECHNIQUES)}.")
    return replace(axle, load_cases={**axle.load_cases, "roll": ROLL_TECHNIQUES[technique]})
