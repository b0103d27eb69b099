"""The section on signs and digits of the report on Appendix C."""

from __future__ import annotations

import numpy as np
import pandas as pd
from appendix_c_checks import (
    LAST_DIGITS,
    LOST_DIGITS,
    STRONG,
    SUM_SDS,
    GroupSum,
    caster_of_column,
    compare,
    counted,
    equal_signs,
    group_sums,
    in_published_units,
    off_grid,
    percent,
    step,
    with_one_digit_more,
    x_reversed,
)

LOST_WORDS = dict(zip(range(9, 13), ("Nine", "Ten", "Eleven", "Twelve"), strict=True))
MOST_LISTED = 8
SECTION = """
## Signs and digits

What the published matrix says by itself, and what the [axle identified from it](appendix_c_axle.md) says.

**The rows of x have the opposite sign of all others.**

- *Static caster*, arctan((x_UPB − x_LWB) / (z_UPB − z_LWB)), moves with `UPB z` as −tan(caster) times as
  it moves with `UPB x`. As printed ({caster_x:+.0f} and {caster_z:+.0f} %) the car has a caster of
  {caster:.1f} deg, with x reversed of {caster_reversed:+.1f} deg. The thesis's own Appendix D gives
  static caster the sign + and static camber − after both are divided by the target's magnitude, and all
  cars of this kind have positive caster.
- *Equal signs* among entries of {strong:g} % and more in both, up to one sign a column: the identified
  axle has {equal_printed} of {all_printed} as printed, {equal_reversed} of {all_reversed} with x
  reversed; the example, which was fitted to nothing, {example_printed} of {example_all} and
  {example_reversed} of {example_all_reversed}.
- *Signed correlation* of the example: {example_signed:.3f} as printed, {example_signed_reversed:.3f}
  reversed, mean of the 21 columns; it falls in {fallen}.
- The sums below say nothing of it: reversing all rows of an axis reverses its sum.

**A shift of the whole suspension does nothing.** The nine hardpoints of a group x, y or z are all points
of it but the mounts of the sub-frame, the spring's upper seat, the drop link and the strut's clamp, so
that their rows sum to nearly zero but for rounding: each entry of a coarse column is the difference of
two rounded outputs, 0.41 last digits sd. Of the {sums} sums, these are more than {sds:g} sd off:

| column | axis | sum, percent | sd of rounding | with the digits below | example | identified axle |
|---|---|---|---|---|---|---|
{sum_rows}

**{lost} cells have lost a digit.** A coarse column takes only multiples of its last digit. {off} entries in
the {coarse} coarse columns are no such multiple: {off_cells}. {also}

| cell | printed | last digit, percent | multiple | numbers with one digit more | identified axle |
|---|---|---|---|---|---|
{cells}

"Last digit" is that of the column's output. "Numbers with one digit more" become the printed one when one
of their two digits is lost, and are multiples; bold is the one nearest to what the identified axle says,
which was fitted without these cells. Signs as printed. Whether the digits were lost in the thesis or in its
text, of which this project's copy is made, is not known.

**Three rows are copies**: `upb Tz`, `sff Tz` and `sfr Tz` repeat `Fy` of the same bushing in all 21
columns.
"""


