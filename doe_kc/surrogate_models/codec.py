"""Fitted surrogates as JSON and plain arrays: no pickle, nothing is run when a file is read."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.calibration import Calibrated
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.surrogate_models.kernel import CovarianceKernel
from doe_kc.surrogate_models.legendre import Terms
from doe_kc.surrogate_models.models.gp import FirstOrderTrend, FittedGaussianProcess
from doe_kc.surrogate_models.models.quadratic import FittedQuadratic, Polynomial
from doe_kc.surrogate_models.models.rbf import FittedRadialBasis
from doe_kc.surrogate_models.ordinary_kriging import OrdinaryKriging
from doe_kc.surrogate_models.posterior import ProcessPosterior
from doe_kc.surrogate_models.ridge import FittedLinear
from doe_kc.surrogate_models.selection import Chosen
from doe_kc.surrogate_models.smt_library import RadialFit
from doe_kc.surrogate_models.training import Scaling
from doe_kc.surrogate_models.varying import Varying

FITTED_KINDS: dict[str, type[Any]] = {
    kind.__name__: kind
    for kind in (
        *(Calibrated, Chosen, CovarianceKernel, FirstOrderTrend, FittedGaussianProcess, FittedLinear),
        *(FittedQuadratic, FittedRadialBasis, OrdinaryKriging, Polynomial, ProcessPosterior, RadialFit),
        *(Scaling, Terms, Varying),
    )
}
"""Types that a file may hold."""


class UnreadableModel(ValueError):
    """A document that no encoded surrogate has."""


def encode(fitted: Fitted) -> tuple[dict[str, Any], dict[str, FloatArray]]:
    """Document for JSON, and the arrays that it names."""
    arrays: dict[str, FloatArray] = {}
    return _encoded(fitted, arrays), arrays


def decode(document: Any, arrays: dict[str, FloatArray]) -> Fitted:
    """The surrogate that `encode` was given; UnreadableModel when document and arrays hold none."""
    try:
        fitted = _decoded(document, arrays)
    except (KeyError, TypeError, AttributeError, IndexError) as error:
        raise UnreadableModel(str(error)) from None
    if not isinstance(fitted, Fitted):
        raise UnreadableModel("no surrogate in it")
    return fitted


def _encoded(value: Any, arrays: dict[str, FloatArray]) -> Any:
    if isinstance(value, np.ndarray):
        name = f"array{len(arrays)}"
        arrays[name] = value
        return {"array": name}
    if is_dataclass(value):
        content = {f.name: _encoded(getattr(value, f.name), arrays) for f in fields(value)}
        return {"kind": type(value).__name__, "fields": content}
    if isinstance(value, tuple):
        return {"items": [_encoded(v, arrays) for v in value]}
    if isinstance(value, np.generic):
        return value.item()
    return value


def _decoded(document: Any, arrays: dict[str, FloatArray]) -> Any:
    if not isinstance(document, dict):
        return document
    if "array" in document:
        return arrays[document["array"]]
    if "items" in document:
        return tuple(_decoded(item, arrays) for item in document["items"])
    kind = FITTED_KINDS[document["kind"]]
    return kind(**{name: _decoded(value, arrays) for name, value in document["fields"].items()})
