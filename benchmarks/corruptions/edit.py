"""A corruption, and the frames of records that it edits."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import pandas as pd

Frames = dict[str, pd.DataFrame]
Edit = Callable[[Frames], None]
INPUTS = {
    "vertical": "pad_z [mm]",
    "roll": "roll [deg]",
    "lateral": "force_y [N]",
    "lateral_opposite": "force_y [N]",
    "lateral_offset": "force_y [N]",
    "drive": "force_x [N]",
    "brake": "force_x [N]",
    "steer": "steering_wheel [deg]",
}
UNITS = {"toe": "deg", "camber": "deg", "caster": "deg", "tyre_load": "N"}
ALL = ("toe", "camber", "caster", "wc_x", "wc_y", "wc_z", "tyre_load")
"""Quantities of a wheel."""


@dataclass(frozen=True)
class Corruption:
    """name: what was done. kinds: of finding, any of them is right. channel: glob of the finding's channel.
    edit: of the frames by file name (`vertical`, `vertical_repeat1`). text: of test.toml."""

    name: str
    kinds: tuple[str, ...]
    channel: str
    edit: Edit | None = None
    text: Callable[[str], str] | None = None
    case: str = "*"


def column(quantity: str, side: str) -> str:
    """Heading of a wheel's channel."""
    return f"{quantity}_{side} [{UNITS.get(quantity, 'mm')}]"


def of_case(frames: Frames, case: str | None) -> Iterator[pd.DataFrame]:
    """All runs of a load case, or of all."""
    for name, frame in frames.items():
        if case is None or name.split("_repeat")[0] == case:
            yield frame
