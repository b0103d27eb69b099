"""The characteristics of a correlation before and after (thesis, Appendix D)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import pandas as pd

from doe_kc.correlation.result import Correlation
from doe_kc.load_cases import CASE_ORDER
from doe_kc.report.names import case_label
from doe_kc.targets import Improvement
from doe_kc.targets.comparison.interval import FLOOR, constraint_interval


@dataclass(frozen=True)
class CharacteristicRow:
    """One characteristic with a target; values in `unit`. reachable: whether the bounds allow its target
    without harm to others, to first order; None where that is not known."""

    entry: Improvement
    reachable: bool | None = None

    @property
    def id(self) -> str:
        """`load_case.name`."""
        return self.entry.target.entry.id

    @property
    def label(self) -> str:
        """Name within its load case."""
        return self.entry.target.entry.label

    @property
    def unit(self) -> str:
        """Unit of all its values."""
        return self.entry.target.entry.unit

    @property
    def load_case(self) -> str:
        """Name of the load case."""
        return case_label(self.entry.target.entry.load_case)

    @property
    def interval(self) -> tuple[float, float]:
        """The constraint's; without one, that of equations 5.1 and 5.2, for information."""
        c = self.entry.target.constraint
        return (c.low, c.high) if c is not None else constraint_interval(self.entry.target.value)

    @property
    def inside(self) -> bool:
        """Whether the final value lies in `interval`."""
        low, high = self.interval
        return low <= self.entry.final <= high

    @property
    def objective(self) -> bool:
        """Whether the correlation works on its distance."""
        return self.entry.target.objective is not None

    @property
    def constraint(self) -> bool:
        """Whether `interval` must be met."""
        return self.entry.target.constraint is not None

    @property
    def held(self) -> bool:
        """Whether the search does not work on it, but must not move it away from its target either."""
        return self.entry.target.hold and not self.entry.sought

    @property
    def role(self) -> str:
        """objective (of the rating), search objective (not in the rating), constraint, held, or let go."""
        kind = "objective" if self.objective else "search objective" if self.entry.sought else ""
        words = [w for w in (kind, "constraint" if self.constraint else "") if w]
        return " + ".join(words) or ("held" if self.held else "let go")

    @property
    def distance(self) -> float:
        """(final - target) / sd of the target; nan for an exact target."""
        return self._in_sd(self.entry.final)

    @property
    def baseline_distance(self) -> float:
        """The baseline's."""
        return self._in_sd(self.entry.baseline)

    def _in_sd(self, value: float) -> float:
        sd = self.entry.target.sd
        return (value - self.entry.target.value) / sd if sd > 0 else math.nan

    def normalized(self, value: float) -> float:
        """1 + sign(target) (value - target) / sqrt(target^2 + 0.005): value / target away from zero.

        1 is the target whatever its sign; the measure of the constraint interval (equation 5.1) keeps
        targets near zero legible, and the interval at 1 -+ 0.15.
        """
        target = self.entry.target.value
        return 1.0 + math.copysign(1.0, target) * (value - target) / math.sqrt(target**2 + FLOOR)


def characteristic_rows(correlation: Correlation) -> list[CharacteristicRow]:
    """Static first, then by load case; within one in the order of the registry."""
    order = {name: i for i, name in enumerate(("static", *CASE_ORDER))}
    entries = sorted(correlation.improvements, key=lambda e: order.get(e.target.entry.load_case, len(order)))
    known = correlation.relaxation
    relaxed = known.distances if known is not None else {}
    return [
        CharacteristicRow(e, None if known is None else e.target.entry.id not in relaxed) for e in entries
    ]


def characteristic_frame(correlation: Correlation) -> pd.DataFrame:
    """One row a characteristic: id, label, load case, unit, values, interval, flags and improvement."""
    return pd.DataFrame([_record(r) for r in characteristic_rows(correlation)])


def _record(r: CharacteristicRow) -> dict[str, object]:
    e, (low, high) = r.entry, r.interval
    return {
        "id": r.id,
        "label": r.label,
        "load_case": r.load_case,
        "unit": r.unit,
        "target": e.target.value,
        "target_sd": e.target.sd,
        "baseline": e.baseline,
        "final": e.final,
        "low": low,
        "high": high,
        "inside": r.inside,
        "objective": r.objective,
        "constraint": r.constraint,
        "held": r.held,
        "reachable": "" if r.reachable is None else r.reachable,
        "improvement_percent": e.percent,
        "counts": e.counts,
        "baseline_distance_sd": r.baseline_distance,
        "final_distance_sd": r.distance,
        "target_normalized": 1.0,
        "baseline_normalized": r.normalized(e.baseline),
        "final_normalized": r.normalized(e.final),
    }
