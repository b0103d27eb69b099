"""What the calibration of the rig's inputs leaves open: one common scale of every load case's input.

All responses of a load case share it, which is why it is not among the errors of single curves. It is the
same number as the effect `rig_input_gain`, only of the size that a sound rig has: what is read at the input
u is of the true input (1 + g) u.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from doe_kc.axle.model import Axle
from doe_kc.discovery.thresholds import INPUT_GAIN
from doe_kc.ground.typing import FloatArray


def calibrated(axle: Axle, cases: Sequence[str], errors: FloatArray) -> Axle:
    """The axle, its load cases driven by their true inputs. errors: (k,) of `cases`, in INPUT_GAIN."""
    driven = {
        name: replace(axle.load_cases[name], gain=axle.load_cases[name].gain * (1.0 + INPUT_GAIN * float(e)))
        for name, e in zip(cases, errors, strict=True)
        if name in axle.load_cases
    }
    return replace(axle, load_cases={**axle.load_cases, **driven})
