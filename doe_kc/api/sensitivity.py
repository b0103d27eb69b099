"""Sensitivities: exact derivatives of the characteristics to the parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from doe_kc.api.axle import as_axle
from doe_kc.api.frame_result import FrameResult
from doe_kc.axle import Axle, Parameter
from doe_kc.characteristics import CHARACTERISTICS, Characteristic, characteristics_of
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.output import write_csv
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import characteristic_gradients
from doe_kc.solver.suite import solve
from doe_kc.study import select

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

SHOWN_BARS = 15


@dataclass(frozen=True, repr=False, eq=False)
class SensitivityResult(FrameResult):
    """Derivatives at one axle. values: (p, m) d(characteristic) / d(parameter), unit of the characteristic
    per unit of the parameter."""

    axle: Axle
    parameters: tuple[Parameter, ...]
    characteristics: tuple[Characteristic, ...]
    values: FloatArray

    def to_frame(self, form: Literal["matrix", "tidy"] = "matrix") -> pd.DataFrame:
        """matrix: parameter paths as index, characteristic ids as columns, units as in `units`.

        tidy: one row a pair, columns parameter, characteristic, value, unit.
        """
        import pandas as pd

        if form not in ("matrix", "tidy"):
            raise InputError(f"form {form!r}: expected matrix or tidy.")
        if form == "matrix":
            return self._frame(self.values)
        size = len(self.characteristics)
        return pd.DataFrame(
            {
                "parameter": np.repeat([p.path for p in self.parameters], size),
                "characteristic": [c.id for c in self.characteristics] * len(self.parameters),
                "value": self.values.ravel(),
                "unit": self.units.to_numpy().ravel(),
            }
        )

    @property
    def units(self) -> pd.DataFrame:
        """Unit of every entry of the matrix, such as "deg/m per mm"; per 1 for a factor."""
        return self._frame(
            [
                [f"{c.unit} per {p.unit.replace('-', '1')}" for c in self.characteristics]
                for p in self.parameters
            ]
        )

    def _frame(self, values: FloatArray | list[list[str]]) -> pd.DataFrame:
        import pandas as pd

        rows = pd.Index([p.path for p in self.parameters], name="parameter")
        return pd.DataFrame(values, index=rows, columns=[c.id for c in self.characteristics])

    @property
    def lines(self) -> list[str]:
        """Axle and size."""
        size = f"{len(self.parameters)} parameters x {len(self.characteristics)} characteristics"
        return [f"{self.axle.name}, {size}, exact derivatives"]

    def plot(self, characteristic: str | None = None, ax: Axes | None = None) -> Axes:
        """Bars of the change of one characteristic (by default the first) for one step of each parameter
        (`parameters`, column step), the 15 largest; InputError for a characteristic that is not there."""
        from doe_kc.api.axes import axes_or_new
        from doe_kc.reports.drawing.style import PALETTE

        ids = [c.id for c in self.characteristics]
        name = characteristic or ids[0]
        if name not in ids:
            raise InputError(f"{name!r} is not among the characteristics.{nearest(name, ids)}")
        entry = self.characteristics[ids.index(name)]
        change = self.values[:, ids.index(name)] * np.array([p.step for p in self.parameters])
        order = np.argsort(-np.abs(np.nan_to_num(change)), kind="stable")[:SHOWN_BARS]
        ax = axes_or_new(ax, (6.4, 1.4 + 0.24 * len(order)))
        labels = [
            f"{self.parameters[i].path}  {self.parameters[i].step:+.3g} {_unit(self.parameters[i])}"
            for i in order
        ]
        ax.barh(np.arange(len(order)), change[order], color=PALETTE["blue"])
        ax.set_yticks(np.arange(len(order)), labels, fontsize="small")
        ax.invert_yaxis()
        ax.axvline(0.0, color="black", lw=0.8)
        ax.set_xlabel(f"change of {entry.label} [{entry.unit}]")
        ax.set_title(entry.id)
        return ax

    def write(self, out: str | PathLike[str]) -> list[Path]:
        """sensitivities.csv in `out`, the tidy frame; returns the paths."""
        return [write_csv(Path(out) / "sensitivities.csv", self.to_frame("tidy"))]


def _unit(parameter: Parameter) -> str:
    return "" if parameter.unit == "-" else parameter.unit


def sensitivities(
    axle: Axle | str | PathLike[str],
    parameters: Sequence[str] | None = None,
    characteristics: Sequence[str] | None = None,
    *,
    windows: Mapping[str, float] | None = None,
) -> SensitivityResult:
    """Exact derivatives of the characteristics to the parameters at the axle as it is, by the implicit
    function theorem; no finite differences, some 0.1 s for all of them.

    parameters: paths or globs such as "LLF.*", all design parameters by default; rows are in the order of
    the function `parameters`. characteristics: ids, all by default. windows: load case -> half-width of its
    fit window in the input's unit, in place of the default. A positive entry: the characteristic rises with
    the parameter.

    Raises InputError for an unknown name, RunError where the axle has no equilibrium.

    >>> axle = kc.read_axle("examples/front_axle/axle.toml")
    >>> result = kc.sensitivities(axle, ["ROB.z", "llr.F?"], ["vertical.bump_steer"])
    >>> round(result.to_frame().loc["ROB.z", "vertical.bump_steer"].item(), 2)
    -1.01
    >>> result.units.loc["ROB.z", "vertical.bump_steer"]
    'deg/m per mm'
    """
    model = as_axle(axle)
    rows = select(model, ["*"] if parameters is None else list(parameters), "sensitivities")
    entries = _entries(model, characteristics)
    cases = list(dict.fromkeys(c.load_case for c in entries if c.load_case in model.load_cases))
    solution = solve(model, cases)
    values = characteristic_gradients(model, solution, [p.path for p in rows], entries, windows=windows).T
    return SensitivityResult(model, rows, tuple(entries), np.asarray(values))


def _entries(axle: Axle, names: Sequence[str] | None) -> list[Characteristic]:
    """The characteristics; by default those that the axle has."""
    if names is None:
        return characteristics_of(axle)
    for name in names:
        if name not in CHARACTERISTICS:
            raise InputError(
                f"sensitivities: {name!r} is not a characteristic; see docs/characteristics.md."
                f"{nearest(name, CHARACTERISTICS)}"
            )
    return [CHARACTERISTICS[name] for name in names]
