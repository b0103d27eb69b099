"""Latin hypercube over the bounds: every parameter's range in n equal slices, each hit once.

Reference: M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21(2), 1979.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import qmc

from doe_kc.axle.parameters import Parameter
from doe_kc.sampling.design import Design


def latin_hypercube(parameters: Sequence[Parameter], n: int, *, seed: int, optimize: bool = False) -> Design:
    """n designs, uniform between the bounds; factors (0.5 ... 2) uniform in their logarithm.

    optimize: exchange coordinates for low centred discrepancy (slow beyond some hundred rows).
    """
    sampler = qmc.LatinHypercube(
        d=len(parameters),
        rng=np.random.default_rng(seed),
        optimization="random-cd" if optimize else None,
    )
    unit = sampler.random(n)
    columns = [_stretch(p, unit[:, i]) for i, p in enumerate(parameters)]
    return Design(
        "latin_hypercube",
        tuple(p.path for p in parameters),
        np.column_stack(columns),
        tuple(f"sample {i + 1}" for i in range(n)),
        seed,
    )


def _stretch(parameter: Parameter, unit: np.ndarray) -> np.ndarray:
    if parameter.unit == "-" and parameter.lower > 0:
        ratio = parameter.upper / parameter.lower
        return np.asarray(parameter.lower * ratio**unit)
    return np.asarray(parameter.lower + (parameter.upper - parameter.lower) * unit)
