"""The bands in which the curves of the cars lie."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray

BAND_PERCENTILES = (2.5, 25.0, 50.0, 75.0, 97.5)
"""Of the cars, at each input: 95 % and half of them lie between the outer and the inner two."""


@dataclass(frozen=True)
class CurveBand:
    """One load case. input: (n,) in its unit. nominal, percentiles: response -> (2, n) and (5, 2, n) of the
    mean curves, left and right, in the response's unit; angles and wheel centre as change from static."""

    load_case: str
    input_unit: str
    input: FloatArray
    nominal: Mapping[str, FloatArray]
    percentiles: Mapping[str, FloatArray]

    def inside(self, measured: CaseCurves, response: str) -> FloatArray:
        """(2,) share of a measured curve's points within the outer percentiles; nan where none is reached."""
        reach = (measured.input >= self.input[0]) & (measured.input <= self.input[-1])
        out = np.full(2, np.nan)
        if not reach.any():
            return out
        low, *_, high = self.percentiles[response]
        for side in (0, 1):
            curve = measured.mean[response][side][reach]
            limits = [np.interp(measured.input[reach], self.input, edge[side]) for edge in (low, high)]
            out[side] = float(((curve >= limits[0]) & (curve <= limits[1])).mean())
        return out


class BandCollector:
    """Keeps the mean curves of many cars, in single precision, until their percentiles are asked for."""

    def __init__(self, nominal: CurveSet, responses: Sequence[str]) -> None:
        """nominal: of the unchanged axle, whose inputs all cars share."""
        self._nominal = nominal
        self._responses = {c: [r for r in responses if r in case.mean] for c, case in nominal.cases.items()}
        self._parts: dict[tuple[str, str], list[FloatArray]] = {}

    def add(self, cars: Sequence[CurveSet]) -> None:
        """Curves of further cars."""
        for case, responses in self._responses.items():
            for response in responses:
                rows = np.array([c.cases[case].mean[response] for c in cars], dtype=np.float32)
                self._parts.setdefault((case, response), []).append(rows)  # type: ignore[arg-type]

    def bands(self) -> tuple[CurveBand, ...]:
        """Of every load case; none without cars."""
        if not self._parts:
            return ()
        return tuple(self._band(case) for case in self._nominal.cases)

    def _band(self, case: str) -> CurveBand:
        curves = self._nominal.cases[case]
        percentiles = {}
        for response in self._responses[case]:
            rows = np.concatenate(self._parts[case, response])
            percentiles[response] = np.percentile(rows, BAND_PERCENTILES, axis=0).astype(float)
        nominal = {r: curves.mean[r] for r in self._responses[case]}
        return CurveBand(case, curves.input_unit, curves.input, nominal, percentiles)
