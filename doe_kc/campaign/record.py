"""One evaluation as it is kept: what a worker hands back, and the row around it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.campaign.curves_codec import pack, unpack
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.true_solver.outcome import Outcome, reduced


@dataclass(frozen=True)
class Packed:
    """An outcome that is small to send and to store.

    characteristics: id -> value of those that are known. curves: of `curves_codec.pack`. seconds: of the run.
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
    def status(self) -> str:
        """ok or failed."""
        return "failed" if self.packed.reason else "ok"


def packed_outcome(outcome: Outcome) -> Packed:
    """What to keep of an outcome."""
    pairs = zip(CHARACTERISTICS, map(float, outcome.characteristics), strict=True)
    known = {name: value for name, value in pairs if math.isfinite(value)}
    block = pack(outcome.curves) if outcome.curves is not None and not outcome.failed else None
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
    again = dict(record.windows) != dict(windows) or set(packed.characteristics) != set(CHARACTERISTICS)
    stored_curves = unpack(packed.curves) if packed.curves is not None and (curves or again) else None
    if stored_curves is not None and again:
        values = _reduced_again(stored_curves, windows, values)
    return Outcome(stored_curves if curves else None, values, "", packed.seconds)


def _reduced_again(curves: CurveSet, windows: Mapping[str, float], stored: FloatArray) -> FloatArray:
    values = reduced(curves, windows)
    return np.where(np.isnan(values), stored, values)
