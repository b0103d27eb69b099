"""Shapes in which a curve can disagree, as contrasts: what a test engineer would call the difference.

Each contrast is a curve b on the input u in [-1, 1], of both wheels alike (`sum`) or opposed (`difference`);
its statistic is b' S^-1 r over its standard deviation, N(0, 1) where model and records agree.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse import csc_array, hstack

from doe_kc.correlation.likelihood import CurveData, Likelihood
from doe_kc.curves import TYRE_LOAD
from doe_kc.ground.typing import FloatArray

Shape = Literal[
    "offset", "gradient", "curvature", "progression", "dead band", "loop width", "loop tilt", "static"
]
Wheels = Literal["both", "left/right"]
WHEELS: tuple[Wheels, ...] = ("both", "left/right")
"""Contrasts of the sum and of the difference of both wheels."""


def _even(u: FloatArray) -> FloatArray:
    return np.asarray(u**2)


MEAN_SHAPES: Mapping[Shape, Callable[[FloatArray], FloatArray]] = {
    "offset": np.ones_like,
    "gradient": lambda u: u,
    "curvature": _even,
    "progression": lambda u: u**3 - 0.6 * u,
    "dead band": lambda u: np.tanh(u / 0.1) - 1.5 * u,
}
"""Shapes of the mean of both branches; a curve that is a change from static has no offset."""
LOOP_SHAPES: Mapping[Shape, Callable[[FloatArray], FloatArray]] = {
    "loop width": lambda u: 1.0 - u**2,
    "loop tilt": lambda u: u * (1.0 - u**2),
}
"""Shapes of the half-width curve."""


@dataclass(frozen=True)
class Contrast:
    """One shape in which one response of one load case can disagree."""

    load_case: str
    """Id of the load case, `static` for the alignment figures."""
    response: str
    """Id of the response."""
    shape: Shape
    """The curve's shape."""
    wheels: Wheels
    """both: sum of the wheels; left/right: their difference."""


@dataclass(frozen=True)
class Contrasts:
    """All contrasts of the data."""

    names: tuple[Contrast, ...]
    """(k,)."""
    rows: csc_array
    """(M, k) whitened, of unit length; each is of one curve and its twin."""


def contrasts(likelihood: Likelihood) -> Contrasts:
    """All contrasts of the data."""
    pairs: dict[tuple[str, str, str], list[tuple[CurveData, slice]]] = {}
    for curve, place in likelihood.slices():
        pairs.setdefault((curve.load_case, curve.response, curve.branches), []).append((curve, place))
    size = likelihood.size
    names: list[Contrast] = []
    rows: list[csc_array] = []
    for (case, response, branches), members in pairs.items():
        shapes = MEAN_SHAPES if branches == "mean" else LOOP_SHAPES
        for shape, function in shapes.items():
            if shape == "offset" and response != TYRE_LOAD:
                continue
            for wheels in WHEELS:
                names.append(Contrast(case, response, shape, wheels))
                rows.append(_row(size, members, function, opposed=wheels != "both"))
    for response in dict.fromkeys(f.response for f in likelihood.figures):
        for wheels in WHEELS:
            names.append(Contrast("static", response, "static", wheels))
            rows.append(_static_row(likelihood, response, opposed=wheels != "both"))
    return Contrasts(tuple(names), csc_array(hstack([csc_array((size, 0)), *rows])))


def _static_row(likelihood: Likelihood, response: str, *, opposed: bool) -> csc_array:
    row = np.zeros(likelihood.size)
    first = sum(c.size for c in likelihood.curves)
    for i, figure in enumerate(likelihood.figures):
        if figure.response == response:
            row[first + i] = (-1.0 if opposed and figure.side else 1.0) / figure.sd
    return csc_array((row / np.linalg.norm(row))[:, None])


def _row(
    size: int,
    members: list[tuple[CurveData, slice]],
    function: Callable[[FloatArray], FloatArray],
    *,
    opposed: bool,
) -> csc_array:
    row = np.zeros(size)
    for curve, place in members:
        relative = curve.input / np.abs(curve.input).max()
        sign = -1.0 if opposed and curve.side else 1.0
        row[place] = sign * curve.whitened(np.asarray(function(relative), dtype=float))
    return csc_array((row / np.linalg.norm(row))[:, None])
