"""The tables of what the scatter comes from: shares of the parameters in the variance of each
characteristic."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from doe_kc.characteristics import Characteristic
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.production_scatter.model import Scatter
from doe_kc.production_scatter.result import Tolerance
from doe_kc.production_scatter.tightening import Tightening
from doe_kc.reports.table import Column, SheetLayout, Table


@dataclass(frozen=True)
class ParameterContribution:
    """first, total: (k,) shares of one parameter in the variances of all characteristics."""

    scatter: Scatter
    first: FloatArray
    total: FloatArray


@dataclass(frozen=True)
class ContributionRow:
    """Shares of one parameter in the variance of one characteristic, both sides together, and of each side in
    that of first order (nan where it has none)."""

    scatter: Scatter
    entry: Characteristic
    first: float
    left: float
    right: float
    total: float


def contribution_rows(tolerance: Tolerance) -> list[ParameterContribution]:
    """In the order of the parameters."""
    first, total = tolerance.first_shares, tolerance.totals.shares
    return [ParameterContribution(s, first[i], total[i]) for i, s in enumerate(tolerance.model.scatters)]


def contribution_table(tolerance: Tolerance) -> Table[ContributionRow]:
    """One row a parameter and characteristic."""
    shares, owner = tolerance.first_order.shares.T, tolerance.model.owner
    rows = []
    for i, line in enumerate(contribution_rows(tolerance)):
        own = shares[owner == i]
        sides = own if len(own) == 2 else np.full((2, own.shape[1]), math.nan)
        rows += [
            ContributionRow(line.scatter, entry, *map(float, (line.first[k], *sides[:, k], line.total[k])))
            for k, entry in enumerate(tolerance.characteristics)
        ]
    columns: tuple[Column[ContributionRow], ...] = (
        Column("parameter", "Path", lambda r: r.scatter.parameter.path),
        Column("name", "Characteristic", lambda r: r.entry.id),
        Column("first_order", "First order", lambda r: r.first, "0.0%"),
        Column("first_order_left", "of the left side", lambda r: r.left, "0.0%"),
        Column("first_order_right", "of the right side", lambda r: r.right, "0.0%"),
        Column("total", "Total", lambda r: r.total, "0.0%"),
    )
    return Table("Contributions", "Shares of the variance of each characteristic.", columns, rows)


def contribution_matrix(tolerance: Tolerance, kind: str) -> Table[ParameterContribution]:
    """Parameters down, characteristics across, percent of the variance. kind: "first" or "total"."""
    by_slopes = (
        f"Percent of each variance by slopes ({tolerance.first_order.source}); the columns add up to 100, a "
        "negative share makes up for others that it is correlated with."
    )
    by_cars = (
        "Percent of each variance from the cars themselves: slopes, curvature and interactions; an "
        "interaction counts for each of its partners."
    )
    words = {"first": ("First order", by_slopes), "total": ("Total", by_cars)}[kind]

    def column(k: int, entry: Characteristic) -> Column[ParameterContribution]:
        return Column(entry.id, f"{case_label(entry.load_case)}: {entry.label}",
                      lambda r: 100.0 * float(getattr(r, kind)[k]), "0", 5.2)  # fmt: skip

    columns = [column(k, e) for k, e in enumerate(tolerance.characteristics)]
    heads: tuple[Column[ParameterContribution], ...] = (
        Column("path", "Path", lambda r: r.scatter.parameter.path, width=12),
        Column("parameter", "Parameter", lambda r: r.scatter.parameter.label, width=50),
    )
    return Table(
        words[0],
        words[1],
        (*heads, *columns),
        contribution_rows(tolerance),
        title=f"Contributions, {words[0].lower()}",
        sheet=SheetLayout(frozen=columns[0].key),
    )


def reduction_matrix(tolerance: Tolerance) -> Table[Tightening]:
    """Parameters down, characteristics across: percent off the standard deviation with the tolerance
    halved."""

    def column(k: int, entry: Characteristic) -> Column[Tightening]:
        return Column(entry.id, f"{case_label(entry.load_case)}: {entry.label}",
                      lambda t: 100.0 * (1.0 - float(t.sd_ratio[k])), "0", 5.2)  # fmt: skip

    columns = [column(k, e) for k, e in enumerate(tolerance.characteristics)]
    heads: tuple[Column[Tightening], ...] = (
        Column("path", "Path", lambda t: t.scatter.parameter.path, width=12),
        Column("parameter", "Parameter", lambda t: t.scatter.parameter.label, width=50),
    )
    return Table(
        "Reduction",
        "Percent off the standard deviation of each characteristic when one scatter is halved.",
        (*heads, *columns),
        tolerance.tightenings,
        title="Halved scatter",
        sheet=SheetLayout(frozen=columns[0].key),
    )
