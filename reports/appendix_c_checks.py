"""Signs and digits of the published matrix, by itself and beside the axle identified from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from appendix_c_causes import DIGIT

from doe_kc.axle import Axle
from doe_kc.axle_file import read_axle
from doe_kc.characteristics import appendix_c
from doe_kc.ground.typing import FloatArray
from doe_kc.identification.agreement import MatrixAgreement, agreement
from doe_kc.identification.matrix_model import in_windows, influence_matrix
from doe_kc.parameter_influence.study import percent_of_column

DATA = Path(__file__).parent / "data"
PUBLISHED = DATA / "appendix_c_influence.csv"
IDENTIFIED = DATA / "appendix_c_axle.toml"
SLIPS = ("upb Tz", "sff Tz", "sfr Tz")
"""Rows that repeat the row `Fy` of the same bushing: a copying slip, a torsion stiffness does ~nothing."""
LOST_DIGITS = (
    ("LWB x", "lateral.toe_change"),
    ("WLC x", "lateral.wc_lateral_disp"),
    ("WLC z", "lateral.wc_lateral_disp"),
    ("llr Fx", "lateral.wc_lateral_disp"),
    ("LLF x", "lateral_offset.wc_lateral_disp"),
    ("llr Fx", "lateral_offset.wc_lateral_disp"),
    ("LWB x", "drive.drive_steer"),
    ("LLR z", "drive.anti_lift"),
    ("LWD x", "drive.anti_lift"),
    ("ROB x", "brake.brake_steer"),
    ("WLC x", "brake.anti_dive"),
)
"""Cells of one digit where two are to be expected."""
LAST_DIGITS = {**DIGIT, "roll.roll_steer": 30, "roll.wc_lateral_disp": 63}
"""Largest entry of a column in last digits of its output, of the columns where one is more than a percent."""
STRONG = 20.0
"""Percent from which an entry's sign counts."""
SUM_SDS = 3.5
"""Rounding sd of a sum of rows beyond which it is not due to rounding."""
DIFFERENCE_SD = np.sqrt(1.0 / 6.0)
"""Last digits: the difference of two numbers rounded independently."""
PERCENT_SD = np.sqrt(1.0 / 12.0)
CEILING_DRAWS = 100


def published() -> pd.DataFrame:
    """(57, 21) percent as printed."""
    ids = [c.id for c in appendix_c()]
    return pd.read_csv(PUBLISHED, index_col="parameter", dtype=dict.fromkeys(ids, float))


def x_reversed(matrix: pd.DataFrame) -> pd.DataFrame:
    """The matrix with the opposite sign in the rows of x."""
    rows = matrix.index.str.endswith(" x")
    return matrix.mul(np.where(rows, -1.0, 1.0), axis=0)


def counted(matrix: pd.DataFrame) -> pd.DataFrame:
    """bool of the same shape: False in the slip rows and the cells that lost a digit."""
    out = pd.DataFrame(True, index=matrix.index, columns=matrix.columns)
    out.loc[list(SLIPS)] = False
    for row, column in LOST_DIGITS:
        out.loc[row, column] = False
    return out


def exact_matrix(axle: Axle, rows: pd.Index, *, wheel_radius_held: bool = True) -> pd.DataFrame:
    """Exact matrix of an axle for the rows of Appendix C, percent of each column's largest entry."""
    columns, paths = appendix_c(), [r.replace(" ", ".") for r in rows]
    values = influence_matrix(in_windows(axle), paths, columns, wheel_radius_held=wheel_radius_held)
    return pd.DataFrame(percent_of_column(values), index=rows, columns=[c.id for c in columns])


def identified_matrix(rows: pd.Index, *, wheel_radius_held: bool = True) -> pd.DataFrame:
    """That of the stored axle."""
    return exact_matrix(read_axle(IDENTIFIED), rows, wheel_radius_held=wheel_radius_held)


def compare(own: pd.DataFrame, other: pd.DataFrame, cells: pd.DataFrame | None = None) -> MatrixAgreement:
    """Correlation by column, over all cells or those that are True."""
    chosen = np.ones(own.shape, dtype=bool) if cells is None else cells.to_numpy()
    return agreement(own.to_numpy(), other.to_numpy(), chosen, any_sign=True)


