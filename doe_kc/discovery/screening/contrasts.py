"""Shapes in which a curve can disagree, as contrasts: what a test engineer would call the difference.

Each contrast is a curve b on the input u in [-1, 1], of both wheels alike (`sum`) or opposed (`difference`);
its statistic is b' S^-1 r over its standard deviation, N(0, 1) where model and records agree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from doe_kc.correlation.curve_data import Branches, CurveGroup
from doe_kc.correlation.likelihood import Likelihood
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
    known: dict[tuple[str, str, Branches], list[_Shaped]] = {}
    for group in likelihood.groups:
        for curve, place, rows in zip(group.curves, group.places, _whitened_shapes(group), strict=True):
            own = _Shaped(np.arange(place.start, place.stop), curve.side, rows)
            known.setdefault((curve.load_case, curve.response, curve.branches), []).append(own)
    names: list[Contrast] = []
    columns: list[_Row] = []
    for (case, response, branches), members in known.items():
        for i, shape in enumerate(_shapes(response, branches)):
            for wheels in WHEELS:
                names.append(Contrast(case, response, shape, wheels))
                signs = [-1.0 if wheels != "both" and m.side else 1.0 for m in members]
                values = [sign * m.rows[:, i] for sign, m in zip(signs, members, strict=True)]
                columns.append((np.concatenate([m.places for m in members]), np.concatenate(values)))
    for response in dict.fromkeys(f.response for f in likelihood.figures):
        for wheels in WHEELS:
            names.append(Contrast("static", response, "static", wheels))
            columns.append(_static_row(likelihood, response, opposed=wheels != "both"))
    return Contrasts(tuple(names), _columns(likelihood.size, columns))


@dataclass(frozen=True)
class _Shaped:
    """Whitened shapes of one curve."""

    places: NDArray[np.int_]
    """(n,) of its data in the residual."""
    side: int
    """0 left, 1 right."""
    rows: FloatArray
    """(n, shapes)."""


def _shapes(response: str, branches: Branches) -> dict[Shape, Callable[[FloatArray], FloatArray]]:
    shapes = MEAN_SHAPES if branches == "mean" else LOOP_SHAPES
    return {name: f for name, f in shapes.items() if name != "offset" or response == TYRE_LOAD}


def _whitened_shapes(group: CurveGroup) -> Iterator[FloatArray]:
    """(n, shapes) of each curve."""
    relative = group.first.input / np.abs(group.first.input).max()
    for curve, inverse in zip(group.curves, group.inverses, strict=True):
        functions = _shapes(curve.response, curve.branches).values()
        yield inverse @ np.array([np.asarray(f(relative), dtype=float) for f in functions]).T


_Row = tuple[NDArray[np.int_], FloatArray]
"""Places in the residual, and values there."""


def _static_row(likelihood: Likelihood, response: str, *, opposed: bool) -> _Row:
    first = likelihood.size - len(likelihood.figures)
    own = [(first + i, f) for i, f in enumerate(likelihood.figures) if f.response == response]
    values = [(-1.0 if opposed and figure.side else 1.0) / figure.sd for _, figure in own]
    return np.array([place for place, _ in own]), np.array(values)


def _columns(size: int, rows: Sequence[_Row]) -> csc_array:
    """(size, k), each row as a column of unit length."""
    if not rows:
        return csc_array((size, 0))
    ends = np.cumsum([0, *(places.size for places, _ in rows)])
    values = np.concatenate([values / np.linalg.norm(values) for _, values in rows])
    return csc_array((values, np.concatenate([places for places, _ in rows]), ends), (size, len(rows)))
