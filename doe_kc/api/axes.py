"""Axes to draw into: the caller's own, or those of a new figure."""

from __future__ import annotations

from matplotlib.axes import Axes

from doe_kc.curves import RESPONSE_UNITS, SIDE_WORDS, CurveSet
from doe_kc.ground.errors import InputError, nearest
from doe_kc.load_cases import case_label
from doe_kc.reports.drawing.style import PALETTE
from doe_kc.reports.names import input_label, response_axis

SIDE_PALETTE = {"L": PALETTE["blue"], "R": PALETTE["vermillion"]}


def axes_or_new(ax: Axes | None, size: tuple[float, float]) -> Axes:
    """`ax`, or the axes of a new pyplot figure of `size` inches.

    Pyplot, as in pandas, so that notebooks and `plt.show()` know the figure; without a display it takes the
    backend Agg by itself.
    """
    if ax is not None:
        return ax
    from matplotlib import pyplot

    return pyplot.subplots(figsize=size, layout="constrained")[1]


def check_curve(curves: CurveSet, load_case: str, response: str) -> None:
    """InputError for a load case or response that the curves do not have."""
    if load_case not in curves.cases:
        raise InputError(
            f"{load_case!r} is not a load case of {curves.source}; there are {', '.join(curves.cases)}."
            f"{nearest(load_case, curves.cases)}"
        )
    known = [r for r in RESPONSE_UNITS if r in curves.cases[load_case].mean]
    if response not in known:
        raise InputError(
            f"{response!r} is not a response of {load_case}; there are {', '.join(known)}."
            f"{nearest(response, known)}"
        )


def draw_curves(ax: Axes, curves: CurveSet, load_case: str, response: str, *, measured: bool = False) -> None:
    """Both wheels over the input: lines for a model, dots for a measurement, a band between the branches."""
    case = curves.cases[load_case]
    kind = "measured" if measured else "model"
    for row, (side, word) in enumerate(SIDE_WORDS.items()):
        mean, half = case.mean[response][row], abs(case.half_width[response][row])
        colour = SIDE_PALETTE[side]
        if measured:
            ax.plot(case.input, mean, ".", color=colour, ms=3, label=f"{kind}, {word}")
        else:
            ax.plot(case.input, mean, color=colour, label=f"{kind}, {word}")
        if half.max() > 0.0:
            ax.fill_between(case.input, mean - half, mean + half, color=colour, alpha=0.2, lw=0)
    ax.set_xlabel(input_label(load_case, case.input_unit))
    ax.set_ylabel(response_axis(response))
    ax.set_title(case_label(load_case))
    ax.grid(color="#DDDDDD", lw=0.5)
    ax.legend(fontsize="small")
