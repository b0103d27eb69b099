"""Load cases held out: how well each is predicted by a model that was fitted to all the others."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from doe_kc.discovery.held_out import HeldOut
from doe_kc.reporting import style
from doe_kc.reporting.discovery_gaps import COLOURS
from doe_kc.reporting.names import case_label

ROW = 0.3
TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500)


def held_out_figure(cases: Sequence[HeldOut], study: str) -> Figure:
    """A row a load case: predicted RMS of the re-tuned model and of the one with the effect, log axis."""
    height = ROW * max(len(cases), 2) + 1.45
    margins = {"left": 0.23, "right": 0.83, "top": 1 - 0.65 / height, "bottom": 0.8 / height}
    fig, axes = style.figure(1, 1, size=(8.27, height), margins=margins)
    ax = axes[0, 0]
    ax.set_xscale("log")
    highest = 1.4 * max([3.0, *(max(h.tuned.rms, h.with_effect.rms) for h in cases)])
    ax.set_xlim(min([0.75, *(0.9 * h.with_effect.rms for h in cases)]), highest)
    ticks = [t for t in TICKS if t <= highest]
    ax.set_xticks(ticks, [str(t) for t in ticks])
    ax.minorticks_off()
    ax.set_ylim(max(len(cases), 1), 0)
    ax.grid(visible=False, axis="y")
    ax.tick_params(axis="y", length=0)
    ax.set_yticks([i + 0.5 for i in range(len(cases))], [case_label(h.load_case) for h in cases])
    ax.axvline(1.0, color="black", lw=0.9, ls=(0, (4, 2)), zorder=1)
    for y, held in enumerate(cases):
        one, two = held.tuned.rms, held.with_effect.rms
        ax.annotate(
            "", (two, y + 0.5), (one, y + 0.5), arrowprops={"arrowstyle": "-", "color": "#C9CED3", "lw": 1.2}
        )
        ax.plot([one], [y + 0.5], "o", color=COLOURS["tuned"], mfc="white", ms=5, mew=1.3)
        ax.plot([two], [y + 0.5], "D", color=COLOURS["with_effect"], ms=4.5)
        ax.text(
            1.02, y + 0.5, gain_words(held.gain), transform=ax.get_yaxis_transform(), fontsize=7, va="center"
        )
    ax.text(
        1.02, -0.15, "gain, ln density", transform=ax.get_yaxis_transform(), fontsize=6.5, color="#555555"
    )
    ax.set_xlabel("RMS of the held-out records, in standard deviations of their prediction")
    fig.legend(handles=_handles(), loc="lower center", ncols=3, fontsize=7, frameon=False)
    fig.suptitle(
        f"Load cases held out: {study}", fontsize=11, y=1 - 0.12 / height, va="top", parse_math=False
    )
    return fig


def gain_words(gain: float) -> str:
    """ln predictive density won, with its sign."""
    text = f"{gain:+,.{1 if abs(gain) < 100 else 0}f}".replace(",", " ")
    return text.replace("-0.0", "0.0").replace("+0.0", "0.0").replace("-", "−")


def _handles() -> list[Line2D]:
    return [
        Line2D([], [], color=COLOURS["tuned"], ls="", marker="o", mfc="white", mew=1.3,
               label="re-tuned without an effect"),
        Line2D([], [], color=COLOURS["with_effect"], ls="", marker="D", ms=4.5, label="with the effect"),
        Line2D([], [], color="black", ls="--", lw=0.9, label="as good as predicted"),
    ]  # fmt: skip
