"""The influence matrix of the shipped example beside the one that the thesis publishes (Appendix C).

Run: python reports/appendix_c.py. Writes appendix_c.md, .csv, .png and .svg beside itself, and stops with
an error when the agreement is worse than two independent solvers reach on this axle.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from appendix_c_causes import causes, matrix
from appendix_c_checks import PUBLISHED, SLIPS, STRONG, identified_matrix, x_reversed
from appendix_c_signs_text import signs_and_digits
from appendix_c_text import markdown
from axes import draw_matrix, figure
from matplotlib.figure import Figure

from doe_kc.axle_file import read_axle
from doe_kc.characteristics import CHARACTERISTICS, appendix_c
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.style import save

HERE = Path(__file__).parent
AXLE = HERE.parent / "examples" / "front_axle" / "axle.toml"
KINEMATIC = ("vertical", "roll", "steer")


@dataclass(frozen=True)
class Agreement:
    """Published and own matrix in percent (57 rows, 21 columns), and what they have in common.

    table: per column. knuckle_caster: |.| correlation of the column caster change when the caster angle
    is the one that the knuckle carries instead of the kingpin's.
    """

    published: pd.DataFrame
    own: pd.DataFrame
    table: pd.DataFrame
    knuckle_caster: float


def agreement() -> Agreement:
    """Runs the study on the rows of Appendix C and compares it."""
    published = pd.read_csv(PUBLISHED, index_col="parameter", dtype=dict.fromkeys(_ids(), float))
    axle = read_axle(AXLE)
    knuckle = CHARACTERISTICS["vertical.caster_compensation"]
    both = matrix(axle, published.index, [*appendix_c(), knuckle])
    own, caster = both[_ids()], published["vertical.caster_change"].to_numpy()
    return Agreement(
        published=published,
        own=own,
        table=pd.DataFrame([_column(c, own[c], published[c]) for c in _ids()]).set_index("characteristic"),
        knuckle_caster=pearson(np.abs(both[knuckle.id].to_numpy()), np.abs(caster)),
    )


def _ids() -> list[str]:
    return [c.id for c in appendix_c()]


def pearson(a: FloatArray, b: FloatArray) -> float:
    """Correlation coefficient."""
    return float(np.corrcoef(a, b)[0, 1])


def _column(name: str, own: pd.Series, published: pd.Series) -> dict[str, object]:
    kept = ~published.index.isin(SLIPS)
    a, b = own.to_numpy(), published.to_numpy()
    signed = pearson(a, b)
    strong = kept & (np.abs(a) >= STRONG) & (np.abs(b) >= STRONG)
    same = np.sign(a[strong]) == np.sign(b[strong]) * np.sign(signed)
    return {
        "characteristic": name,
        "absolute": pearson(np.abs(a), np.abs(b)),
        "absolute_without_slips": pearson(np.abs(a[kept]), np.abs(b[kept])),
        "signed": abs(signed),
        "overall_sign": int(np.sign(signed)),
        "strong_entries": int(strong.sum()),
        "same_sign": int(same.sum()),
        "strongest_published": _strongest(published[kept]),
        "strongest_own": _strongest(own[kept]),
    }


def _strongest(column: pd.Series) -> str:
    order = np.argsort(-np.abs(column.to_numpy()), kind="stable")[:3]
    return ", ".join(f"{column.index[i]} {column.iloc[i]:+.0f}" for i in order)


def check(found: Agreement) -> None:
    """AssertionError when the matrices agree less than two independent solvers do with the published one."""
    absolute = found.table["absolute"]
    assert absolute.mean() >= 0.82, absolute.mean()
    without = found.table["absolute_without_slips"].mean()
    assert round(without, 2) >= 0.85, without
    assert round(found.table["signed"].mean(), 2) >= 0.69, found.table["signed"].mean()
    for name, value in absolute.items():
        if str(name).split(".")[0] in KINEMATIC:
            least = 0.86 if name == "roll.camber_change" else 0.97
            assert value >= least, (name, value)


def side_by_side(found: Agreement) -> Figure:
    """Published and own matrix with one colour scale; the slip rows are named with a star."""
    fig, axes = figure(1, 2, size=(16.5, 11.7), share_x=False)
    both = (("Published (thesis, Appendix C)", found.published), ("This example", found.own))
    for ax, (title, frame) in zip(axes[0], both, strict=True):
        draw_matrix(ax, frame.to_numpy(), bar=ax is axes[0, 1])
        ax.set_title(title, fontsize=10)
        ax.set_xticks(np.arange(len(frame.columns)) + 0.5)
        ax.set_xticklabels(frame.columns, rotation=90)
        ax.set_yticks(np.arange(len(frame)) + 0.5)
        ax.set_yticklabels([f"{r} *" if r in SLIPS else r for r in frame.index], rotation=0)
        cases = [c.split(".")[0] for c in frame.columns]
        for k in range(1, len(cases)):
            if cases[k] != cases[k - 1]:
                ax.axvline(k, color="black", lw=0.9)
        ax.axhline(sum(r[0].isupper() for r in frame.index), color="black", lw=0.9)
    fig.suptitle("Influence in percent of each column's largest entry (* copying slip in the original)")
    return fig


def main() -> None:
    """Compare, write, assert, print the table."""
    found = agreement()
    experiments = causes(read_axle(AXLE), found.own, found.published, appendix_c())
    turned = x_reversed(found.published)
    reversed_signed = pd.Series({c: abs(pearson(found.own[c], turned[c])) for c in _ids()})
    section = signs_and_digits(found.published, found.own, identified_matrix(found.published.index))
    text = markdown(found.table, experiments, found.knuckle_caster, reversed_signed, section)
    (HERE / "appendix_c.md").write_text(text, encoding="utf-8")
    found.table.to_csv(HERE / "appendix_c.csv", float_format="%.4f")
    save(side_by_side(found), HERE / "appendix_c")
    print(text)
    check(found)


if __name__ == "__main__":
    main()
