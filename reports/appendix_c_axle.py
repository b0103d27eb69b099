"""The axle whose influence matrix is the published one (Appendix C), and what that matrix says of it.

Run: python reports/appendix_c_axle.py (about five minutes). Writes data/appendix_c_axle.toml,
appendix_c_axle.md, .png and .csv (agreement), and the tables appendix_c_axle_NAME.csv: parameters,
directions, starts, fits, cells. With --describe report and picture anew from these tables.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
import pandas as pd
from appendix_c_axle_text import AS_PRINTED, BEST, ON_GROUND, RIGID, markdown
from appendix_c_checks import (
    IDENTIFIED,
    LOST_DIGITS,
    SLIPS,
    compare,
    counted,
    identified_matrix,
    in_published_units,
    percent,
    published,
    x_reversed,
)
from axes import draw_matrix, figure
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

import doe_kc as kc
from doe_kc.axle_file.write import write_axle
from doe_kc.reports.drawing.style import PALETTE, save
from doe_kc.reports.influence.figures import ANNOTATE

HERE = Path(__file__).parent
EXAMPLE = HERE.parent / "examples" / "front_axle" / "axle.toml"
COMPLIANT_STRUT = {"strut.flexibility": 1.0}
"""The thesis's model has compliance in the strut (its section 3.2); the example's is rigid."""
FREE = (
    *("LLF.?", "LLR.?", "LWB.?", "LWD.?", "LWS.?", "UPB.?", "UPS.?", "UPBBI.?", "RIB.?", "ROB.?"),
    *("SFF.?", "SFR.?", "WLC.?", "ARB.?", "llf.??", "llr.??", "sff.??", "sfr.??", "upb.??"),
    "steering.column",
)
OF_THE_STRUT = ("CLAMP.?", "strut.flexibility")
NOISE = 0.025
"""Of a column's length: what the cells of the identified axle miss by."""
FOLDS = 3
"""Of the random cells withheld."""
Mask = Sequence[tuple[str, str]]


def mask() -> list[tuple[str, str]]:
    """Cells that no fit sees."""
    return [*((row, "*") for row in SLIPS), *((r.replace(" ", "."), c) for r, c in LOST_DIGITS)]


def start_axle(*, strut: bool = True) -> kc.Axle:
    """The example, with a strut that can bend."""
    return kc.with_values(EXAMPLE, COMPLIANT_STRUT) if strut else kc.read_axle(EXAMPLE)


def fit(
    matrix: pd.DataFrame,
    extra: Mask = (),
    *,
    starts: int = 1,
    strut: bool = True,
    wheel_radius_held: bool = True,
    workers: int | None = None,
) -> kc.IdentificationResult:
    """Spring, tyre and anti-roll bar held: a matrix of directions knows no scale of force."""
    free = (*FREE, *OF_THE_STRUT) if strut else FREE
    return kc.identify(
        matrix,
        start_axle(strut=strut),
        free,
        [*mask(), *extra],
        starts=starts,
        noise=NOISE,
        wheel_radius_held=wheel_radius_held,
        workers=workers,
    )


def identified(result: kc.IdentificationResult, like: pd.DataFrame) -> pd.DataFrame:
    """(57, 21) matrix of the identified axle in the units of the published columns."""
    frame = result.cells.pivot(index="parameter", columns="characteristic", values="identified")
    frame = frame.loc[[row.replace(" ", ".") for row in like.index], like.columns]
    return frame.set_axis(like.index, axis=0)


def means(
    name: str, matrix: pd.DataFrame, own: pd.DataFrame, columns: Sequence[str] = ()
) -> dict[str, object]:
    """A line of the table of fits: means over the columns that the fit saw, and over those it did not."""
    table = compare(own, matrix, counted(matrix))
    unseen = np.array([any(fnmatchcase(c, glob) for glob in columns) for c in matrix])
    out: dict[str, object] = {"fit": name}
    for what, chosen in (("seen", ~unseen), ("unseen", unseen)):
        for key, values in (("magnitude", table.magnitude), ("signed", table.signed)):
            out[f"{key}_{what}"] = float(np.mean(values[chosen])) if chosen.any() else np.nan
    return out


def withheld(
    name: str, matrix: pd.DataFrame, columns: Sequence[str], workers: int | None
) -> dict[str, object]:
    """A fit that does not see some columns (globs), and how well it predicts them."""
    result = fit(matrix, [("*", c) for c in columns], workers=workers)
    return means(name, matrix, identified(result, matrix), columns)


def withheld_cells(matrix: pd.DataFrame, workers: int | None) -> pd.DataFrame:
    """Cells that count, a third withheld at a time at random: printed and predicted, percent."""
    cells = counted(matrix)
    places = np.argwhere(cells.to_numpy())
    order = np.random.default_rng(0).permutation(len(places))
    parts = []
    for k in range(FOLDS):
        fold = places[order[k::FOLDS]]
        pairs = [(matrix.index[i].replace(" ", "."), matrix.columns[j]) for i, j in fold]
        own = identified(fit(matrix, pairs, workers=workers), matrix)
        rows, columns = fold.T
        parts.append(
            pd.DataFrame(
                {
                    "parameter": matrix.index[rows],
                    "characteristic": matrix.columns[columns],
                    "printed": matrix.to_numpy()[rows, columns],
                    "predicted": own.to_numpy()[rows, columns],
                }
            )
        )
    return pd.concat(parts, ignore_index=True)