def equal_signs(own: pd.DataFrame, other: pd.DataFrame, cells: pd.DataFrame) -> tuple[int, int]:
    """(equal, all) among entries of 20 % and more in both, up to one sign a column."""
    sign = compare(own, other, cells).sign
    strong = cells & (own.abs() >= STRONG) & (other.abs() >= STRONG)
    same = np.sign(own) == np.sign(other) * sign
    return int((same & strong).to_numpy().sum()), int(strong.to_numpy().sum())


def percent(value: float) -> str:
    """With its sign, none at zero."""
    return "0" if round(value) == 0 else f"{value:+.0f}"


def in_published_units(own: pd.DataFrame, other: pd.DataFrame, cells: pd.DataFrame) -> pd.DataFrame:
    """The own matrix scaled column by column to fit the cells that count best."""
    a, b = own.where(cells, 0.0), other.where(cells, 0.0)
    return own * ((a * b).sum() / (a * a).sum())


@dataclass(frozen=True)
class GroupSum:
    """Sum of all entries of one axis in a column, percent. sd: what rounding makes of a sum of zero."""

    column: str
    axis: str
    total: float
    sd: float

    @property
    def beyond(self) -> bool:
        """Whether rounding does not explain it."""
        return abs(self.total) > SUM_SDS * self.sd


def step(column: str) -> float:
    """Percent of one last digit of the column's output; 0 where it is finer than a percent."""
    return 100.0 / LAST_DIGITS[column] if column in LAST_DIGITS else 0.0


def entry_sd(column: str) -> float:
    """Percent: rounding of one entry."""
    return float(np.hypot(DIFFERENCE_SD * step(column), PERCENT_SD))


def group_sums(matrix: pd.DataFrame) -> Iterator[GroupSum]:
    """Of the hardpoints' x, y and z rows: all of them together are a shift of the whole suspension."""
    for axis in "xyz":
        rows = matrix[matrix.index.str.endswith(f" {axis}")]
        for column in matrix:
            sd = entry_sd(str(column)) * np.sqrt(len(rows))
            yield GroupSum(str(column), axis, float(rows[column].sum()), float(sd))


def multiples(column: str) -> frozenset[int]:
    """Percent, without sign, that a column's last digits can give after rounding to whole percents."""
    count = LAST_DIGITS[column]
    exact = 100.0 * np.arange(count + 1) / count
    return frozenset(int(v) for way in (1e-9, -1e-9) for v in np.round(exact + way))


def off_grid(matrix: pd.DataFrame) -> list[tuple[str, str]]:
    """Cells of coarse columns whose number no whole count of last digits gives."""
    return [
        (str(row), column)
        for column in LAST_DIGITS
        for row, value in matrix[column].items()
        if int(abs(value)) not in multiples(column)
    ]


def with_one_digit_more(value: float, column: str) -> list[int]:
    """Numbers of two digits that become the printed one when one digit is lost, and that the column has."""
    printed = str(int(abs(value)))
    longer = [n for n in range(10, 101) if any(_without(str(n), k) == printed for k in range(len(str(n))))]
    return [n for n in longer if column not in LAST_DIGITS or n in multiples(column)]


def _without(text: str, place: int) -> str:
    return text[:place] + text[place + 1 :]


def caster_of_column(matrix: pd.DataFrame) -> float:
    """Caster in deg by its own column: d(caster) of UPB is as 1 to -tan(caster) along x and z."""
    column = matrix["vertical.static_caster"]
    return float(np.degrees(np.arctan(-column["UPB z"] / column["UPB x"])))


def rounding_ceiling(own: pd.DataFrame, cells: pd.DataFrame, seed: int = 0) -> tuple[float, float]:
    """Mean correlation (magnitudes, signed) of a matrix with itself, its outputs rounded as the published.

    A change is the difference of two outputs with so many digits, one above and one below the same nominal
    output, whose place between two digits is not known: mean over 100 draws of it.
    """
    rng = np.random.default_rng(seed)
    means = [
        compare(own, _rounded(own, rng), cells).means
        for _ in range(CEILING_DRAWS)
    ]  # fmt: skip
    return float(np.mean([m for m, _ in means])), float(np.mean([s for _, s in means]))


def _rounded(own: pd.DataFrame, rng: np.random.Generator) -> pd.DataFrame:
    out = own.copy()
    for column, count in LAST_DIGITS.items():
        half = own[column].to_numpy() / 100.0 * count / 2.0
        nominal = rng.uniform()
        change: FloatArray = np.round(nominal + half) - np.round(nominal - half)
        out[column] = 100.0 * change / max(np.abs(change).max(), 1.0)
    return out.round()
