"""What a load case is: an input swept over an interval, turned into controls of the axle."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from doe_kc.ground.typing import FloatArray

Controls = dict[str, float | FloatArray]
"""Control name -> one value for all steps or one a step; controls that are not named are zero.

pad_L, pad_R (mm), wc_z_L, wc_z_R (mm), preload (N), roll (rad), rack (mm), lateral_*, drive_*, brake_* (N),
lateral_offset (mm); switches 0/1: hold_wheel_centre, hold_load, hold_height, bilateral, load_case
(the solver's own: 1 in a load case, 0 at rest).
"""

REVERSAL_SHARES = (0.5, 0.2)
"""-, distances from the end of a loop of further inputs, in steps. With the first alone curves are as with
steps of half the size; the second serves frictions of short presliding."""


@dataclass(frozen=True)
class Datum:
    """What load cases take over from the axle: where its static state left it, and two of its dimensions.

    pad, wheel_centre_z: left and right, mm. preload: of the springs, N. half_track: |y| of the left design
    wheel centre, mm. rack_mm_per_rev: rack travel per steering-wheel turn, mm. Of d designs at once each is
    (d, 1), and controls become (d, n).
    """

    pad: tuple[float, float]
    wheel_centre_z: tuple[float, float]
    preload: float
    half_track: float
    rack_mm_per_rev: float


@dataclass(frozen=True)
class LoadCase(ABC):
    """A quasi-static sweep, 0 -> +amplitude and 0 -> -amplitude (a loop when friction is on).

    amplitude: largest input, in `unit`.
    steps: equilibria per branch from zero; a loop that is driven before the one that counts has as many from
        end to end.
    conditioning: loops with friction that are driven before the one that counts, so that it closes. A rig
        records a steady loop; with 0, the loop begins right after the first rise from the static state.
    gain: true input per input given, for a rig that applies another one than it says.
    """

    amplitude: float
    steps: int
    conditioning: int = field(default=0, kw_only=True)
    gain: float = field(default=1.0, kw_only=True)

    id: ClassVar[str]
    label: ClassVar[str]
    channel: ClassVar[str]
    unit: ClassVar[str]
    input_label: ClassVar[str]
    window: ClassVar[float]
    """Half-width of the default fit window, in `unit`."""

    def inputs(self) -> FloatArray:
        """(2 steps + 1,) inputs from -amplitude to +amplitude, 0 among them."""
        return np.linspace(-1.0, 1.0, 2 * self.steps + 1) * self.amplitude

    def loop_inputs(self) -> FloatArray:
        """(n,) inputs of either branch of a loop, rising: `inputs` and more within the last step of each end.

        Friction turns round within a fraction of a step, so that curves between the last two inputs are far
        from straight: without these a record's toe close to full lock was off by nine standard deviations.
        """
        grid = self.inputs()
        step = grid[-1] - grid[-2]
        ends = step * np.array(REVERSAL_SHARES)
        return np.concatenate([grid[:1], grid[0] + ends[::-1], grid[1:-1], grid[-1] - ends, grid[-1:]])

    def driven(self, value: FloatArray, static: Datum) -> Controls:
        """Controls of the axle at the inputs `value` (n,) as they are given, in `unit`."""
        return self.controls(self.gain * value, static)

    @abstractmethod
    def controls(self, value: FloatArray, static: Datum) -> Controls:
        """Controls of the axle at the true inputs `value` (n,), in `unit`."""


LOAD_CASES: dict[str, LoadCase] = {}
"""Default definition of each load case by id; roll by its default technique `body`."""


def load_case(case: LoadCase) -> LoadCase:
    """Register the default definition of a load case."""
    if case.id in LOAD_CASES:
        raise ValueError(f"load case {case.id} is registered twice")
    LOAD_CASES[case.id] = case
    return case


def held_pads(static: Datum) -> Controls:
    """Both pads at their static height."""
    return {"pad_L": static.pad[0], "pad_R": static.pad[1]}
