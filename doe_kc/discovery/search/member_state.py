"""What a search knows of the members of a set at rest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from doe_kc.correlation.likelihood import Likelihood


@dataclass(frozen=True)
class TriedRemoval:
    """A member's removal when it was last tried."""

    carried: float
    """ln likelihood that its sizes carried then, to second order (Wald); 0 without any."""
    lost: float
    """ln evidence that was lost; at least so much where the fit without it was given up."""


@dataclass(frozen=True)
class MemberState:
    """By a member's name."""

    shares: Mapping[str, float] = field(default_factory=dict)
    """Standard deviation of its law's discrepancy, relative to what it makes of a curve."""
    without_own: Mapping[str, Likelihood] = field(default_factory=dict)
    """Of a member with such a discrepancy the errors of the records without its own."""
    removals: Mapping[str, TriedRemoval] = field(default_factory=dict)
    """Of a member that was tried without, in this set or one before it, by whatever law it had then."""
