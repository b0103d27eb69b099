"""The words of the report on the axle identified from Appendix C."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
from appendix_c_checks import (
    LOST_DIGITS,
    STRONG,
    compare,
    counted,
    entry_sd,
    identified_matrix,
    in_published_units,
    percent,
    published,
    rounding_ceiling,
    x_reversed,
)

from doe_kc.axle.model import STRUT_BENDING

BEST, RIGID, ON_GROUND, AS_PRINTED = "all columns", "rigid strut", "ground stays", "signs as printed"
"""Rows of the table of fits."""
SEEN = ["magnitude_seen", "signed_seen"]
SHOWN_DIRECTIONS, SHOWN_CELLS = 12, 12
HEAD = """# An axle from the published influence matrix

Appendix C of E. Wendeberg, *Using optimization to auto-correlate suspension characteristics to K&C
measurements*, Chalmers 2013, is an influence matrix of a real car's model; the car's hardpoints and
stiffnesses are not published. `doe_kc.identify` fits them: {unknowns} unknowns (coordinates, bushing
stiffnesses, steering column, strut), prior sd 10 mm or a factor of 2.5 about `examples/front_axle` with a
strut that can bend; spring, tyre and anti-roll bar held; columns compared by their direction alone. Rows
of x are reversed and {masked} cells are left out ([why](appendix_c.md#signs-and-digits)). Made by `python
reports/appendix_c_axle.py`; the axle is [data/appendix_c_axle.toml](data/appendix_c_axle.toml).

| mean correlation of the 21 columns | magnitudes | signed |
|---|---|---|
| example with a strut that can bend, cells that are fitted | {before} | {before_signed} |
| **identified axle**, cells that are fitted | **{magnitude}** | **{signed}** |
| ceiling: identified axle beside itself, rounded to the published digits | {ceiling} | {ceiling_signed} |
| identified axle, all 57 rows, x reversed | {all} | {all_signed} |
| identified axle, all 57 rows as printed | {all_printed} | {all_printed_signed} |
| fitted with a rigid strut | {rigid} | {rigid_signed} |
| fitted with the ground staying when the wheel centre moves | {on_ground} | {on_ground_signed} |
| fitted to the signs as printed | {as_printed} | {as_printed_signed} |

![side by side](appendix_c_axle.png)

## The axle

{axle}

The largest move of a hardpoint is {largest:.0f} mm ({largest_name}). {bound}

| the best known | start | identified | sd before | sd after |
|---|---|---|---|---|
{values}

`appendix_c_axle_parameters.csv` has all of them. They are those of *an* axle with this matrix, not of the
car: along {informed} of {unknowns} directions of the unknowns the matrix says more than the prior, along
{tenfold} ten times as much. It knows how compliances compare and where the arms point; the mounts of the
sub-frame as points, torsion stiffnesses and most vertical stiffnesses stay where the prior puts them.
Stiffnesses are known beside the spring and the tyre, which are held.

| direction | information | sd after over before | mostly |
|---|---|---|---|
{directions}

| start | cost | magnitudes | signed | distance to the best, prior sd |
|---|---|---|---|---|
{starts}

Starts are the example and two axles drawn about it by half a prior sd in every unknown.

## Predicted without having been seen

| withheld from the fit | magnitudes, predicted | signed, predicted | magnitudes, fitted | signed, fitted |
|---|---|---|---|---|
{tables}
"""

CELLS = """
Cells at random, a third withheld at a time: of the {count} that are {strong:g} % and more as printed
{same} are predicted with the printed sign, half of them within {median:.0f} %, nine in ten within
{ninety:.0f} % of the column's largest.

Cells that lost a digit, seen by no fit, in percent of the column's largest printed entry:

| cell | printed, x reversed | identified axle |
|---|---|---|
{lost}

## What resists

| cell | printed, x reversed | identified axle | share of the column's misfit |
|---|---|---|---|
{worst}

**`llf Fz`** has the opposite sign of `llr Fx` in drive's longitudinal displacement: with a stiffer
bushing the wheel centre would yield more to a force in its own direction. That compliance is f' K⁻¹ f,
and stiffness added to K can only lower it, whatever the axle. What is left is a static load on the
bushing: another stiffness settles elsewhere. An influence matrix does not tell such loads; the identified
axle has {llf} % where {printed_llf} % is printed.

**`WLC z`.** In this package the ground stays when the wheel centre moves, and the wheel's radius grows. The
printed row is that of a model in which the radius stays and the contact point, with the lateral force on it,
moves along, as a wheel-centre point of ADAMS/Car would; so it is fitted (`wheel_radius_held`). With the
ground where it is the same axle's row is zero in lateral camber and toe:

| column | printed | sd of rounding | ground stays | radius stays |
|---|---|---|---|---|
{wheel_centre}
"""


def markdown(folder: Path) -> str:
    """The report, of the tables in a folder and the stored axle."""
    printed = published()
    matrix = x_reversed(printed)
    chosen = counted(matrix)
    own = identified_matrix(matrix.index)
    scaled = in_published_units(own, matrix, chosen)
    tables = {
        name: pd.read_csv(folder / f"appendix_c_axle_{name}.csv", keep_default_na=name != "parameters")
        for name in ("parameters", "directions", "starts", "fits", "cells")
    }
    values, fits = tables["parameters"].set_index("parameter"), tables["fits"].set_index("fit")
    agreement = pd.read_csv(folder / "appendix_c_axle.csv")
    pairs = {
        "before": (agreement["magnitude_before"].mean(), agreement["signed_before"].mean()),
        "": tuple(fits.loc[BEST, SEEN]),
        "ceiling": rounding_ceiling(own, chosen),
        "all": compare(own, matrix).means,
        "all_printed": compare(own, printed).means,
        "rigid": tuple(fits.loc[RIGID, SEEN]),
        "on_ground": tuple(fits.loc[ON_GROUND, SEEN]),
        "as_printed": tuple(fits.loc[AS_PRINTED, SEEN]),
    }
    figures = {
        (f"{name}_{what}".strip("_") if what == "signed" else name or what): f"{value:.3f}"
        for name, pair in pairs.items()
        for what, value in zip(("magnitude", "signed"), pair, strict=True)
    }
    moves = (values["identified"] - values["start"])[values["unit"] == "mm"].abs()
    head = HEAD.format(
        **figures,
        unknowns=len(values),
        masked=int((~chosen).to_numpy().sum()),
        axle=_axle_words(values),
        largest=moves.max(),
        largest_name=moves.idxmax(),
        bound=_bound_words(values),
        values="\n".join(_value_row(str(name), row) for name, row in _shown(values).iterrows()),
        informed=int((tables["directions"]["information"] >= 1.0).sum()),
        tenfold=int((tables["directions"]["sd_ratio"] < 0.1).sum()),
        directions="\n".join(
            f"| {r.direction} | {r.information:.1f} | {r.sd_ratio:.2f} | {r.unknowns} |"
            for r in tables["directions"].head(SHOWN_DIRECTIONS).itertuples()
        ),
        starts="\n".join(
            f"| {r.start} | {r.cost:.1f} | {r.magnitude:.4f} | {r.signed:.4f} | {r.distance:.3f} |"
            for r in tables["starts"].itertuples()
        ),
        tables="\n".join(
            f"| {r.Index} | {r.magnitude_unseen:.3f} | {r.signed_unseen:.3f} | {r.magnitude_seen:.3f} "
            f"| {r.signed_seen:.3f} |"
            for r in fits.dropna().itertuples()
        ),
    )
    return head + _cells(tables["cells"], matrix, scaled)


def _cells(cells: pd.DataFrame, matrix: pd.DataFrame, scaled: pd.DataFrame) -> str:
    strong = cells[cells["printed"].abs() >= STRONG]
    error = (strong["predicted"] - strong["printed"]).abs()
    return CELLS.format(
        count=len(strong),
        strong=STRONG,
        same=int((np.sign(strong["predicted"]) == np.sign(strong["printed"])).sum()),
        median=error.median(),
        ninety=error.quantile(0.9),
        lost="\n".join(
            f"| `{row}` in `{column}` | {percent(matrix.loc[row, column])} "
            f"| {percent(scaled.loc[row, column])} |"
            for row, column in LOST_DIGITS
        ),
        worst="\n".join(_worst(matrix, scaled)),
        llf=percent(scaled.loc["llf Fz", "drive.wc_longitudinal_disp"]),
        printed_llf=percent(matrix.loc["llf Fz", "drive.wc_longitudinal_disp"]),
        wheel_centre="\n".join(_wheel_centre(matrix, scaled)),
    )


def _wheel_centre(matrix: pd.DataFrame, scaled: pd.DataFrame) -> Iterator[str]:
    """Row WLC z of the lateral columns: as printed, with the ground where it is, and moving along."""
    row = "WLC z"
    on_ground = identified_matrix(matrix.index, wheel_radius_held=False)
    along = identified_matrix(matrix.index)
    for column in [c for c in matrix if str(c).startswith("lateral")]:
        scale = scaled.loc["LWB z", column] / along.loc["LWB z", column]
        peaks = along.loc["LWB z", column] / on_ground.loc["LWB z", column]
        values = (matrix, on_ground * scale * peaks, scaled)
        printed, still, held = (percent(frame.loc[row, column]) for frame in values)
        lost = " (a digit lost)" if (row, column) in LOST_DIGITS else ""
        yield f"| `{column}` | {printed}{lost} | {entry_sd(column):.0f} | {still} | {held} |"


def _worst(matrix: pd.DataFrame, scaled: pd.DataFrame) -> Iterator[str]:
    """The cells that cost most, with their share of the column's misfit."""
    chosen = counted(matrix)
    squares = ((scaled - matrix).where(chosen, 0.0)) ** 2
    share, weight = squares / squares.sum(), squares / (matrix.where(chosen, 0.0) ** 2).sum()
    order = weight.stack().sort_values(ascending=False, kind="stable").index[:SHOWN_CELLS]
    for row, column in order:
        yield (
            f"| `{row}` in `{column}` | {percent(matrix.loc[row, column])} "
            f"| {percent(scaled.loc[row, column])} | {100.0 * share.loc[row, column]:.0f} % |"
        )


def _axle_words(values: pd.DataFrame) -> str:
    at = values["identified"]
    return (
        f"Strut bending {STRUT_BENDING / at['strut.flexibility']:.0f} Nm/deg; "
        f"stiffness factors `upb.Fy` {at['upb.Fy']:.2f}, "
        f"`llr.Fx` {at['llr.Fx']:.2f}, `llf.Fx` {at['llf.Fx']:.2f}, `sff.Fy` {at['sff.Fy']:.2f}, "
        f"`sfr.Fx` {at['sfr.Fx']:.1f}; steering column {at['steering.column']:.0f} N/mm at the rack."
    )


def _bound_words(values: pd.DataFrame) -> str:
    names = ", ".join(f"`{n}`" for n in values.index[values["at_bound"]])
    return f"At a bound, 2.5 prior sd away: {names}." if names else "No unknown is at a bound."


def _shown(values: pd.DataFrame) -> pd.DataFrame:
    """The unknowns that the matrix knows best."""
    ratio = values["sd_after"] / values["sd_before"]
    return values.loc[ratio.sort_values(kind="stable").index[:20]]


def _value_row(name: str, row: pd.Series) -> str:
    numbers = " | ".join(f"{row[k]:.4g}" for k in ("start", "identified", "sd_before", "sd_after"))
    unit = f" [{row['unit']}]" if row["unit"] not in ("", "-") else ""
    return f"| `{name}`{unit} | {numbers} |"
