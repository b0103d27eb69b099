"""The surrogates of SMT, silenced and typed: trained there, read out as plain arrays, evaluated here.

Only training is left to SMT: its predictions build arrays of points x rows x variables, and its gradients
repeat all work for each variable.
Reference: M. A. Bouhlel et al., Advances in Engineering Software 135, 2019.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class RadialFit:
    """matrix: (n + k, n + k) of the interpolation. solution: (n + k, m), n weights and k tail terms."""

    matrix: FloatArray
    solution: FloatArray


def train_kriging(x: FloatArray, y: FloatArray, *, starts: int, seed: int) -> FloatArray:
    """(d,) rates theta of exp(-sum theta_k dx_k²) from KRG with constant trend; y: (n,)."""
    model = _trained(_library().KRG(n_start=starts, seed=seed, print_global=False), x, y[:, None])
    return np.array(model.optimal_theta / model.X_scale**2)


def train_kpls(x: FloatArray, y: FloatArray, *, components: int, starts: int, seed: int) -> FloatArray:
    """(d,) rates theta from KPLS with constant trend: those of its few components, spread over variables."""
    model = _trained(
        _library().KPLS(n_comp=components, n_start=starts, seed=seed, print_global=False), x, y[:, None]
    )
    return np.array((model.coeff_pls**2 @ model.optimal_theta) / model.X_scale**2)


def train_rbf(x: FloatArray, y: FloatArray, *, width: float, linear_tail: bool) -> RadialFit:
    """Gaussian radial functions exp(-|dx|² / width²) with a constant or linear tail; y: (n, m)."""
    model = _trained(_library().RBF(d0=width, poly_degree=int(linear_tail), print_global=False), x, y)
    return RadialFit(np.array(model.mtx), np.array(model.sol))


def _library() -> Any:
    """Imported when needed: it takes a second, and ships no types."""
    return import_module("smt.surrogate_models")


def _trained(model: Any, x: FloatArray, y: FloatArray) -> Any:
    model.set_training_values(x.copy(), y.copy())
    try:
        model.train()
    except (ValueError, np.linalg.LinAlgError) as error:
        raise RunError(f"surrogate {type(model).__name__} of SMT could not be trained ({error}).") from None
    return model
