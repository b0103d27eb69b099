"""What the cars of a design have to keep: limits of characteristics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
from numpy.typing import NDArray

from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.options import RequirementOptions
from doe_kc.targets import Targets
from doe_kc.targets.comparison import constraint_interval


@dataclass(frozen=True)
class Requirement:
    """low, high: in the characteristic's unit, -inf or inf where there is none. stated: in the study; else it
    is the constraint interval of the target."""

    entry: Characteristic
    low: float
    high: float
    stated: bool = True

    def outside(self, values: FloatArray) -> NDArray[np.bool_]:
        """(n,) whether each value is beyond a limit."""
        return np.asarray((values < self.low) | (values > self.high))


def build_requirements(
    entries: Sequence[Characteristic],
    options: Sequence[RequirementOptions],
    targets: Targets | None,
    source: str,
) -> dict[str, Requirement]:
    """By id of the characteristic, for `entries`.

    Those of the study's table; without one the intervals of the targets, as far as the study does not exclude
    them. InputError for an entry that fits no characteristic of the axle.
    """
    for option in options:
        if not any(fnmatchcase(e.id, option.match) for e in entries):
            known = [e.id for e in entries]
            own = "no characteristic of this axle" if _fits(option.match) else "no characteristic"
            raise InputError(
                f"{source}: tolerance.requirement: match = {option.match!r} fits {own}; expected an id or "
                f"glob such as {known[0]}.{nearest(option.match, known)}"
            )
    if options:
        return {e.id: r for e in entries if (r := _stated(e, options)) is not None}
    intervals = {} if targets is None else {t.entry.id: t for t in targets.characteristics if not t.excluded}
    out = {}
    for entry in entries:
        target = intervals.get(entry.id)
        if target is not None:
            limit = target.constraint
            low, high = (limit.low, limit.high) if limit is not None else constraint_interval(target.value)
            out[entry.id] = Requirement(entry, low, high, stated=False)
    return out


def _fits(match: str) -> bool:
    return any(fnmatchcase(name, match) for name in CHARACTERISTICS)


def _stated(entry: Characteristic, options: Sequence[RequirementOptions]) -> Requirement | None:
    own = [o for o in options if fnmatchcase(entry.id, o.match)]
    if not own:
        return None
    low, high = own[-1].low, own[-1].high
    return Requirement(entry, -math.inf if low is None else low, math.inf if high is None else high)
