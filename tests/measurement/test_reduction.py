from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import openpyxl
import pytest

from doe_kc.characteristics import reduce_all
from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.errors import InputError
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES
from doe_kc.measurement import Measurement, reduce_measurement
from tests.measurement.synthetic import EXAMPLE, Errors, csv_text, record_columns, reference, write_rig


def test_the_shipped_example_is_complete(car_a: Measurement) -> None:
    assert tuple(car_a.curves.cases) == CASE_ORDER
    for name, case in car_a.curves.cases.items():
        np.testing.assert_array_equal(case.input, LOAD_CASES[name].inputs())
        assert set(case.mean) == set(RIG_RESPONSES)
    assert car_a.curves.static is not None
    np.testing.assert_array_equal(car_a.curves.static["spin"], [4.34, 4.31])
    assert all(len(runs) == 3 for runs in car_a.runs.values())
    assert car_a.curves.half_track == 790.0


def test_characteristics_are_those_of_the_common_reduction(car_a: Measurement) -> None:
    for ident, value in reduce_all(car_a.curves).items():
        np.testing.assert_equal(car_a.characteristics[ident].value, value)
    assert car_a.characteristics["static.camber"].value == -0.495
    assert car_a.characteristics["static.camber"].sd == 0.01
    assert car_a.characteristics["static.caster"].sd == 0.02


def test_trends_follow_the_curves_but_ring_at_the_bump_stop(car_a: Measurement) -> None:
    """Why branch means, not trends, feed the characteristics."""
    case = car_a.curves.cases["vertical"]
    trend = car_a.trends["vertical"]["tyre_load"][0]
    error = np.abs(trend(case.input) - case.mean["tyre_load"][0])
    assert 4 <= trend.degree <= 15
    assert 10.0 < error.max() < 60.0


def test_without_alignment_only_changes_are_compared(tmp_path: Path) -> None:
    m = reduce_measurement(write_rig(tmp_path, cases=("brake",), alignment=False))
    assert m.curves.static is None
    assert np.isnan(m.characteristics["static.toe"].value)
    assert np.isnan(m.characteristics["vertical.ride_rate"].value)
    assert np.isfinite(m.characteristics["brake.wind_up"].value)


def test_alignment_of_one_side_leaves_the_other_unknown(tmp_path: Path) -> None:
    path = write_rig(tmp_path, cases=("brake",), runs=1, alignment=False)
    text = path.read_text().replace("[records]", "[alignment]\nleft = { toe_deg = 0.1 }\n[records]")
    path.write_text(text)
    static = reduce_measurement(path).curves.static
    assert static is not None and set(static) == {"toe"}
    np.testing.assert_array_equal(static["toe"], [0.1, np.nan])


def test_windows_are_in_physical_units(tmp_path: Path) -> None:
    path = write_rig(tmp_path, cases=("vertical",), runs=1, errors=Errors())
    narrow = reduce_measurement(path, windows={"vertical": 10.0})
    assert {g.window for g in narrow.gradients} == {10.0}
    wide = reduce_measurement(path, windows={"vertical": 60.0})
    rate = "vertical.ride_rate"
    assert wide.characteristics[rate].value > narrow.characteristics[rate].value + 3.0


@pytest.mark.parametrize(
    ("windows", "words"),
    [
        ({"vertcal": 3.0}, 'no load case.*"vertical"'),
        ({"vertical": -1.0}, "no half-width"),
        ({"vertical": float("nan")}, "no half-width"),
        ({"vertical": 1.0}, "holds 1 point"),
    ],
)
def test_bad_windows_are_refused(tmp_path: Path, windows: dict[str, float], words: str) -> None:
    path = write_rig(tmp_path, cases=("vertical",), runs=1)
    with pytest.raises(InputError, match=words):
        reduce_measurement(path, windows=windows)


def test_a_copy_is_no_repeat(tmp_path: Path) -> None:
    path = write_rig(tmp_path, cases=("brake",), runs=2)
    shutil.copy(tmp_path / "brake_0.csv", tmp_path / "brake_1.csv")
    with pytest.raises(InputError, match="same samples"):
        reduce_measurement(path)


def test_a_record_per_excel_sheet_gives_the_same(tmp_path: Path) -> None:
    path = write_rig(tmp_path, cases=("brake",), runs=2)
    plain = reduce_measurement(path)
    book = openpyxl.Workbook()
    book.remove(book.active)
    for run in range(2):
        sheet = book.create_sheet(f"run{run}")
        lines = (tmp_path / f"brake_{run}.csv").read_text().splitlines()
        sheet.append(lines[0].split(","))
        for line in lines[1:]:
            sheet.append([float(c) for c in line.split(",")])
    book.save(tmp_path / "all.xlsx")
    text = path.read_text().replace("brake_0.csv", "all.xlsx#run0").replace("brake_1.csv", "all.xlsx#run1")
    path.write_text(text)
    excel = reduce_measurement(tmp_path)
    np.testing.assert_array_equal(
        excel.curves.cases["brake"].mean["spin"], plain.curves.cases["brake"].mean["spin"]
    )


def test_loops_become_half_widths(tmp_path: Path) -> None:
    m = reduce_measurement(write_rig(tmp_path, cases=("lateral",), half_width=5.0))
    middle = m.curves.cases["lateral"].input.size // 2
    assert m.curves.cases["lateral"].half_width["toe"][0, middle] == pytest.approx(0.015, abs=0.001)


def test_a_noise_free_single_run_is_reduced_exactly(tmp_path: Path) -> None:
    m = reduce_measurement(write_rig(tmp_path, runs=1, errors=Errors()))
    expected = reduce_all(reference("nominal"))
    for ident in ("brake.wind_up", "lateral.camber_change", "roll.camber_change"):
        assert m.characteristics[ident].value == pytest.approx(expected[ident], rel=0.01)


def test_a_missing_record_is_named_with_its_path(tmp_path: Path) -> None:
    path = tmp_path / "test.toml"
    path.write_text('name = "a"\n[records]\nroll = ["roll.csv"]\n')
    with pytest.raises(InputError, match=r"roll\.csv: no such file"):
        reduce_measurement(path)


def test_reduction_leaves_the_users_files_alone() -> None:
    assert sorted(p.name for p in EXAMPLE.iterdir() if p.suffix not in {".csv", ".toml"}) == []


def test_repeats_by_another_roll_technique_are_refused(tmp_path: Path) -> None:
    columns = record_columns("roll", samples=128)
    (tmp_path / "a.csv").write_text(csv_text(columns))
    pads = {
        k.replace("roll [deg]", "pad_z [mm]"): 15.0 * v if k == "roll [deg]" else v
        for k, v in columns.items()
    }
    (tmp_path / "b.csv").write_text(csv_text(pads))
    (tmp_path / "test.toml").write_text('name = "a"\n[records]\nroll = ["a.csv", "b.csv"]\n')
    with pytest.raises(InputError, match="repeats of one test"):
        reduce_measurement(tmp_path)
