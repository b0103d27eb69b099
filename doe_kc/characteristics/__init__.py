"""K&C characteristics: the figures that an axle is judged by, simulated and measured alike."""

from __future__ import annotations

import sys

from doe_kc.characteristics._base import CHARACTERISTICS, Characteristic, appendix_c
from doe_kc.characteristics.reduction import reduce_all, reduce_one, reduction_gradient
from doe_kc.ground.registry import import_members

import_members(sys.modules[__name__])

__all__ = [
    "CHARACTERISTICS",
    "Characteristic",
    "appendix_c",
    "reduce_all",
    "reduce_one",
    "reduction_gradient",
]
