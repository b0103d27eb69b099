"""Evaluated designs as training data: points, outputs (characteristics and curve scores), failures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.composite import Composite
from doe_kc.correlation.problem import Evaluated
from doe_kc.targets import Targets
from doe_kc.typing import FloatArray

UNRESOLVED = 2e-3
"""RMS over Norm that the left-out principal components of a curve may have: a tenth of a rig's noise."""


@dataclass(frozen=True)
class Archive:
    """Designs with an answer. points: (n, d). outputs: (n, k + q). composite: the rating of such outputs.

    failed: (f, d) points without an answer.
    """

    solved: tuple[Evaluated, ...]
    points: FloatArray
    outputs: FloatArray
    composite: Composite
    failed: FloatArray

    @property
    def best(self) -> Evaluated:
        """The best rating, the earlier one of equals."""
        return max(self.solved, key=lambda e: e.merit)


def build_archive(targets: Targets, evaluated: Sequence[Evaluated]) -> Archive:
    """Archive of distinct designs; curves as scores of their principal components."""
    solved = tuple(distinct([e for e in evaluated if e.score is not None]))
    dead = [e.point for e in evaluated if e.score is None]
    points = np.array([e.point for e in solved])
    values = np.array([e.score.values for e in solved if e.score is not None])
    scaled = np.array([e.scaled for e in solved])
    mean, basis = principal_axes(scaled, targets)
    return Archive(
        solved,
        points,
        np.hstack([values, (scaled - mean) @ basis.T]),
        Composite(targets, mean, basis),
        np.array(dead).reshape(len(dead), points.shape[1]),
    )


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
    centred = scaled - mean
    u, s, basis = np.linalg.svd(centred, full_matrices=False)
    left = centred.copy()
    for q in range(len(s)):
        if all(np.linalg.norm(left[:, part], axis=1).max() <= UNRESOLVED for part in targets.blocks):
            return mean, basis[:q]
        left -= np.outer(u[:, q] * s[q], basis[q])
    return mean, basis[s > 1e-9 * max(s[0], 1e-300)]
