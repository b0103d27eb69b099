"""K&C characteristics: the figures that an axle is judged by, simulated and measured alike."""

from __future__ import annotations

from doe_kc.characteristics.of_axle import characteristics_of
from doe_kc.characteristics.reduction import reduce_all, reduce_batch, reduce_one, reduction_gradient
from doe_kc.characteristics.registry import CHARACTERISTICS, Characteristic, appendix_c

__all__ = [
    "CHARACTERISTICS",
    "Characteristic",
    "appendix_c",
    "characteristics_of",
    "reduce_all",
    "reduce_batch",
    "reduce_one",
    "reduction_gradient",
]