def side_by_side(matrix: pd.DataFrame, own: pd.DataFrame) -> Figure:
    """Published, identified and difference with one colour scale; masked cells framed, slip rows starred."""
    fig, axes = figure(1, 3, size=(23.4, 11.7), share_x=False)
    parts = (
        ("Published (thesis, Appendix C), rows of x reversed", matrix),
        ("Identified axle", own),
        ("Identified less published", own - matrix),
    )
    for ax, (title, frame) in zip(axes[0], parts, strict=True):
        draw_matrix(ax, frame.to_numpy(), bar=ax is axes[0, 2])
        ax.set_title(title, fontsize=10)
        ax.set_xticks(np.arange(len(frame.columns)) + 0.5)
        ax.set_xticklabels(frame.columns, rotation=90)
        ax.set_yticks(np.arange(len(frame)) + 0.5)
        ax.set_yticklabels([f"{r} *" if r in SLIPS else r for r in frame.index], rotation=0)
        for row, column in LOST_DIGITS:
            place = frame.columns.get_loc(column), frame.index.get_loc(row)
            ax.add_patch(Rectangle(place, 1, 1, fill=False, ec=PALETTE["black"], lw=1.2))
            value = frame.loc[row, column]
            if abs(value) < ANNOTATE:
                middle = (place[0] + 0.5, place[1] + 0.5)
                ax.annotate(percent(value), middle, fontsize=5.5, ha="center", va="center")
        cases = [c.split(".")[0] for c in frame.columns]
        for k in range(1, len(cases)):
            if cases[k] != cases[k - 1]:
                ax.axvline(k, color="black", lw=0.9)
        ax.axhline(sum(r[0].isupper() for r in frame.index), color="black", lw=0.9)
    fig.suptitle(
        "Influence in percent of each published column's largest entry "
        "(* copying slip, frame: a digit seems lost; neither was fitted)"
    )
    return fig


def fit_all(workers: int | None) -> None:
    """Every fit, each table written as soon as it is there."""
    printed = published()
    matrix = x_reversed(printed)
    best = fit(matrix, starts=3, workers=workers)
    print(best)
    write_axle(best.axle, EXAMPLE, IDENTIFIED, note="identified from Appendix C of the thesis")
    best.to_frame().to_csv(HERE / "appendix_c_axle.csv", float_format="%.4f")
    for name in ("parameters", "directions", "starts"):
        getattr(best, name).to_csv(HERE / f"appendix_c_axle_{name}.csv", float_format="%.6g")
    lines = [means(BEST, matrix, identified(best, matrix))]
    rigid = fit(matrix, strut=False, workers=workers)
    lines.append(means(RIGID, matrix, identified(rigid, matrix)))
    on_ground = fit(matrix, wheel_radius_held=False, workers=workers)
    lines.append(means(ON_GROUND, matrix, identified(on_ground, matrix)))
    as_printed = fit(printed, workers=workers)
    lines.append(means(AS_PRINTED, printed, identified(as_printed, printed)))
    for name, columns in withheld_parts(matrix).items():
        lines.append(withheld(name, matrix, columns, workers))
        print(lines[-1], flush=True)
        pd.DataFrame(lines).to_csv(HERE / "appendix_c_axle_fits.csv", float_format="%.4f", index=False)
    cells = withheld_cells(matrix, workers)
    cells.to_csv(HERE / "appendix_c_axle_cells.csv", float_format="%.2f", index=False)


def withheld_parts(matrix: pd.DataFrame) -> dict[str, tuple[str, ...]]:
    """What is withheld -> its columns, globs."""
    return {
        "every second column, from the second": tuple(matrix.columns[1::2]),
        "every second column, from the first": tuple(matrix.columns[::2]),
        "drive and brake": ("drive.*", "brake.*"),
        "both lateral load cases": ("lateral*",),
    }


def describe() -> None:
    """Report and picture of the tables and the stored axle."""
    matrix = x_reversed(published())
    own = identified_matrix(matrix.index)
    text = markdown(HERE)
    (HERE / "appendix_c_axle.md").write_text(text, encoding="utf-8")
    save(side_by_side(matrix, in_published_units(own, matrix, counted(matrix))), HERE / "appendix_c_axle")
    print(text)


def main() -> None:
    """Fit, withhold, write; or describe what is there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--workers", type=int, default=None, help="processes, one per core by default")
    parser.add_argument("--describe", action="store_true", help="rewrite report and picture, fit nothing")
    options = parser.parse_args()
    if not options.describe:
        fit_all(options.workers)
    describe()


if __name__ == "__main__":
    main()