def signs_and_digits(published: pd.DataFrame, example: pd.DataFrame, identified: pd.DataFrame) -> str:
    """The section. published: as printed; example, identified: percent of each column's largest entry."""
    turned, cells = x_reversed(published), counted(published)
    everything = pd.DataFrame(True, index=cells.index, columns=cells.columns)
    fitted = in_published_units(identified, turned, cells)
    equal = {
        name: equal_signs(own, other, chosen)
        for name, own, other, chosen in (
            ("printed", identified, published, cells),
            ("reversed", identified, turned, cells),
            ("example_printed", example, published, cells),
            ("example_reversed", example, turned, cells),
        )
    }
    signed = {k: compare(example, m, everything).signed for k, m in (("as", published), ("turned", turned))}
    fallen = [
        f"`{column}` alone, by {before - after:.3f}" if count == 1 else f"`{column}` by {before - after:.3f}"
        for column, before, after in zip(published, signed["as"], signed["turned"], strict=True)
        if (count := int((signed["turned"] < signed["as"] - 5e-4).sum())) and before - after > 5e-4
    ]
    restored = _restored(published, fitted)
    others = [
        {(s.column, s.axis): s.total for s in group_sums(matrix)}
        for matrix in (restored, example, identified)
    ]
    sums = list(group_sums(published))
    off = off_grid(published.drop(index=["upb Tz", "sff Tz", "sfr Tz"]))
    return SECTION.format(
        caster_x=published.loc["UPB x", "vertical.static_caster"],
        caster_z=published.loc["UPB z", "vertical.static_caster"],
        caster=caster_of_column(published),
        caster_reversed=caster_of_column(turned),
        strong=STRONG,
        equal_printed=equal["printed"][0],
        all_printed=equal["printed"][1],
        equal_reversed=equal["reversed"][0],
        all_reversed=equal["reversed"][1],
        example_printed=equal["example_printed"][0],
        example_all=equal["example_printed"][1],
        example_reversed=equal["example_reversed"][0],
        example_all_reversed=equal["example_reversed"][1],
        example_signed=float(np.mean(signed["as"])),
        example_signed_reversed=float(np.mean(signed["turned"])),
        fallen=", ".join(fallen) or "none",
        sums=len(sums),
        sds=SUM_SDS,
        sum_rows="\n".join(_sum_row(s, others) for s in sums if s.beyond),
        lost=LOST_WORDS[len(LOST_DIGITS)],
        coarse=LOST_WORDS[len(LAST_DIGITS)].lower(),
        off=len(off),
        off_cells=", ".join(f"`{r}` in `{c}` ({published.loc[r, c]:+.0f} %)" for r, c in off),
        also=_also(off),
        cells="\n".join(_cell_row(row, column, published, fitted, off) for row, column in LOST_DIGITS),
    )


def _restored(published: pd.DataFrame, fitted: pd.DataFrame) -> pd.DataFrame:
    """The printed matrix with the likeliest number in each cell that lost a digit, its sign as printed."""
    out = published.copy()
    for row, column in LOST_DIGITS:
        value = published.loc[row, column]
        out.loc[row, column] = np.sign(value) * _nearest(value, column, fitted.loc[row, column])
    return out


def _nearest(value: float, column: str, predicted: float) -> int:
    return min(with_one_digit_more(value, column), key=lambda n: abs(n - abs(predicted)))


def _sum_row(s: GroupSum, others: list[dict[tuple[str, str], float]]) -> str:
    numbers = [percent(other[s.column, s.axis]) for other in others]
    return f"| `{s.column}` | {s.axis} | {s.total:+.0f} | {s.sd:.0f} | {' | '.join(numbers)} |"


def _also(off: list[tuple[str, str]]) -> str:
    rest = [cell for cell in LOST_DIGITS if cell not in off]
    names = ", ".join(f"`{row}` in `{column}`" for row, column in rest)
    return f"The sums name {len(rest)} more: {names}."


def _listed(numbers: list[int], best: int) -> list[str]:
    """The best in bold; of many those beside it."""
    place = numbers.index(best)
    first, end = (0, len(numbers)) if len(numbers) <= MOST_LISTED else (max(0, place - 2), place + 3)
    words = [f"**{n}**" if n == best else str(n) for n in numbers[first:end]]
    return ["…"] * (first > 0) + words + ["…"] * (end < len(numbers))


def _cell_row(
    row: str, column: str, published: pd.DataFrame, fitted: pd.DataFrame, off: list[tuple[str, str]]
) -> str:
    value, predicted = published.loc[row, column], fitted.loc[row, column]
    if row.endswith(" x"):
        predicted = -predicted  # the fit is to reversed rows
    best = _nearest(value, column, predicted)
    numbers = ", ".join(_listed(with_one_digit_more(value, column), best))
    digit = f"{step(column):.1f}" if step(column) else "below 1"
    multiple = "no" if (row, column) in off else "yes" if step(column) else "–"
    sign = "−" if value < 0 else ""
    cells = (f"`{row}` in `{column}`", f"{value:+.0f}", digit, multiple, f"{sign}({numbers})")
    return f"| {' | '.join(cells)} | {predicted:+.0f} |"
