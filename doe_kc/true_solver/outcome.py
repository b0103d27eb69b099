"""What one run of a true solver gives: curves and characteristics, or the reason why there are none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_all
from doe_kc.curves import CaseCurves, CurveBatch, CurveSet
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Outcome:
    """curves: None after a failure, or from a solver that gives characteristics alone.

    characteristics: (n_char,) in the order of the registry, in their units; nan where unknown or failed.
    reason: why the design failed, empty when it did not. seconds: wall time of the run.
    """

    curves: CurveSet | None
    characteristics: FloatArray
    reason: str
    seconds: float

    @property
    def failed(self) -> bool:
        """Whether the design has no result."""
        return bool(self.reason)

    def value(self, ident: str) -> float:
        """One characteristic by id, in its unit; nan when unknown."""
        return float(self.characteristics[list(CHARACTERISTICS).index(ident)])


def failure(reason: str, seconds: float = 0.0) -> Outcome:
    """A design without a result."""
    return Outcome(None, np.full(len(CHARACTERISTICS), np.nan), reason, seconds)


def from_curves(curves: CurveSet, windows: Mapping[str, float] | None, seconds: float) -> Outcome:
    """Curves and their characteristics; a failure when a number is not finite."""
    reason = fault(curves)
    if reason:
        return failure(reason, seconds)
    outcome = Outcome(curves, reduced(curves, windows), "", seconds)
    reason = _bad_characteristic(outcome)
    return failure(reason, seconds) if reason else outcome


def reduced(curves: CurveSet, windows: Mapping[str, float] | None) -> FloatArray:
    """(n_char,) characteristics of curves; nan where they say nothing, or a line has no slope."""
    with np.errstate(all="ignore"):
        return np.array(list(reduce_all(curves, windows).values()))


def checked(outcome: Outcome) -> Outcome:
    """The outcome, or a failure that names its first number that is not finite."""
    if outcome.failed:
        return replace(failure(outcome.reason, outcome.seconds), curves=outcome.curves)
    reason = fault(outcome.curves) if outcome.curves is not None else ""
    reason = reason or _bad_characteristic(outcome)
    return failure(reason, outcome.seconds) if reason else outcome


def fault(curves: CurveSet) -> str:
    """The first response that is not finite, in words; empty when all are."""
    for name, value in (curves.static or {}).items():
        if not np.isfinite(value).all():
            return f"response not finite: static {name}"
    cases = list(curves.cases.values())
    everything = [c.ravel() for case in cases for c in (*case.mean.values(), *case.half_width.values())]
    if not everything or np.isfinite(np.concatenate(everything)).all():
        return ""
    for case in cases:
        for response, curve in [*case.mean.items(), *case.half_width.items()]:
            if not np.isfinite(curve).all():
                return f"response not finite: load case {case.load_case}, {_place(case, response, curve)}"
    return ""


def _place(case: CaseCurves, response: str, curve: FloatArray) -> str:
    at = int(np.argmin(np.isfinite(curve).all(axis=0)))
    return f"{response} at input {case.input[at]:g} {case.input_unit}"


def _bad_characteristic(outcome: Outcome) -> str:
    values = dict(zip(CHARACTERISTICS.values(), outcome.characteristics, strict=True))
    for entry, value in values.items():
        if np.isinf(value) or (np.isnan(value) and outcome.curves and is_known(entry, outcome.curves)):
            return f"characteristic not finite: {entry.id}"
    return "" if np.isfinite(outcome.characteristics).any() else "no characteristic was given"


def is_known(entry: Characteristic, curves: CurveSet | CurveBatch) -> bool:
    """Whether the curves hold what a characteristic is read from."""
    if entry.kind == "static":
        return curves.static is not None and entry.response in curves.static
    case = curves.cases.get(entry.load_case)
    return case is not None and entry.response in case.mean
