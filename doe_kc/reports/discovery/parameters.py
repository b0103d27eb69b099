"""The tunable parameters of a discovery: nominal, re-tuned, and with the effect in the model."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import Discovery
from doe_kc.ground.numbers import at_sd
from doe_kc.reports.table import Column, PageCell, PageLayout, SheetLayout, Table, diverging, row_digits

FULL_COLOUR_DISTANCE = 2.0
"""Standard deviations of the prior at which the colour of a parameter's distance is full."""


@dataclass(frozen=True)
class TunedParameter:
    """A tunable parameter, values absolute in `unit`; sd: of the final value; distances from nominal in
    standard deviations of its prior, nan with effects where there are none; beyond: whether the last value is
    outside the study's bounds; tuned_bound, effect_bound: "lower" or "upper" where the re-tuned value and
    that with the effect are at a bound of their fit, else "".
    """

    path: str
    label: str
    group: str
    unit: str
    nominal: float
    tuned: float
    with_effect: float
    sd: float
    tuned_distance: float
    with_effect_distance: float
    beyond: bool
    tuned_bound: str = ""
    effect_bound: str = ""

    @property
    def bound_words(self) -> str:
        """What its bounds have to do with it, empty where nothing."""
        words = [
            "outside" if self.beyond else "",
            f"re-tuned at its {self.tuned_bound}" if self.tuned_bound else "",
            f"with the effect at its {self.effect_bound}" if self.effect_bound else "",
        ]
        return "; ".join(w for w in words if w)

    @property
    def moved(self) -> float:
        """Largest distance from nominal, sd of the prior."""
        return float(np.nanmax(np.abs([self.tuned_distance, self.with_effect_distance])))


def tuned_parameters(discovery: Discovery) -> list[TunedParameter]:
    """In the order of the variables."""
    tuned, final = discovery.search.tuned, discovery.fitted
    model = final.model
    has_effect = bool(model.members)
    sd = np.sqrt(np.diag(final.covariance))
    out = []
    for i, v in enumerate(model.space.variables):
        start, one, two = model.centre[i], tuned.z[i], final.z[i]
        out.append(
            TunedParameter(
                path=v.path,
                label=v.parameter.label,
                group=v.parameter.group,
                unit=v.unit,
                nominal=v.start,
                tuned=v.value(one),
                with_effect=v.value(two) if has_effect else math.nan,
                sd=float(sd[i]) * v.slope(two),
                tuned_distance=float((one - start) / model.prior_sd[i]),
                with_effect_distance=float((two - start) / model.prior_sd[i]) if has_effect else math.nan,
                beyond=v.path in discovery.beyond,
                tuned_bound=_bound(tuned, i),
                effect_bound=_bound(final, i) if has_effect else "",
            )
        )
    return out


def _bound(fit: Fit, place: int) -> str:
    if fit.z[place] <= fit.model.lower[place]:
        return "lower"
    return "upper" if fit.z[place] >= fit.model.upper[place] else ""


def _label(row: TunedParameter) -> str:
    if row.beyond:
        return Markup("{} <b>(outside its bounds)</b>").format(row.label)
    bound = row.tuned_bound if math.isnan(row.with_effect) else row.effect_bound
    return Markup("{} <b>(at its {} bound)</b>").format(row.label, bound) if bound else row.label


def _format(row: TunedParameter) -> str:
    return row_digits(row.sd, row.nominal)


TUNED_COLUMNS: tuple[Column[TunedParameter], ...] = (
    Column("path", None, lambda p: p.path, page=PageCell("Path", style="first")),
    Column("label", "Parameter", lambda p: p.label, width=58,
           cell=lambda p: f"{p.path}: {p.label}", page=PageCell(style="wide", text=_label)),
    Column("group", "Group", lambda p: p.group, width=15),
    Column("unit", "Unit", lambda p: p.unit, width=8, page=PageCell()),
    Column("nominal", "Nominal", lambda p: p.nominal, _format, 12,
           page=PageCell(text=lambda p: at_sd(p.nominal, p.sd))),
    Column("tuned", "Re-tuned", lambda p: p.tuned, _format, 12,
           page=PageCell(text=lambda p: at_sd(p.tuned, p.sd))),
    Column("with_effect", "With the effect", lambda p: p.with_effect, _format, 12),
    Column("sd", "sd", lambda p: p.sd, _format, 12),
    Column("tuned_distance", "Distance re-tuned, sd", lambda p: p.tuned_distance, "0.00", 14,
           page=PageCell("Re-tuned, times scatter", layout="+.2f")),
    Column("with_effect_distance", "Distance with the effect, sd", lambda p: p.with_effect_distance, "0.00",
           14,
           page=PageCell("With the effect, times scatter", layout="+.2f")),
    Column("beyond", None, lambda p: p.beyond),
    Column("bounds", "Bounds", lambda p: p.bound_words, width=44),
)  # fmt: skip


def tuned_table(discovery: Discovery) -> Table[TunedParameter]:
    """One row a tunable parameter before and after, with its distance from nominal."""
    remark = (
        "Distances from nominal in standard deviations of the prior; sd: of the last value, which at a bound "
        "says nothing."
    )
    if discovery.beyond:
        remark += " Parameters marked lie outside the study's bounds, as the records ask for."
    return Table(
        "Parameters",
        remark,
        TUNED_COLUMNS,
        tuned_parameters(discovery),
        colors=(diverging("tuned_distance", "with_effect_distance", FULL_COLOUR_DISTANCE),),
        sheet=SheetLayout(frozen="group"),
        page=PageLayout(
            "tuned-table",
            "Parameters",
            filtered=True,
            choices={"moved": "only those further off than production scatters"},
            tags=lambda p: "moved" if p.moved >= 1.0 else "",
            first=("path", "label", "unit", "nominal", "tuned", "last", "bar"),
        ),
    )
