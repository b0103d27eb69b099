"""Influence studies to test with: one of round numbers, one of the real axle."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from doe_kc.axle.design_parameters import Parameter, design_parameters
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.parameter_influence.study import Influence, influence_study
from tests.reference import nominal

PATHS = (
    "LLF.z",
    "LLR.z",
    "LWB.z",
    "RIB.z",
    "ROB.z",
    "llr.Fx",
    "llf.Fx",
    "sff.Tz",
    "spring.rate",
    "arb.radius",
)


def parameter(path: str, **changes: object) -> Parameter:
    """A hardpoint coordinate, nominal 0, bounds ±4, step 1, so that its prior sd is 2."""
    plain = Parameter(
        path=path, label=path, group="HARDPOINTS", unit="mm",
        nominal=0.0, lower=-4.0, upper=4.0, step=1.0, active=True,
    )  # fmt: skip
    return replace(plain, **changes)  # type: ignore[arg-type]


def study(
    change: list[list[float]],
    ids: tuple[str, ...] = ("vertical.bump_steer", "roll.roll_steer", "brake.wind_up"),
    parameters: tuple[Parameter, ...] | None = None,
    exact: list[list[float]] | None = None,
    **more: object,
) -> Influence:
    """An exactly linear study whose absolute change is `change`; baseline zero."""
    values = np.array(change, dtype=float)
    rows = parameters or tuple(parameter(f"P{i}.x") for i in range(len(values)))
    return Influence(
        parameters=rows,
        characteristics=tuple(CHARACTERISTICS[i] for i in ids[: values.shape[1]]),
        baseline=np.zeros(values.shape[1]),
        plus=values,
        minus=-values,
        exact=values.copy() if exact is None else np.array(exact, dtype=float),
        seconds=0.1,
        **more,  # type: ignore[arg-type]
    )


@lru_cache
def real_study() -> Influence:
    """Ten parameters of the example's axle, every registered characteristic."""
    known = {p.path: p for p in design_parameters(nominal())}
    columns = list(CHARACTERISTICS.values())
    return influence_study(nominal(), [known[p] for p in PATHS], columns, workers=1)
