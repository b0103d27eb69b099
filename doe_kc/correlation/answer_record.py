"""What a chain says beside its correlation, kept in the record of the run so that its answer can be written
again."""

from __future__ import annotations

from typing import Any

from doe_kc.ground.fields import Strict


class GapRecord(Strict):
    """Whitened RMS of all records' deviations, both branches of every loop; 1 is noise.

    nominal: of the axle handed in. tuned: re-tuned without an effect; None without a discovery. final: of the
    axle handed over. noise_floor: what noise alone leaves.
    """

    nominal: float
    tuned: float | None
    final: float
    noise_floor: float


class AnswerRecord(Strict):
    """verdict: of the discovery; None without one. effects: named, or adopted, as in summary.json.

    added: each adopted effect in words, with its sizes. gap: None where it is not known of the axle handed
    over. seconds: of the whole run.
    """

    verdict: str | None
    effects: list[dict[str, Any]]
    added: list[str]
    gap: GapRecord | None
    seconds: float
