"""Tables that are an influence matrix, and those that are none."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.identification.measured_matrix import MeasuredMatrix, measured_matrix
from tests.reference import nominal

FRAME = pd.DataFrame(
    {"drive.drive_steer": [10.0, -100.0, 3.0], "brake.wind_up": [0.0, 0.0, 0.0]},
    index=["LLF x", "llr.Fx", "RIB.z"],
)


def read(frame: pd.DataFrame, mask: tuple[tuple[str, str], ...] = ()) -> MeasuredMatrix:
    return measured_matrix(frame, nominal(), mask, "supplier.csv")


def test_a_blank_stands_for_the_dot_and_a_column_of_zeros_is_not_fitted() -> None:
    matrix = read(FRAME)
    assert [p.path for p in matrix.parameters] == ["LLF.x", "llr.Fx", "RIB.z"]
    assert matrix.fitted_columns.tolist() == [True, False] and matrix.counted.all()
    assert matrix.frame(matrix.values).loc["llr.Fx", "drive.drive_steer"] == -100.0


def test_rows_of_zeros_that_the_equations_do_not_contain_are_left_out() -> None:
    """As the influence of a rigid arm's radius is written; a mask may name them."""
    frame = pd.concat([FRAME, pd.DataFrame(0.0, index=["steer_arm.radius"], columns=FRAME.columns)])
    for mask in ((), (("steer_arm.*", "*"),)):
        matrix = read(frame, mask)
        assert [p.path for p in matrix.parameters] == ["LLF.x", "llr.Fx", "RIB.z"]
        np.testing.assert_array_equal(matrix.values, FRAME.values)
        assert matrix.counted.shape == FRAME.shape and matrix.counted.all()


def test_empty_cells_and_masks_do_not_count() -> None:
    frame = FRAME.astype(object)
    frame.iloc[0, 0], frame.iloc[1, 1], frame.iloc[2, 0] = None, "", " 3 % "
    matrix = read(frame, (("RIB.*", "brake.*"),))
    np.testing.assert_array_equal(matrix.counted, [[False, True], [True, False], [True, False]])
    assert matrix.values[2, 0] == 3.0 and np.isnan(matrix.values[0, 0])


@pytest.mark.parametrize(
    ("frame", "mask", "words"),
    [
        (FRAME.rename(index={"LLF x": "LLG.x"}), (), "row 'LLG.x' is not a parameter.*mean .LL[FR].x"),
        (FRAME.rename(index={"LLF x": "RIB.z"}), (), "row 'RIB.z' occurs 2 times"),
        (FRAME.rename(index={"LLF x": "steer_arm.radius"}), (), "equations.*do not contain it; remove"),
        (FRAME.rename(columns={"brake.wind_up": "brake.windup"}), (), 'mean "brake.wind_up"'),
        (FRAME.replace(-100.0, "high"), (), "row 'llr.Fx', column 'drive.drive_steer' is 'high'; expected"),
        (FRAME.replace(-100.0, np.inf), (), "expected a finite number"),
        (FRAME, (("ROB.*", "*"),), "meets no cell"),
        (FRAME, (("*", "drive.*"),), "nothing is left to fit"),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(
    frame: pd.DataFrame, mask: tuple[tuple[str, str], ...], words: str
) -> None:
    with pytest.raises(InputError, match=words) as error:
        read(frame, mask)
    assert str(error.value).startswith("supplier.csv: ")
