"""Evaluated designs as training data: points, outputs (characteristics and curve scores), failures."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import qr, svd

from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.problem import Evaluated
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Targets

UNRESOLVED = 2e-3
"""RMS over Norm that the left-out principal components of a curve may have: a tenth of a rig's noise."""
SLOPE_STRETCH = 0.1
"""Change of a variable, share of its bounds, over which exact slopes of the curves are to be resolved."""
Slopes = tuple[FloatArray, FloatArray]


@dataclass(frozen=True)
class Archive:
    """Designs with an answer. points: (n, d). outputs: (n, k + q). composite: the rating of such outputs.

    middle, basis: (N,) and (q, N) of the curves' principal components.
    failed: (f, d) points without an answer. expansion: (k + q, d) exact slopes of the outputs at the best
    design, None without them.
    """

    solved: tuple[Evaluated, ...]
    points: FloatArray
    outputs: FloatArray
    composite: Composite
    failed: FloatArray
    expansion: FloatArray | None
    middle: FloatArray
    basis: FloatArray

    def outputs_of(self, answer: Evaluated) -> FloatArray:
        """(k + q,) of any answer, as `outputs`; ValueError for a failure."""
        if answer.score is None:
            raise ValueError("a failed design has no outputs")
        curves = answer.scaled if self.middle.size else self.middle
        return np.concatenate([answer.score.values, self.basis @ (curves - self.middle)])

    def slopes_of(self, slopes: Slopes) -> FloatArray:
        """(k + q, d) of slopes of the characteristics (k, d) and of the scaled curves (N, d)."""
        curves = slopes[1][: self.middle.size]
        return np.vstack([slopes[0], self.basis @ curves])

    @property
    def best(self) -> Evaluated:
        """The best rating, the earlier one of equals."""
        return max(self.solved, key=lambda e: e.merit)


def build_archive(targets: Targets, evaluated: Sequence[Evaluated], slopes: Slopes | None = None) -> Archive:
    """Archive of distinct designs; curves as scores of their principal components.

    slopes: exact ones of the characteristics (k, d) and of the scaled curves (N, d) at the best design.
    """
    solved = tuple(distinct([e for e in evaluated if e.score is not None]))
    dead = [e.point for e in evaluated if e.score is None]
    points = np.array([e.point for e in solved])
    values = np.array([e.score.values for e in solved if e.score is not None])
    scaled = np.array([e.scaled for e in solved])
    mean, basis = principal_axes(_seen(solved, scaled, slopes), targets)
    return Archive(
        solved,
        points,
        np.hstack([values, (scaled - mean) @ basis.T]),
        Composite(targets, mean, basis),
        np.array(dead).reshape(len(dead), points.shape[1]),
        None if slopes is None else np.vstack([slopes[0], basis @ slopes[1][: mean.size]]),
        mean,
        basis,
    )


def _seen(solved: Sequence[Evaluated], scaled: FloatArray, slopes: Slopes | None) -> FloatArray:
    """Curves that the components must resolve: those of the designs, and those that the slopes lead to."""
    if slopes is None:
        return scaled
    best = int(np.argmax([e.merit for e in solved]))
    curves = slopes[1][: scaled.shape[1]]  # none where an outside solver gives none and its twin does
    return np.vstack([scaled, scaled[best] + SLOPE_STRETCH * curves.T])


def distinct(evaluated: Sequence[Evaluated]) -> list[Evaluated]:
    """The first of each point: a surrogate cannot be fitted through one twice."""
    seen: dict[bytes, Evaluated] = {}
    for e in evaluated:
        seen.setdefault(np.round(e.point, 12).tobytes(), e)
    return list(seen.values())


def principal_axes(scaled: FloatArray, targets: Targets) -> tuple[FloatArray, FloatArray]:
    """Mean (N,) and basis (q, N) that leave every curve of every design within UNRESOLVED."""
    mean = scaled.mean(axis=0)
    if scaled.shape[1] == 0:
        return mean, np.zeros((0, 0))
    left = scaled - mean
    u, s = _left_vectors(left)
    kept = int((s > 1e-9 * max(s[0], 1e-300)).sum())
    scores = u.T @ left
    misses = _left_out(u, scores, targets.blocks)
    q = bisect_left(range(kept), True, key=lambda q: bool(misses[q] <= UNRESOLVED))
    return mean, scores[:q] / s[:q, None]


def _left_vectors(left: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Left singular vectors (m, r) and values (r,) of (m, N): those of its triangle, for N is the larger."""
    (triangle,) = qr(left.T, mode="r", overwrite_a=False, check_finite=False)
    u, s, _ = svd(triangle[: len(left)].T, full_matrices=False, lapack_driver="gesdd", check_finite=False)
    return u, s


def _left_out(u: FloatArray, scores: FloatArray, blocks: Sequence[slice]) -> FloatArray:
    """(r,) largest RMS of a curve in the components from q on: u[:, q:] scores[q:], one block a curve.

    Component by component from the last, by the products of the scores within each block: the curves
    themselves are much longer.
    """
    products = np.array([scores[:, block] @ scores[:, block].T for block in blocks])
    square = np.zeros((len(u), len(products)))
    out = np.zeros(len(scores))
    for q in reversed(range(len(scores))):
        cross = u[:, q + 1 :] @ products[:, q + 1 :, q].T
        square += u[:, q, None] * (2.0 * cross + u[:, q, None] * products[:, q, q])
        out[q] = np.sqrt(max(float(square.max(initial=0.0)), 0.0))
    return out
