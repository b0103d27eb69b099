"""Manifold mapping: a cheap model's answers turned and shifted onto those of the model that is searched.

m(x) = f(x_b) + S (c(x) - c(x_b)) with S = dF dC+ + I - U U': what the designs so far say of how both models
change, and the cheap model's own change where they say nothing. f: the outside model, c: its twin, x_b the
best design, rows of dF and dC the differences from it, U the left singular vectors of dC.
Reference: D. Echeverría, P. W. Hemker, Space mapping and defect correction, Comput. Methods Appl. Math. 5(2),
2005; Manifold mapping: a two-level optimization technique, Comput. Vis. Sci. 11, 2008.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray

RESOLVED_CHANGE = 1e-3
"""Share of the largest change below which a direction of change is not told from rounding."""


@dataclass(frozen=True)
class ManifoldMapping:
    """value, cheap: (m,) answers of both models at the best design. matrix: (m, m) S."""

    value: FloatArray
    cheap: FloatArray
    matrix: FloatArray

    @classmethod
    def of(
        cls, outputs: FloatArray, cheap_outputs: FloatArray, best: int, scale: FloatArray
    ) -> ManifoldMapping:
        """From answers of both models (n, m) to the same designs. scale: (m,) unit of each output, in which
        changes are compared."""
        others = np.arange(len(outputs)) != best
        changes = ((outputs - outputs[best])[others] / scale).T
        own = ((cheap_outputs - cheap_outputs[best])[others] / scale).T
        matrix = np.eye(scale.size)
        if others.any():
            u, s, v = np.linalg.svd(own, full_matrices=False)
            kept = s > RESOLVED_CHANGE * s[0]
            u, s, v = u[:, kept], s[kept], v[kept]
            matrix = (changes @ v.T / s) @ u.T + matrix - u @ u.T
        return cls(outputs[best], cheap_outputs[best], scale[:, None] * matrix / scale)

    def at(self, cheap: FloatArray) -> FloatArray:
        """(m,) what the searched model is expected to answer where its twin answers `cheap` (m,)."""
        return np.asarray(self.value + self.matrix @ (cheap - self.cheap))
