"""The designs of a store that lie in a study's space, as arrays that surrogates are fitted to."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import parameter_value
from doe_kc.campaign.store import Store
from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.ground.typing import FloatArray
from doe_kc.variables import Space

EQUAL_TOLERANCE = 1e-9
"""Relative difference below which two parameter values are the same."""
BOUND_EDGE = 1e-6
"""Of the unit cube, within which a design counts as inside."""


@dataclass(frozen=True)
class Designs:
    """x: (n, d) in the unit cube. y: (n, m) values of the characteristics. failed: designs without result;
    elsewhere: designs outside the bounds, or with other parameters changed.
    """

    characteristics: tuple[Characteristic, ...]
    x: FloatArray
    y: FloatArray
    failed: int
    elsewhere: int


def designs_in_space(store: Store, space: Space, axle: Axle, windows: Mapping[str, float]) -> Designs:
    """Every stored evaluation of a design of the space, reduced with `windows`.

    Characteristics that no design knows are left out, and designs that lack one of the others. A parameter
    that a record does not name has the axle's value.
    """
    points, values, failed, elsewhere = [], [], 0, 0
    for record in store.records():
        point = place(record.parameters, space, axle)
        if point is None:
            elsewhere += 1
        elif record.status == "failed":
            failed += 1
        else:
            points.append(point)
            values.append(store.read(record, windows, curves=False).characteristics)
    x = np.array(points).reshape(-1, space.dimension)
    y = np.array(values).reshape(-1, len(CHARACTERISTICS))
    known = np.asarray(np.isfinite(y).any(axis=0))
    whole = np.isfinite(y[:, known]).all(axis=1)
    x, y = _distinct(x[whole], y[np.ix_(whole, known)])
    entries = tuple(c for c, k in zip(CHARACTERISTICS.values(), known, strict=True) if k)
    return Designs(entries, x, y, failed + int((~whole).sum()), elsewhere)


def place(parameters: Mapping[str, float], space: Space, axle: Axle) -> FloatArray | None:
    """(d,) point of a design, or None when it is not one of the space."""
    values = {v.path: parameters.get(v.path, v.parameter.nominal) for v in space.variables}
    if any(v.logarithmic and values[v.path] <= 0.0 for v in space.variables):
        return None
    point = space.unit(values)
    if not ((point >= -BOUND_EDGE) & (point <= 1.0 + BOUND_EDGE)).all():
        return None
    expected = space.values(point)
    every = set(parameters) | set(expected)
    return np.clip(point, 0.0, 1.0) if _same(every, parameters, expected, axle) else None


def _same(
    paths: Iterable[str], parameters: Mapping[str, float], expected: Mapping[str, float], axle: Axle
) -> bool:
    for path in paths:
        own = parameter_value(axle, path) if path not in parameters or path not in expected else 0.0
        given, wanted = parameters.get(path, own), expected.get(path, own)
        if not math.isclose(given, wanted, rel_tol=EQUAL_TOLERANCE, abs_tol=EQUAL_TOLERANCE):
            return False
    return True


def _distinct(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Each design once: stored values differ in the last digits that a point has not."""
    _, first = np.unique(np.round(x, 10), axis=0, return_index=True)
    rows = np.sort(first)
    return x[rows], y[rows]
