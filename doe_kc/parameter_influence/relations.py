"""Which parameters set a characteristic, and which characteristics move together (the thesis's Table 2).

Reference: E. Wendeberg, Using optimization to auto-correlate suspension characteristics to K&C
measurements, Chalmers 2013, section 5.2.1 and Table 2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.axle.design_parameters import Parameter
from doe_kc.characteristics import Characteristic
from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.study import Influence

if TYPE_CHECKING:
    import pandas as pd

STRONG_PERCENT = 20.0
"""Entries below this share of a column's peak are left out."""
AT_MOST = 8
"""Entries of one characteristic or parameter that a sheet has columns for."""
TOGETHER = 0.9
"""|correlation| of two columns from which they count as one."""


@dataclass(frozen=True)
class Link:
    """One strong entry. percent: of the characteristic's largest entry; + = both grow together."""

    parameter: str
    characteristic: str
    percent: float


@dataclass(frozen=True)
class CharacteristicLinks:
    """The strongest parameters of a characteristic, strongest first."""

    characteristic: Characteristic
    links: tuple[Link, ...]


@dataclass(frozen=True)
class ParameterLinks:
    """The characteristics that a parameter moves most, strongest first."""

    parameter: Parameter
    links: tuple[Link, ...]


@dataclass(frozen=True)
class Together:
    """Characteristics that are correlated pair by pair over the parameters: one stands for all.

    signs: +1 moves as the first of the group does, -1 against it. weakest: smallest |r| of its pairs.
    """

    characteristics: tuple[str, ...]
    signs: tuple[int, ...]
    weakest: float


@dataclass(frozen=True)
class Relations:
    """Table 2 of a study."""

    by_characteristic: tuple[CharacteristicLinks, ...]
    by_parameter: tuple[ParameterLinks, ...]
    together: tuple[Together, ...]

    @property
    def longest(self) -> int:
        """Largest number of links or members in any list."""
        lists = [e.links for e in self.by_characteristic] + [e.links for e in self.by_parameter]
        return max([len(x) for x in lists] + [len(g.characteristics) for g in self.together], default=0)

    def to_frame(self) -> pd.DataFrame:
        """One row per characteristic and link: characteristic, unit, rank, parameter, percent."""
        rows = [
            (entry.characteristic.id, entry.characteristic.unit, rank, link.parameter, link.percent)
            for entry in self.by_characteristic
            for rank, link in enumerate(entry.links, start=1)
        ]
        import pandas as pd

        return pd.DataFrame(rows, columns=["characteristic", "unit", "rank", "parameter", "percent"])


def relations(
    influence: Influence,
    *,
    at_most: int = AT_MOST,
    together: float = TOGETHER,
) -> Relations:
    """Strongest links both ways, and groups of characteristics with |r| >= `together` in every pair.

    Links are listed from STRONG_PERCENT of the column's peak. at_most: of each characteristic and parameter.
    """
    percent = influence.percent
    return Relations(
        by_characteristic=tuple(
            CharacteristicLinks(entry, _strongest(influence, percent, None, j, at_most))
            for j, entry in enumerate(influence.characteristics)
        ),
        by_parameter=tuple(
            ParameterLinks(entry, _strongest(influence, percent, i, None, at_most))
            for i, entry in enumerate(influence.parameters)
        ),
        together=tuple(_groups(influence, together)),
    )


def _strongest(
    influence: Influence,
    percent: FloatArray,
    row: int | None,
    column: int | None,
    at_most: int,
) -> tuple[Link, ...]:
    line = percent[row] if row is not None else percent[:, column]
    order = np.argsort(-np.abs(line), kind="stable")[:at_most]
    return tuple(
        Link(
            parameter=influence.parameters[row if row is not None else k].path,
            characteristic=influence.characteristics[column if column is not None else k].id,
            percent=float(line[k]),
        )
        for k in map(int, order)
        if abs(line[k]) >= STRONG_PERCENT
    )


def column_correlation(values: FloatArray) -> FloatArray:
    """(k, k) Pearson correlation of the columns; 0 with a constant column, 1 on the diagonal."""
    centred = np.nan_to_num(values) - np.nan_to_num(values).mean(axis=0)
    norm = np.linalg.norm(centred, axis=0)
    scaled = np.divide(centred, norm, out=np.zeros_like(centred), where=norm > 0)
    out = np.clip(scaled.T @ scaled, -1.0, 1.0)
    np.fill_diagonal(out, 1.0)
    return np.asarray(out)


def _groups(influence: Influence, together: float) -> Iterator[Together]:
    r = column_correlation(influence.absolute)
    for members in _clusters(r, together):
        yield Together(
            characteristics=tuple(influence.characteristics[j].id for j in members),
            signs=tuple(1 if r[members[0], j] >= 0 else -1 for j in members),
            weakest=float(min(abs(r[a, b]) for a in members for b in members)),
        )


def _clusters(r: FloatArray, together: float) -> list[list[int]]:
    """Groups of two and more by complete linkage, so that no pair of a group is below the limit."""
    groups = [[j] for j in range(len(r))]
    weakest = np.abs(r)
    while len(groups) > 1:
        pairs = np.triu(weakest, k=1)
        a, b = np.unravel_index(int(np.argmax(pairs)), pairs.shape)
        # A pair exactly at the limit belongs together, whatever the rounding of |r|.
        if pairs[a, b] < together - 1e-12:
            break
        groups[a] = sorted(groups[a] + groups.pop(b))
        weakest[a] = weakest[:, a] = np.minimum(weakest[a], weakest[b])
        weakest = np.delete(np.delete(weakest, b, axis=0), b, axis=1)
    return sorted(group for group in groups if len(group) > 1)
