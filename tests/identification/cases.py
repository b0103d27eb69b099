"""A small matrix of a known car: twelve parameters, six characteristics of two load cases."""

from __future__ import annotations

from functools import lru_cache

import pandas as pd

from doe_kc.axle import Axle, with_values
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.identification.matrix_model import MatrixModel, in_windows, influence_matrix
from doe_kc.identification.measured_matrix import measured_matrix
from doe_kc.identification.unknowns import Free, unknowns
from tests.reference import nominal

ROWS = (
    *("LLF.z", "LLR.z", "LWB.x", "LWB.z", "RIB.x", "ROB.x", "WLC.x"),
    *("llf.Fx", "llr.Fx", "sff.Fy", "sfr.Fy", "upb.Fy"),
)
COLUMNS = (
    *("lateral.camber_change", "lateral.toe_change", "lateral.wc_lateral_disp"),
    *("brake.brake_steer", "brake.wind_up", "brake.wc_longitudinal_disp"),
)
FREE = {"RIB.x": 5.0, "ROB.x": 5.0, "llr.Fx": 2.0, "upb.Fy": 2.0}
CAR = {"RIB.x": 156.0, "ROB.x": 132.0, "llr.Fx": 0.6, "upb.Fy": 1.5}


def matrix_of(axle: Axle) -> pd.DataFrame:
    """In the characteristics' units."""
    values = influence_matrix(in_windows(axle), ROWS, [CHARACTERISTICS[c] for c in COLUMNS])
    return pd.DataFrame(values, index=list(ROWS), columns=list(COLUMNS))


@lru_cache(maxsize=1)
def car_matrix() -> pd.DataFrame:
    """Of the car, in percent of each column's largest entry."""
    matrix = matrix_of(with_values(nominal(), CAR))
    return 100.0 * matrix / matrix.abs().max()


def model(
    matrix: pd.DataFrame, free: Free = FREE, mask: tuple[tuple[str, str], ...] = (), *, noise: float = 1e-3,
    any_sign: bool = True,
) -> MatrixModel:  # fmt: skip
    """Of the reference axle."""
    measured = measured_matrix(matrix, nominal(), mask, "test")
    return MatrixModel(unknowns(nominal(), free, "test"), measured, noise, any_sign)
