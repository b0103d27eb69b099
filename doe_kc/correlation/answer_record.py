"""What a chain says beside its correlation, kept in the record of the run so that its answer can be written
again."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from doe_kc.ground.fields import Strict


class CaseGap(Strict):
    """Whitened RMS of one load case's deviations: of the axle handed in, and of the one handed over."""

    nominal: float
    final: float


class GapRecord(Strict):
    """Whitened RMS of all records' deviations, both branches of every loop; 1 is noise.

    nominal: of the axle handed in. tuned: re-tuned without an effect; None without a discovery. final: of the
    axle handed over. noise_floor: what noise alone leaves. cases: of each load case, `static` for the static
    angles.
    """

    nominal: float
    tuned: float | None
    final: float
    noise_floor: float
    cases: dict[str, CaseGap] = Field(default_factory=dict)


class EffectWords(Strict):
    """One effect as an engineer reads it.

    label: name and place. kind: found, most likely, lead only or trace. sizes: its numbers with standard
    deviation and unit. sure: how sure it is. physics: what happens in the car. rivals: what it could be
    instead, empty for nothing. confirm: the test that would show it. adopted: whether the axle handed over
    has it; None where nothing was adopted yet.
    """

    label: str
    kind: str
    sizes: list[str]
    sure: str
    physics: str
    rivals: str
    confirm: str
    adopted: bool | None = None


class AnswerRecord(Strict):
    """verdict: of the discovery; None without one. effects: named, or adopted, as in summary.json.

    added: each adopted effect in words, with its sizes. gap: None where it is not known of the axle handed
    over. seconds: of the whole run. sentence: what the model lacked, in one; empty without a discovery.
    words: every effect named, adopted or leading.
    """

    verdict: str | None
    effects: list[dict[str, Any]]
    added: list[str]
    gap: GapRecord | None
    seconds: float
    sentence: str = ""
    words: list[EffectWords] = Field(default_factory=list)
