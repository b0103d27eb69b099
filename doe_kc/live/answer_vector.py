"""The answers of an outside model as vectors of one length, which surrogates and their slopes are of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import ANGLES, SIDES, CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import CurveGradients
from doe_kc.true_solver.outcome import Outcome, reduced

REDUCTION_STEP = 1e-3
"""Of a variable's range: difference by which characteristics are derived from the slopes of curves."""


@dataclass(frozen=True)
class CurveBlock:
    """One curve of both wheels in a vector. half: of the loop's half-width. place: of its 2 n numbers."""

    load_case: str
    response: str
    half: bool
    place: slice


@dataclass(frozen=True)
class AnswerVector:
    """pattern: an answer whose load cases, responses and inputs the vectors have. rows: places in the
    registry of the characteristics that the outside model tells beside its curves.

    A vector (N,) holds mean curves and half-widths (left, right), static angles, those characteristics.
    """

    pattern: CurveSet
    rows: tuple[int, ...]

    @cached_property
    def blocks(self) -> tuple[CurveBlock, ...]:
        """Of the curves, in their order."""
        out, at = [], 0
        for case in self.pattern.cases.values():
            for half in (False, True):
                for response in case.mean:
                    end = at + 2 * case.input.size
                    out.append(CurveBlock(case.load_case, response, half, slice(at, end)))
                    at = end
        return tuple(out)

    @property
    def angles(self) -> tuple[str, ...]:
        """Static angles that are told."""
        static = self.pattern.static or {}
        return tuple(a for a in ANGLES if a in static)

    @property
    def told(self) -> set[tuple[str, str]]:
        """(load case, response) of what the vectors hold; of a static angle (static, angle)."""
        return {(b.load_case, b.response) for b in self.blocks} | {("static", a) for a in self.angles}

    def fits(self, outcome: Outcome) -> bool:
        """Whether an answer has everything that the vectors hold."""
        curves = outcome.curves
        if outcome.failed or curves is None or not set(self.angles) <= set(curves.static or {}):
            return False
        for ident, case in self.pattern.cases.items():
            if ident not in curves.cases or not set(case.mean) <= set(curves.cases[ident].mean):
                return False
        return bool(np.isfinite(outcome.characteristics[list(self.rows)]).all())

    def of(self, outcome: Outcome) -> FloatArray:
        """(N,) of an answer that `fits`; a characteristic that is not known counts as 0."""
        curves = outcome.curves
        assert curves is not None
        parts = [
            _onto(self.pattern.cases[b.load_case], curves.cases[b.load_case], b).ravel() for b in self.blocks
        ]
        parts += [np.asarray((curves.static or {})[a]) for a in self.angles]
        return np.concatenate([*parts, np.nan_to_num(outcome.characteristics[list(self.rows)])])

    def outcome(self, vector: FloatArray, windows: Mapping[str, float], half_track: float) -> Outcome:
        """The answer that a vector stands for, its characteristics reduced with `windows`."""
        curves = self._curves(vector, half_track)
        characteristics = reduced(curves, windows)
        told = vector[len(vector) - len(self.rows) :]
        if self.rows:
            rows = list(self.rows)
            characteristics[rows] = np.where(np.isnan(characteristics[rows]), told, characteristics[rows])
        return Outcome(curves, characteristics, "", 0.0)

    def _curves(self, vector: FloatArray, half_track: float) -> CurveSet:
        mean: dict[str, dict[str, FloatArray]] = {c: {} for c in self.pattern.cases}
        half: dict[str, dict[str, FloatArray]] = {c: {} for c in self.pattern.cases}
        for b in self.blocks:
            (half if b.half else mean)[b.load_case][b.response] = vector[b.place].reshape(len(SIDES), -1)
        cases = {
            ident: CaseCurves(ident, c.input_unit, c.input, mean[ident], half[ident])
            for ident, c in self.pattern.cases.items()
        }
        static = {a: vector[place] for a, place in self._static_places()}
        return CurveSet(self.pattern.source, cases, static or None, half_track)

    def _static_places(self) -> Iterator[tuple[str, slice]]:
        at = self.blocks[-1].place.stop
        for angle in self.angles:
            yield angle, slice(at, at + 2)
            at += 2

    def gradients(self, slopes: FloatArray, paths: tuple[str, ...]) -> CurveGradients:
        """Curves of the slopes (N, d) to d variables."""
        mean: dict[str, dict[str, FloatArray]] = {c: {} for c in self.pattern.cases}
        half: dict[str, dict[str, FloatArray]] = {c: {} for c in self.pattern.cases}
        for b in self.blocks:
            rows = slopes[b.place].reshape(len(SIDES), -1, slopes.shape[1])
            (half if b.half else mean)[b.load_case][b.response] = rows
        inputs = {ident: c.input for ident, c in self.pattern.cases.items()}
        static = {a: slopes[place] for a, place in self._static_places()}
        return CurveGradients(paths, inputs, mean, static, half)

    def characteristic_slopes(
        self, vector: FloatArray, slopes: FloatArray, windows: Mapping[str, float], half_track: float
    ) -> FloatArray:
        """(all registered, d) by central differences of the reduction along the slopes."""
        out = np.zeros((len(CHARACTERISTICS), slopes.shape[1]))
        for j, slope in enumerate(slopes.T):
            ends = [
                self.outcome(vector + sign * REDUCTION_STEP * slope, windows, half_track).characteristics
                for sign in (1.0, -1.0)
            ]
            out[:, j] = (ends[0] - ends[1]) / (2.0 * REDUCTION_STEP)
        return out


def _onto(pattern: CaseCurves, case: CaseCurves, block: CurveBlock) -> FloatArray:
    """(2, n) of a curve at the pattern's inputs, linear between its points."""
    rows = (case.half_width if block.half else case.mean)[block.response]
    if case.input.size == pattern.input.size and np.array_equal(case.input, pattern.input):
        return rows
    return np.array([np.interp(pattern.input, case.input, row) for row in rows])
