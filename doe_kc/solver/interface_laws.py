"""Laws that could rule at an interface: the value of its probe from what it shows there."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.solver.probe import Kind, Probe

CLEARANCE_ROUNDING = 0.005
"""Share of a probe's largest response over which the sign of a clearance is rounded."""


@dataclass(frozen=True)
class Law:
    """Value h of a probe for amplitude 1, from its response v.

    kinds: probes that it applies to. unit: of the amplitude, with {unit} of the probe and {response} of its
    response. value: (v, largest |v|) -> h, elementwise; None for a law with memory (friction).
    """

    id: str
    words: str
    kinds: tuple[Kind, ...]
    unit: str
    value: Callable[[FloatArray, FloatArray], FloatArray] | None

    def amplitude_unit(self, probe: Probe) -> str:
        """Unit of its amplitude at a probe, e.g. mm/N."""
        return self.unit.format(unit=probe.unit, response=probe.response_unit)


def _rounded_sign(v: FloatArray, largest: FloatArray) -> FloatArray:
    corner = CLEARANCE_ROUNDING * np.where(largest > 0.0, largest, 1.0)
    return np.asarray(v / np.hypot(v, corner))


EITHER: tuple[Kind, ...] = ("dislocation", "force pair")
LAWS: Mapping[str, Law] = {
    law.id: law
    for law in (
        Law("compliance", "gives way in proportion to its load", ("dislocation",), "{unit}/{response}",
            lambda v, _: v),
        Law("offset", "is out of place, or preloaded", EITHER, "{unit}", lambda v, _: np.ones_like(v)),
        Law("clearance", "has play, or a preload that turns over", EITHER, "{unit}", _rounded_sign),
        Law("stiffness", "is held by a further spring", ("force pair",), "{unit}/{response}", lambda v, _: v),
        Law("progression", "stiffens with its deflection", ("force pair",), "{unit}/{response}^3",
            lambda v, _: v**3),
        Law("friction", "sticks", ("force pair",), "{unit}", None),
    )
}  # fmt: skip
"""By id."""


def stop_operator(paths: Sequence[FloatArray], presliding: FloatArray) -> list[FloatArray]:
    """Friction over its level, in [-1, 1], along consecutive paths (n_i, m).

    Dahl's law, exact over monotone steps, from zero at the first point. presliding: (m,), > 0.
    """
    out = []
    force, at = np.zeros_like(presliding), paths[0][0]
    for path in paths:
        rows = []
        for point in path:
            sign = np.where(point >= at, 1.0, -1.0)
            force = sign - (sign - force) * np.exp(-np.abs(point - at) / presliding)
            at = point
            rows.append(force)
        out.append(np.array(rows))
    return out
