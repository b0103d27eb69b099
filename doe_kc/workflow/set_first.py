"""What is set from the records before a correlation: ride height and static angles (thesis, 6.3.1, 6.3.4)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from doe_kc.correlation.loop import Evaluate
from doe_kc.ground.errors import InputError, RunError
from doe_kc.measurement import RideHeight
from doe_kc.study import Study
from doe_kc.workflow.measure import Reduced

STATIC_CORRECTIONS = 4
"""Newton steps at most; of slope 1, which is nearly the axle's, so that each leaves little of the miss."""
ANGLE_TOLERANCE = 1e-4
"""deg: a static angle that near to the measured one is set."""


def set_first(
    study: Study, reduced: Reduced | None, evaluate: Evaluate
) -> tuple[dict[str, float], tuple[str, ...]]:
    """Path -> absolute value of the parameters in `correlation.set_first`, and what was done, in sentences.

    The angles are set so that the solved static state shows the measured ones, the mean of both wheels.
    InputError when the records do not tell.
    """
    wanted = study.correlation.set_first
    if not wanted:
        return {}, ()
    if reduced is None:
        raise InputError(
            f"{study.source}: correlation.set_first needs a measurement; name one or drop the key."
        )
    values: dict[str, float] = {}
    sentences: list[str] = []
    if "ride_height" in wanted:
        height = _ride_height(study, reduced)
        values["ride_height"] = study.axle.values["ride_height"] + height.estimate
        sentences.append(
            f"ride_height set to {values['ride_height']:.2f} mm: the records lie {height.estimate:.2f} "
            f"+- {height.sd:.2f} mm above the axle file"
        )
    angles: dict[str, float] = {
        path: _angle(study, reduced, path) for path in wanted if path.startswith("static.")
    }
    if angles:
        values, seen = _aligned(study, values, angles, evaluate)
        sentences += [
            f"{path} set to {values[path]:.4f} deg, so that the static {path.removeprefix('static.')} is the "
            f"measured {angles[path]:.4f} deg (it was {seen[path]:.4f} deg)"
            for path in angles
        ]
    return values, tuple(sentences)


def _ride_height(study: Study, reduced: Reduced) -> RideHeight:
    if reduced.ride_height is None:
        raise InputError(
            f"{study.source}: correlation.set_first: ride_height needs a record of vertical motion; add it "
            "or drop the entry."
        )
    return reduced.ride_height


def _angle(study: Study, reduced: Reduced, path: str) -> float:
    static = reduced.measurement.curves.static or {}
    sides = static.get(path.removeprefix("static."))
    if sides is None or not np.isfinite(sides).any():
        raise InputError(
            f"{study.source}: correlation.set_first: {path} needs [alignment] in the records' test.toml; add "
            "it or drop the entry."
        )
    return float(np.nanmean(sides))


def _aligned(
    study: Study, values: Mapping[str, float], angles: Mapping[str, float], evaluate: Evaluate
) -> tuple[dict[str, float], dict[str, float]]:
    """Design angles by Newton steps of slope 1, and the static angles of the first round."""
    out = {**values, **{path: study.axle.values[f"{path}@L"] for path in angles}}
    first: dict[str, float] = {}
    for _ in range(STATIC_CORRECTIONS):
        seen = _static(evaluate, out, list(angles))
        first = first or seen
        miss = {path: angles[path] - seen[path] for path in angles}
        if max(abs(m) for m in miss.values()) < ANGLE_TOLERANCE:
            break
        out |= {path: out[path] + m for path, m in miss.items()}
    return out, first


def _static(evaluate: Evaluate, values: Mapping[str, float], paths: Sequence[str]) -> dict[str, float]:
    (outcome,) = evaluate([values])
    if outcome.failed or outcome.curves is None or outcome.curves.static is None:
        raise RunError(f"the static angles cannot be set: {outcome.reason or 'the solver gives none'}.")
    return {p: float(np.mean(outcome.curves.static[p.removeprefix("static.")])) for p in paths}
