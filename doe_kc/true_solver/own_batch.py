"""Outcomes of many designs of one topology, side by side from parameters to characteristics."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import ParameterMap
from doe_kc.axle.topology import Topology
from doe_kc.characteristics import CHARACTERISTICS, reduce_batch
from doe_kc.curves import CurveBatch
from doe_kc.effects import EFFECTS, observed
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.batch_library import adaptive_batch
from doe_kc.solver.batch_suite import solve_batch
from doe_kc.solver.curve_set import curve_batch
from doe_kc.solver.library import CompileError
from doe_kc.true_solver.outcome import Outcome, from_curves, is_known


def can_batch(topology: Topology) -> bool:
    """Whether designs of a topology can be solved side by side here; makes what that needs."""
    try:
        adaptive_batch(topology)
    except CompileError:
        return False
    return True


def batch_outcomes(
    axle: Axle,
    topology: Topology,
    parameters: ParameterMap,
    values: FloatArray,
    windows: Mapping[str, float],
    *,
    curves: bool,
) -> Sequence[Outcome | None]:
    """Of each row of the values (d, paths of `parameters`), all of one topology; None where `suite.solve` has
    to find out. curves: whether outcomes hold them. InputError for a value that no axle can have.
    """
    started = time.perf_counter()
    changes = parameters.changes(values) or {"ride_height": np.full(len(values), axle.values["ride_height"])}
    try:
        solution = solve_batch(replace(axle, topology=topology), changes, adaptive_batch(topology))
    except np.linalg.LinAlgError:  # the axle itself is singular, others of its topology need not be
        return [None] * len(values)
    known = curve_batch(solution)
    if any(EFFECTS[ident].on_rig for ident in axle.effects):
        return _observed(axle, known, solution.failed, windows, started, curves=curves)
    with np.errstate(all="ignore"):
        characteristics = reduce_batch(known, windows)
    sound = ~solution.failed & _sound(known, characteristics)
    seconds = (time.perf_counter() - started) / len(values)
    return [
        Outcome(known.design(i) if curves else None, characteristics[i], "", seconds) if sound[i] else None
        for i in range(len(values))
    ]


def _observed(
    axle: Axle,
    known: CurveBatch,
    failed: np.ndarray,
    windows: Mapping[str, float],
    started: float,
    *,
    curves: bool,
) -> Sequence[Outcome | None]:
    """What a rig with faults reads of each design."""
    seconds = (time.perf_counter() - started) / len(failed)
    out: list[Outcome | None] = []
    for i, without in enumerate(failed):
        outcome = None if without else from_curves(observed(axle, known.design(i)), windows, seconds)
        if outcome is None or outcome.failed:
            out.append(None)
        else:
            out.append(outcome if curves else replace(outcome, curves=None))
    return out


def _sound(known: CurveBatch, characteristics: FloatArray) -> np.ndarray:
    """(d,) whether every number is finite that should be one."""
    out = np.ones(len(characteristics), dtype=bool)
    for angles in known.static.values():
        out &= np.isfinite(angles).all(axis=0)
    for case in known.cases.values():
        for curve in (*case.mean.values(), *case.half_width.values()):
            out &= np.isfinite(curve).all(axis=(0, 2))
    there = np.array([is_known(entry, known) for entry in CHARACTERISTICS.values()])
    return np.asarray(
        out
        & np.isfinite(characteristics[:, there]).all(axis=1)
        & ~np.isinf(characteristics).any(axis=1)
        & there.any()
    )
