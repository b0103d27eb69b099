"""Which effects these records can tell apart once the axle is re-tuned, and what to measure where not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from string import ascii_uppercase

import numpy as np

from doe_kc.correlation.likelihood import Rewhitening
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.thresholds import ALIKE_CORRELATION
from doe_kc.discovery.verdict.exclusion import HypothesisStatus, Status
from doe_kc.effects import EFFECTS
from doe_kc.effects.words import hypothesis_label
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.discovery.words import STATUS_WORDS
from doe_kc.reports.table import Column, SheetLayout, Table

VISIBLE_LEVEL = 1.0
"""Standard deviations that an effect must leave after re-tuning for its direction to mean anything."""
ALONE, HIDDEN = "told apart", "hidden"
"""Groups of effects that no other resembles, and of those that re-tuning absorbs."""


@dataclass(frozen=True)
class Isolability:
    """labels, statuses, tests: (k,) of every hypothesis. detectable: (k,) smallest size that would be found,
    in typical sizes. correlation: (k, k) |correlation| of the changes that re-tuning leaves, nan where it
    leaves nothing. tests: what to measure to see it, or to tell it from its like."""

    labels: tuple[str, ...]
    statuses: tuple[Status, ...]
    detectable: FloatArray
    correlation: FloatArray
    tests: tuple[str, ...]

    @cached_property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """Places of the hypotheses of which every pair is alike: complete linkage, two members at least.

        Those with a finding come first, then the larger ones.
        """
        from scipy.cluster.hierarchy import fcluster, linkage  # its import takes 0.1 s, of every command

        visible = np.flatnonzero(np.isfinite(np.diag(self.correlation)))
        if visible.size < 2:
            return ()
        distance = 1.0 - self.correlation[np.ix_(visible, visible)]
        upper = np.triu_indices(visible.size, 1)
        tree = linkage(distance[upper], method="complete")
        numbers = fcluster(tree, 1.0 - ALIKE_CORRELATION, criterion="distance")
        members = [tuple(int(i) for i in visible[numbers == n]) for n in np.unique(numbers)]
        several = [g for g in members if len(g) > 1]
        return tuple(sorted(several, key=lambda g: (not self._found(g), -len(g), g)))

    @property
    def hidden(self) -> tuple[int, ...]:
        """Places of the hypotheses that re-tuning absorbs."""
        return tuple(int(i) for i in np.flatnonzero(np.isnan(np.diag(self.correlation))))

    @property
    def alone(self) -> tuple[int, ...]:
        """Places of the hypotheses that no other resembles."""
        taken = {i for group in self.groups for i in group} | set(self.hidden)
        return tuple(i for i in range(len(self.labels)) if i not in taken)

    def least_correlation(self, group: Sequence[int]) -> float:
        """The smallest |correlation| of two of its members."""
        return min(float(self.correlation[i, j]) for i, j in combinations(group, 2))

    def _found(self, group: Sequence[int]) -> bool:
        return any(self.statuses[i] in ("found", "trace") for i in group)


def isolability(discovery: Discovery) -> Isolability:
    """In the order of the library; the axle re-tuned about the final model, sizes of its effects known."""
    order = list(EFFECTS)
    stands = sorted(discovery.statuses, key=lambda s: (order.index(s.hypothesis.effect), s.hypothesis.name))
    changes = _changes(discovery)
    fit = discovery.fitted
    own = fit.changes(np.array([changes[s.hypothesis.name] for s in stands]).T)
    length = np.sqrt(fit.tuning_projection.squares(own))
    scale = np.where(length > 0.0, length, 1.0)
    products = fit.tuning_projection.gram_of(own) / np.outer(scale, scale)
    correlation = np.clip(np.abs(products), 0.0, 1.0)
    hidden = length < VISIBLE_LEVEL
    correlation[hidden, :] = correlation[:, hidden] = np.nan
    return Isolability(
        tuple(hypothesis_label(s.hypothesis) for s in stands),
        tuple(s.status for s in stands),
        np.array([s.detectable for s in stands]),
        correlation,
        tuple(_test(s) for s in stands),
    )


def _test(status: HypothesisStatus) -> str:
    """Parts that a bench has to measure, else what shows the effect itself."""
    if status.component_test is not None:
        return f"measure {', '.join(status.component_test.parts)} on a bench"
    return EFFECTS[status.hypothesis.effect].shown_by.split(";")[0]


def _changes(discovery: Discovery) -> dict[str, FloatArray]:
    """(M,) change of each hypothesis as screened last, in units of the final model's errors."""
    search = discovery.search
    units = Rewhitening(search.with_law_discrepancy.model.likelihood, discovery.fitted.model.likelihood)
    return {s.hypothesis.name: units.of(s.change) for s in search.screened}


def group_name(place: int) -> str:
    """A, B, ..., Z, AA, BB, ..."""
    return ascii_uppercase[place % 26] * (1 + place // 26)


@dataclass(frozen=True)
class IsolabilityRow:
    """One hypothesis. group: letter, `ALONE` or `HIDDEN`. nearest: |correlation| with the hypothesis that is
    most alike, nan where re-tuning leaves nothing. test: empty where the records tell it apart and show
    it."""

    group: str
    label: str
    status: Status
    detectable: float
    nearest: float
    nearest_label: str
    test: str


def isolability_rows(table: Isolability) -> list[IsolabilityRow]:
    """Groups of several first, then those that are told apart, then those that re-tuning hides."""
    several = [(group_name(k), group) for k, group in enumerate(table.groups)]
    parts = [*several, (ALONE, table.alone), (HIDDEN, table.hidden)]
    return [_row(table, name, i) for name, group in parts for i in group]


def _row(table: Isolability, group: str, i: int) -> IsolabilityRow:
    others = np.nan_to_num(table.correlation[i], nan=-1.0)
    others[i] = -1.0
    nearest = int(np.argmax(others)) if others.size > 1 else i
    known = others[nearest] >= 0.0
    needed = group != ALONE or table.detectable[i] > 1.0
    return IsolabilityRow(
        group,
        table.labels[i],
        table.statuses[i],
        float(table.detectable[i]),
        float(others[nearest]) if known else np.nan,
        table.labels[nearest] if known else "",
        table.tests[i] if needed else "",
    )


ISOLABILITY_COLUMNS: tuple[Column[IsolabilityRow], ...] = (
    Column("group", "Group", lambda r: r.group, width=11),
    Column("effect", "Effect", lambda r: r.label, width=44),
    Column("status", "Status", lambda r: r.status, width=17, words=lambda r: STATUS_WORDS[r.status]),
    Column("detectable_times_typical", "Detectable, times typical", lambda r: r.detectable, "0.00", 12),
    Column("nearest_correlation", "Most alike, |r|", lambda r: r.nearest, "0.00", 10),
    Column("nearest", "Most alike", lambda r: r.nearest_label, width=40),
    Column("measure", "What to measure", lambda r: r.test, width=58),
)  # fmt: skip


def isolability_table(discovery: Discovery) -> Table[IsolabilityRow]:
    """Groups of effects that re-tuning cannot tell apart, and what to measure."""
    return Table(
        "Groups",
        "Effects with the same letter change the records alike after re-tuning (|correlation| "
        f"{ALIKE_CORRELATION:g} and above): these records name the group, not the member. Hidden: re-tuning "
        "takes its place.",
        ISOLABILITY_COLUMNS,
        isolability_rows(isolability(discovery)),
        title="Effects that the records tell apart",
        muted=lambda r: r.group == HIDDEN,
        sheet=SheetLayout(frozen="status", wrapped=True),
    )
