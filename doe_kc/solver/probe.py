"""Where an axle could hide an effect: a cut through a rigid connection, or a force across a free motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Kind = Literal["dislocation", "force pair"]


@dataclass(frozen=True)
class Probe:
    """One degree of freedom of an interface, probed by a value that is zero in the axle.

    dislocation: two parts that hang together rigidly are moved apart; what is seen is the force handed
    across, + along the dislocation, so that a series compliance C makes the dislocation C times it.
    force pair: two parts that move against each other push on each other, + against their displacement;
    what is seen is that displacement, so that a parallel stiffness k makes the force pair k times it.

    interface: the two parts, e.g. `wheel|knuckle`, or a bushing. dof: x, y, z, rx, ry, rz in the
    interface's own axes, mirrored on the right side, or `along`. side: L, R or empty.
    unit: of the probe: mm or deg of a dislocation, N or Nm of a force pair.
    """

    interface: str
    dof: str
    kind: Kind
    side: str
    unit: str

    @property
    def name(self) -> str:
        """Unique in an axle, e.g. `wheel|knuckle rx L dislocation`."""
        return " ".join(part for part in (self.interface, self.dof, self.side, self.kind) if part)

    @property
    def response_unit(self) -> str:
        """Unit of what is seen there."""
        return {"mm": "N", "deg": "Nm", "N": "mm", "Nm": "deg"}[self.unit]
