"""The three words for whether something can be used: an axle, or the twin of an outside model."""

from __future__ import annotations

from typing import Literal

Status = Literal["sound", "doubtful", "not_usable"]
STATUS_LABELS: dict[Status, str] = {
    "sound": "Sound",
    "doubtful": "Doubtful",
    "not_usable": "Not usable",
}
