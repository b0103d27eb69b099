"""The characteristics of a correlation before and after (thesis, Appendix D)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from doe_kc.correlation.assessment import inside
from doe_kc.correlation.result import Correlation
from doe_kc.ground.numbers import at_sd, with_sd
from doe_kc.load_cases import case_label
from doe_kc.reports.characteristic_columns import by_load_case
from doe_kc.reports.table import (
    NEGATIVE_FILL,
    Bar,
    Column,
    Inside,
    PageCell,
    PageLayout,
    SheetLayout,
    Table,
    TerminalCell,
    row_digits,
)
from doe_kc.targets import Improvement
from doe_kc.targets.comparison import FLOOR, constraint_interval


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
    def note(self) -> str:
        """Why it is special, in two words."""
        if not self.active:
            return self.role
        if self.constraint and not self.inside:
            return "outside"
        return "" if self.entry.counts else "baseline within its noise"

    @property
    def active(self) -> bool:
        """Whether the correlation works on it."""
        return self.entry.target.active or self.entry.sought

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
    entries = by_load_case(correlation.improvements, lambda e: e.target.entry.load_case)
    known = correlation.relaxation
    relaxed = known.distances if known is not None else {}
    return [
        CharacteristicRow(e, None if known is None else e.target.entry.id not in relaxed) for e in entries
    ]


def value_format(row: CharacteristicRow) -> str:
    """Number format of its values: two digits of the target's standard deviation."""
    return row_digits(row.entry.target.sd, row.entry.target.value or row.entry.final)


APPENDIX_D_COLUMNS: tuple[Column[CharacteristicRow], ...] = (
    Column("id", None, lambda r: r.id, json="name", terminal=TerminalCell("characteristic", "34")),
    Column("label", "Characteristic", lambda r: r.label, width=52, cell=lambda r: f"{r.label} ({r.id})",
           page=PageCell(style="first wrap", attributes=lambda r: {"title": r.id})),
    Column("load_case", "Load case", lambda r: r.load_case, width=25, page=PageCell(style="wrap")),
    Column("unit", "Unit", lambda r: r.unit, width=9, page=PageCell(), json="unit"),
    Column("target", "Target", lambda r: r.entry.target.value, value_format, json="target",
           page=PageCell("Target ± sd", text=lambda r: with_sd(r.entry.target.value, r.entry.target.sd)),
           terminal=TerminalCell("target", ">11", ".4g")),
    Column("target_sd", "Target sd", lambda r: r.entry.target.sd, value_format, json="sd"),
    Column("baseline", "Baseline", lambda r: r.entry.baseline, value_format, json="baseline",
           page=PageCell(text=lambda r: at_sd(r.entry.baseline, r.entry.target.sd)),
           terminal=TerminalCell("baseline", ">11", ".4g")),
    Column("final", "Final", lambda r: r.entry.final, value_format, json="final",
           page=PageCell(text=lambda r: at_sd(r.entry.final, r.entry.target.sd), strong=lambda r: True),
           terminal=TerminalCell("final", ">11", ".4g")),
    Column("low", "Low", lambda r: r.interval[0], value_format, json="low"),
    Column("high", "High", lambda r: r.interval[1], value_format, json="high"),
    Column("inside", "Inside", lambda r: r.inside, width=8),
    Column("objective", None, lambda r: r.objective),
    Column("constraint", None, lambda r: r.constraint),
    Column("held", None, lambda r: r.held, json="held"),
    Column("reachable", None, lambda r: r.reachable, json="reachable"),
    Column("role", "Role", lambda r: r.role, width=22, csv=False, page=PageCell(style="remark"), json="role"),
    Column("improvement_percent", "Improvement, %", lambda r: r.entry.percent, "0.0", width=13,
           page=PageCell("Improve\N{SOFT HYPHEN}ment, %", layout=".1f"), json="improvement_percent",
           terminal=TerminalCell("improved", ">10", text=lambda r: _percent(r.entry.percent))),
    Column("marked_unit", None, lambda r: r.unit, csv=False,
           terminal=TerminalCell("  unit", text=lambda r: f" {' ' if inside(r.entry) else '*'}{r.unit}")),
    Column("counts", "In the mean", lambda r: r.entry.counts, width=9),
    Column("baseline_distance_sd", "Baseline distance, sd", lambda r: r.baseline_distance, "0.0"),
    Column("final_distance_sd", "Final distance, sd", lambda r: r.distance, "0.0",
           page=PageCell("Distance, times noise", layout="+.1f", order=lambda r: abs(r.distance))),
    Column("target_normalized", None, lambda r: 1.0),
    Column("baseline_normalized", "Baseline, normalised", lambda r: r.normalized(r.entry.baseline), "0.000",
           width=12),
    Column("final_normalized", "Final, normalised", lambda r: r.normalized(r.entry.final), "0.000", width=12),
    Column("note", None, lambda r: r.note, csv=False, page=PageCell(
        "Remark", style="remark", attributes=lambda r: {"class": "flag" if r.note == "outside" else ""})),
)  # fmt: skip


def characteristic_table(correlation: Correlation) -> Table[CharacteristicRow]:
    """One row a characteristic: values, interval, flags, improvement; as Appendix D."""
    return Table(
        "Characteristics",
        "Blue: final value inside the interval; orange: outside.",
        APPENDIX_D_COLUMNS,
        characteristic_rows(correlation),
        colors=(Inside("final", "low", "high"), Bar("improvement_percent", NEGATIVE_FILL, 100)),
        sheet=SheetLayout(frozen="unit", single=True, first=("load_case", "label")),
        page=PageLayout(
            "characteristics-table",
            "Characteristics",
            filtered=True,
            choices={
                "active": "objectives and constraints only",
                "outside": "outside the interval only",
                "counts": "in the mean only",
            },
            tags=_tags,
            quiet=lambda r: not r.active,
            first=("label", "load_case", "unit", "target", "baseline", "final", "bar",
                   "improvement_percent", "final_distance_sd", "note", "role"),
        ),
    )  # fmt: skip


def _percent(value: float) -> str:
    return f"{value:.1f} %" if math.isfinite(value) else "-"


def _tags(row: CharacteristicRow) -> str:
    tags = {
        "active": row.active,
        "outside": not row.inside,
        "violated": row.constraint and not row.inside,
        "counts": row.entry.counts,
    }
    return " ".join(k for k, on in tags.items() if on)
