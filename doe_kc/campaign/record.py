"""One evaluation: its name in the store, its run in whatever process, and what is kept of it."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Literal

import numpy as np

from doe_kc.campaign.curves_codec import pack, pack_fit, unpack
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import CurveSet
from doe_kc.ground.errors import DoeKcError, InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged
from doe_kc.true_solver.outcome import Outcome, checked, failure, reduced
from doe_kc.true_solver.protocol import BatchSolver, TrueSolver, Values

StoredCurves = Literal["all", "fit", "none"]
"""What is kept of the curves of an evaluation: all bits, a fit (see `curve_fit`), or nothing."""
LEFT_OUT = b""
"""In place of curves that were not to be kept."""
REGISTERED = frozenset(CHARACTERISTICS)
KEY_DIGITS = 12
"""Significant digits that tell two designs apart: 0.1 + 0.2 is 0.3."""


def rounded(value: float) -> float:
    """The value with twelve significant digits; -0 is 0."""
    return float(f"{value:.{KEY_DIGITS}g}") + 0.0


def design_key(values: Mapping[str, float]) -> str:
    """SHA-256 of the sorted path/value pairs in JSON, 64 hex digits; InputError for one not finite."""
    for path, value in values.items():
        if not math.isfinite(value):
            raise InputError(f"design: {path} = {value}, expected a finite number.")
    pairs = [f'[{_quoted(path)}, "{rounded(value)!r}"]' for path, value in sorted(values.items())]
    return hashlib.sha256(f"[{', '.join(pairs)}]".encode()).hexdigest()


@lru_cache(maxsize=4096)
def _quoted(path: str) -> str:
    """A path as JSON."""
    return json.dumps(path)


def run_one(solver: TrueSolver, values: Values, *, kept: StoredCurves = "all") -> Packed:
    """One design, packed. InputError, RunError and MemoryError end the campaign, all else is a failure."""
    try:
        outcome = checked(solver.evaluate(values))
    except NotConverged as error:
        outcome = failure(str(error))
    except (DoeKcError, MemoryError):
        raise
    except Exception as error:  # whatever an outside solver trips over
        outcome = failure(f"{solver.name} raised {type(error).__name__}: {error}")
    return packed_outcome(outcome, kept=kept)


@dataclass(frozen=True)
class BatchResult:
    """packed: of the designs of a batch, in order, up to the one that ended the campaign by `error`.

    fault: why they could not be solved at once although none of them is bad input; empty where they could.
    """

    packed: tuple[Packed, ...]
    error: DoeKcError | None = None
    fault: str = ""


def run_batch(solver: TrueSolver, kept: StoredCurves, designs: Sequence[Values]) -> BatchResult:
    """Designs at once or one after the other; the failure of one is a value and leaves the others alone."""
    fault = ""
    if isinstance(solver, BatchSolver) and len(designs) > 1:
        try:
            return BatchResult(tuple(_run_together(solver, kept, designs)))
        except DoeKcError:
            pass  # whose design it is, and what becomes of it, is found out one by one
        except Exception as error:
            fault = f"{type(error).__name__}: {error}"
    done: list[Packed] = []
    for values in designs:
        try:
            packed = run_one(solver, values, kept=kept)
        except DoeKcError as error:
            return BatchResult(tuple(done), error, fault)
        done.append(packed)
    return BatchResult(tuple(done), fault=fault)


def _run_together(solver: BatchSolver, kept: StoredCurves, designs: Sequence[Values]) -> list[Packed]:
    outcomes = solver.evaluate_all(designs, curves=kept != "none")
    packed = [packed_outcome(outcome, kept=kept) for outcome in outcomes]
    if kept != "none" or not solver.curves:
        return packed
    return [each if each.reason else replace(each, curves=LEFT_OUT) for each in packed]


def task_for(solver: TrueSolver, *, kept: StoredCurves = "all") -> Task:
    """What to submit to an executor for each batch of designs."""
    return partial(run_batch, solver, kept)


@dataclass(frozen=True)
class Packed:
    """An outcome that is small to send and to store.

    characteristics: id -> value of those that are known. curves: of `curves_codec`, `LEFT_OUT`, or None from
    a solver that gives none. seconds: of the run.
    """

    reason: str
    characteristics: Mapping[str, float]
    curves: bytes | None
    seconds: float


@dataclass(frozen=True, kw_only=True)
class StoredEvaluation:
    """One row of the store.

    parameters: path -> absolute value. windows: fit windows that `packed.characteristics` were reduced
    with. origin: which campaign asked first. created: UTC, ISO 8601. versions: of package, Python, solver.
    """

    key: str
    parameters: Mapping[str, float]
    packed: Packed
    windows: Mapping[str, float]
    origin: str
    created: str
    versions: Mapping[str, str]

    @property
    def curves_left_out(self) -> bool:
        """Whether the run had curves that were not to be kept."""
        return self.packed.curves == LEFT_OUT

    @property
    def status(self) -> str:
        """ok or failed."""
        return "failed" if self.packed.reason else "ok"


Task = Callable[[Sequence[Values]], BatchResult]


def packed_outcome(outcome: Outcome, *, kept: StoredCurves = "all") -> Packed:
    """What to keep of an outcome."""
    pairs = zip(CHARACTERISTICS, map(float, outcome.characteristics), strict=True)
    known = {name: value for name, value in pairs if math.isfinite(value)}
    block = None
    if outcome.curves is not None and not outcome.failed:
        block = LEFT_OUT if kept == "none" else (pack if kept == "all" else pack_fit)(outcome.curves)
    return Packed(outcome.reason, known, block, outcome.seconds)


def outcome_of(record: StoredEvaluation, windows: Mapping[str, float], *, curves: bool = True) -> Outcome:
    """The outcome of a record, its characteristics reduced with `windows`.

    Curves are reduced again when the windows are others or a characteristic is new; without curves the
    characteristics stay as they were given. curves: whether the outcome shall hold them.
    """
    packed = record.packed
    values = np.array([packed.characteristics.get(name, math.nan) for name in CHARACTERISTICS])
    if packed.reason:
        return Outcome(None, values * math.nan, packed.reason, packed.seconds)
    again = is_to_reduce_again(record, windows)
    stored_curves = unpack(packed.curves) if packed.curves and (curves or again) else None
    if stored_curves is not None and again:
        values = _reduced_again(stored_curves, windows, values)
    return Outcome(stored_curves if curves else None, values, "", packed.seconds)


def is_to_reduce_again(record: StoredEvaluation, windows: Mapping[str, float]) -> bool:
    """Whether `outcome_of` needs the curves of a record: other windows, or characteristics that it lacks."""
    return dict(record.windows) != dict(windows) or record.packed.characteristics.keys() != REGISTERED


def _reduced_again(curves: CurveSet, windows: Mapping[str, float], stored: FloatArray) -> FloatArray:
    values = reduced(curves, windows)
    return np.where(np.isnan(values), stored, values)
