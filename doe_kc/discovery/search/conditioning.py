"""Loops before the record, as a rig drives them until they close: one or none, as the records ask for."""

from __future__ import annotations

from dataclasses import replace

from doe_kc.axle.model import Axle
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.thresholds import (
    LOOP_EVIDENCE,
    LOOPS_SURE,
)
from doe_kc.discovery.workers import DiscoveryWorkers


def with_conditioning(current: Fit, own: Axle, workers: DiscoveryWorkers) -> tuple[Fit, bool]:
    """The fit with one loop before the record or with none, as the records with friction ask for, and whether
    they are sure of it.

    A rig runs until loops close; a simulated record may begin right after the first rise. Nothing in the
    files tells. Effects are looked for beside the better of the two. own: the axle as given, whose load cases
    stand where no friction is left, and loops change nothing.
    """
    model = current.model
    if not model.with_effects(current.z).topology.frictional:
        return own_loops(current, own), False
    other = replace(model, axle=model.axle.conditioned(0 if model.axle.conditioning else 1))
    (refit,) = workers.fits([FitStart(other, current.z, current)], "loops before the record")
    if refit is None:
        return current, False
    gain = refit.evidence - current.evidence
    return (refit if gain >= LOOP_EVIDENCE else current), abs(gain) > LOOPS_SURE


def own_loops(current: Fit, own: Axle) -> Fit:
    """The fit, its load cases those of the axle as given where no friction is left."""
    model = current.model
    if model.with_effects(current.z).topology.frictional:
        return current
    axle = replace(model.axle, load_cases=own.load_cases)
    return replace(current, model=replace(model, axle=axle))
