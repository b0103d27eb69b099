"""The parameters of a correlation before and after (thesis, Appendix A)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Literal

import numpy as np

from doe_kc.axle.parameter_kinds import kind_of
from doe_kc.correlation.posterior import BOUND_SHARE
from doe_kc.correlation.result import Correlation
from doe_kc.ground.listing import first_of
from doe_kc.ground.numbers import at_sd, number, signed, with_sd
from doe_kc.reports.table import Column, PageCell, PageLayout, SheetLayout, Table, row_digits
from doe_kc.variables import Tie

Role = Literal["variable", "tied", "fixed"]
UNSEEN_LISTED = 12
"""Variables that a sentence names; a five-link axle has 95 that a rig does not see."""


@dataclass(frozen=True, kw_only=True)
class ParameterRow:
    """One parameter; baseline, final, lower, upper, sd absolute in `unit`, nan where there is none.

    role: free between bounds, tied to `leader`, or fixed. at_bound: "lower", "upper" or "". sd: root mean
    square error of the final value by the posterior, nan at a bound. inward: there the distance from the
    bound within which the value lies with a probability of 68 %, nan elsewhere. visible: whether the
    measurement at least halves what was known before; None without posterior. start, place, spread: baseline,
    final and sd as places between the bounds (0 = lower, 1 = upper).
    """

    path: str
    label: str
    group: str
    unit: str
    role: Role = "variable"
    leader: str = ""
    baseline: float
    final: float
    lower: float = np.nan
    upper: float = np.nan
    at_bound: str = ""
    sd: float = np.nan
    inward: float = np.nan
    visible: bool | None = None
    start: float = np.nan
    place: float = np.nan
    spread: float = np.nan

    @property
    def change(self) -> float:
        """Final minus baseline."""
        return self.final - self.baseline

    @property
    def remark(self) -> str:
        """What an engineer should know of the final value, in words; empty when nothing."""
        words = {
            "tied": f"follows {self.leader}",
            "fixed": "fixed",
            "variable": self._bound_words(),
        }[self.role]
        unseen = "not visible in these measurements" if self.visible is False else ""
        return "; ".join(w for w in (words, unseen) if w)

    def _bound_words(self) -> str:
        if not self.at_bound:
            return ""
        if not np.isfinite(self.inward):
            return f"at its {self.at_bound} bound"
        sense = "above" if self.at_bound == "lower" else "below"
        return f"at its {self.at_bound} bound, at most {number(self.inward)} {sense} it (68 %)"


def parameter_rows(correlation: Correlation) -> list[ParameterRow]:
    """Variables in their order, then tied and fixed parameters."""
    space = correlation.problem.space
    before, after = space.values(correlation.baseline.point), correlation.values
    rows = list(_variables(correlation, before, after))
    by_path = {r.path: r for r in rows}
    rows += [_tied(t, by_path[t.leader], before, after) for t in space.ties]
    fixed = dict(space.fixed or {})
    return rows + [_plain(path, "fixed", before, after) for path in fixed]


def _variables(
    correlation: Correlation, before: dict[str, float], after: dict[str, float]
) -> Iterator[ParameterRow]:
    space, seen = correlation.problem.space, correlation.posterior
    for i, variable in enumerate(space.variables):
        place = float(correlation.best.point[i])
        ended = seen is not None and seen.at_bound[i] != 0
        spread = float(seen.rms_error[i]) if seen is not None and not ended else np.nan
        yield ParameterRow(
            path=variable.path,
            label=variable.parameter.label,
            group=variable.parameter.group,
            unit=variable.unit,
            baseline=before[variable.path],
            final=after[variable.path],
            lower=variable.lower,
            upper=variable.upper,
            at_bound="lower" if place <= BOUND_SHARE else "upper" if place >= 1.0 - BOUND_SHARE else "",
            sd=spread * variable.slope(place),
            inward=float(seen.inward[i]) * variable.slope(place) if seen is not None else np.nan,
            visible=bool(seen.visible[i]) if seen is not None else None,
            start=float(correlation.baseline.point[i]),
            place=place,
            spread=spread,
        )


def _tied(tie: Tie, leader: ParameterRow, before: dict[str, float], after: dict[str, float]) -> ParameterRow:
    row = _plain(tie.follower, "tied", before, after)
    slope = abs(tie.slope)
    extra = {
        "leader": tie.leader,
        "sd": leader.sd * slope,
        "inward": leader.inward * slope,
        "visible": leader.visible,
    }
    return ParameterRow(**{**asdict(row), **extra})


def _plain(path: str, role: Role, before: dict[str, float], after: dict[str, float]) -> ParameterRow:
    kind = kind_of(path)
    return ParameterRow(
        path=path,
        label=kind.label if kind else path,
        group=kind.group if kind else "OTHER",
        unit=kind.unit if kind else "",
        role=role,
        baseline=before[path],
        final=after[path],
    )


def parameter_format(row: ParameterRow) -> str:
    """Number format of its values: two digits of their sd, else three of a tenth of the range."""
    return row_digits(row.sd, (row.upper - row.lower) / 10.0 if row.upper > row.lower else row.final)


APPENDIX_A_COLUMNS: tuple[Column[ParameterRow], ...] = (
    Column("path", None, lambda r: r.path, page=PageCell("Path", style="first")),
    Column("label", "Parameter", lambda r: r.label, width=58,
           cell=lambda r: f"{r.path}: {r.label}", page=PageCell(style="wide")),
    Column("group", "Group", lambda r: r.group, width=14),
    Column("unit", "Unit", lambda r: r.unit, width=8, page=PageCell()),
    Column("role", "Role", lambda r: r.role, width=10),
    Column("tied_to", None, lambda r: r.leader),
    Column("baseline", "Baseline", lambda r: r.baseline, parameter_format, 12, json="baseline",
           page=PageCell(text=lambda r: at_sd(r.baseline, r.sd))),
    Column("final", "Final", lambda r: r.final, parameter_format, 12, json="final",
           page=PageCell("Final ± sd", text=lambda r: with_sd(r.final, r.sd), strong=lambda r: True)),
    Column("change", "Change", lambda r: r.change, parameter_format, 12,
           page=PageCell(text=lambda r: signed(r.change, r.sd).partition(" ")[0])),
    Column("lower", "Lower", lambda r: r.lower, parameter_format, 12, page=PageCell(layout=".6g")),
    Column("upper", "Upper", lambda r: r.upper, parameter_format, 12, page=PageCell(layout=".6g")),
    Column("at_bound", "At bound", lambda r: r.at_bound, width=10),
    Column("sd", "sd", lambda r: r.sd, parameter_format, 12, json="sd"),
    Column("inward", None, lambda r: r.inward, json="inward"),
    Column("not_visible", None, lambda r: None if r.visible is None else not r.visible),
    Column("remark", "Remark", lambda r: r.remark, width=32, csv=False, page=PageCell(
        style="remark", attributes=lambda r: {"class": "flag" if r.at_bound else ""})),
)  # fmt: skip


def parameter_table(correlation: Correlation) -> Table[ParameterRow]:
    """One row a parameter, with its bounds and what the measurement says of it; as Appendix A."""
    return Table(
        "Parameters",
        "Shaded: at a bound. Grey: not visible in these measurements, tied or fixed.",
        APPENDIX_A_COLUMNS,
        parameter_rows(correlation),
        muted=_quiet,
        flagged=lambda r: bool(r.at_bound),
        sheet=SheetLayout(
            frozen="unit",
            first=("group", "label", "unit", "role", "baseline", "final", "change", "sd"),
        ),
        page=PageLayout(
            "parameters-table",
            "Parameters",
            filtered=True,
            choices={
                "bound": "at a bound only",
                "visible": "hide those not visible",
                "variable": "variables only",
            },
            tags=_tags,
            quiet=_quiet,
            first=("path", "label", "unit", "baseline", "final", "change", "bar", "remark", "lower", "upper"),
        ),
    )


def _quiet(row: ParameterRow) -> bool:
    return row.visible is False or row.role != "variable"


def _tags(row: ParameterRow) -> str:
    tags = {
        "bound": bool(row.at_bound),
        "unseen": row.visible is False,
        "visible": row.visible is not False,
        "variable": row.role == "variable",
    }
    return " ".join(k for k, on in tags.items() if on)


def remark_sentences(correlation: Correlation) -> list[str]:
    """Targets out of reach, constraints in conflict, variables at their bounds, variables not visible."""
    rows = [r for r in parameter_rows(correlation) if r.role == "variable"]
    bound = [f"{r.path} ({r.at_bound})" for r in rows if r.at_bound]
    unseen = [r.path for r in rows if r.visible is False]
    out = list(correlation.notes)
    if bound:
        out.append(
            f"{len(bound)} of {len(rows)} variables end at a bound: {', '.join(bound)}. Widen the bound if "
            "the part allows it; otherwise the model may lack an effect that they stand in for."
        )
    if unseen:
        out.append(
            f"{len(unseen)} of {len(rows)} variables are not visible in these measurements: "
            f"{_listed(unseen)}. Their final values say nothing about the car."
        )
    if correlation.posterior is None:
        out.append("No standard deviations: the solver gives no sensitivities or no records were given.")
    return out


def _listed(paths: Sequence[str]) -> str:
    """Of many the first ones, and where the others stand."""
    rest = " (not_visible in parameters.csv)" if len(paths) > UNSEEN_LISTED else ""
    return first_of(paths, UNSEEN_LISTED) + rest
