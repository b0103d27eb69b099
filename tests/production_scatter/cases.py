"""Small scatters for the tests of the tolerance study."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from doe_kc.axle import Axle, Parameter
from doe_kc.axle_file import read_axle
from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.build import build_scatter
from doe_kc.production_scatter.laws import DEVIATION_LAWS
from doe_kc.production_scatter.model import Scatter, ScatterModel, correlation_matrix
from doe_kc.production_scatter.options import LawId, ToleranceOptions
from tests.reference import EXAMPLE

FEW = ["ROB.z", "LLF.z", "llr.Fx", "arb.radius"]


@lru_cache(maxsize=1)
def example() -> Axle:
    return read_axle(EXAMPLE / "axle.toml")


def scatter_of(**table: Any) -> ScatterModel:
    """Of the example axle by a table [tolerance]."""
    return build_scatter(example(), ToleranceOptions.model_validate(table), "study.toml")


def plain_model(sd: list[float], between: FloatArray | None = None, law: LawId = "normal") -> ScatterModel:
    """Parameters x0, x1, ... of a whole axle, nominal 0."""
    scatters = tuple(
        Scatter(
            parameter=Parameter(
                path=f"x{i}", label=f"x{i}", group="OTHER", unit="mm", nominal=0.0, lower=-1.0, upper=1.0,
                step=1.0, active=True,
            ),
            sd=s,
            law=DEVIATION_LAWS[law](3.0),
            common=0.0,
            both_sides=False,
        )
        for i, s in enumerate(sd)
    )  # fmt: skip
    matrix = np.eye(len(sd)) if between is None else between
    zeros = np.zeros(len(sd))
    return ScatterModel(scatters, zeros, zeros + 1.0, correlation_matrix(scatters, matrix))
