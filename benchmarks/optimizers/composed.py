"""The rating (equation 2.2) of modelled outputs in torch, written apart from the product's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from doe_kc.correlation.problem import Evaluated
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Targets

SCORES = 14
RESOLVED = 1e-4
"""Principal components kept: at most so many, with at least this share of the largest singular value."""


@dataclass(frozen=True)
class Composed:
    """Called with outputs (..., k + q): active characteristics, then scores of the curves. Torch tensors.

    Per characteristic (k,): value, low, high, weights over norms. Per curve (c,): |r + B s|^2 as
    square + 2 push.s + s'gram s.
    """

    value: Any
    objective: Any
    low: Any
    high: Any
    linear: Any
    quadratic: Any
    curve: Any
    square: Any
    push: Any
    gram: Any

    def __call__(self, outputs: Any) -> Any:
        """(...) the rating."""
        import torch

        k = len(self.value)
        y, s = outputs[..., :k], outputs[..., k:]
        violation = (self.low - y).clamp_min(0.0) + (y - self.high).clamp_min(0.0)
        scalar = (y - self.value).abs() @ self.objective
        penalty = violation @ self.linear + violation.square() @ self.quadratic
        bent = torch.einsum("...q,cqr,...r->...c", s, self.gram, s)
        square = (self.square + 2.0 * s @ self.push.T + bent).clamp_min(1e-12)
        return -scalar - penalty - square.sqrt() @ self.curve


def outputs_of(targets: Targets, known: Sequence[Evaluated]) -> tuple[FloatArray, Composed]:
    """(n, k + q) outputs of solved designs, and the rating of such outputs.

    Only for objectives "target" without QuadWt, as `build_targets` makes them from records.
    """
    import torch

    active = [t for t in targets.characteristics if t.active]
    values = np.array([e.score.values[targets.active] for e in known if e.score is not None])
    scaled = np.array([e.scaled for e in known])
    mean = scaled.mean(axis=0)
    _, size, axes = np.linalg.svd(scaled - mean, full_matrices=False)
    basis = axes[: min(SCORES, int((size > RESOLVED * size[0]).sum()))]
    rest = mean - targets.scaled_targets
    blocks = [(rest[b], basis[:, b]) for b in targets.blocks]
    limits = [t.constraint for t in active]

    def tensor(rows: Sequence[Any]) -> Any:
        return torch.as_tensor(np.array(rows, dtype=float))

    composed = Composed(
        value=tensor([t.value for t in active]),
        objective=tensor(
            [0.0 if t.objective is None else t.objective.linear / t.objective.norm for t in active]
        ),
        low=tensor([-1e9 if c is None else c.low for c in limits]),
        high=tensor([1e9 if c is None else c.high for c in limits]),
        linear=tensor([0.0 if c is None else c.linear / c.norm for c in limits]),
        quadratic=tensor([0.0 if c is None else c.quadratic / c.norm**2 for c in limits]),
        curve=tensor([t.objective.linear for t in targets.curves]),
        square=tensor([r @ r for r, _ in blocks]),
        push=tensor([b @ r for r, b in blocks]),
        gram=tensor([b @ b.T for _, b in blocks]),
    )
    return np.hstack([values, (scaled - mean) @ basis.T]), composed
