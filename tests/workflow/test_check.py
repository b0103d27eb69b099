"""What any command would refuse of a study is told by `check` before."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.study import read_study
from doe_kc.workflow.check import Fault, check_study
from doe_kc.workflow.correlation_problem import study_problem
from doe_kc.workflow.measure import Reduced, study_measurement
from tests.cli.runner import invoke, write_study


def small(folder: Path, extra: str = "", tables: str = "") -> Path:
    return write_study(folder, records={"brake": ["brake.csv"]}, extra=extra, tables=tables)


def one_error(folder: Path) -> Fault:
    (error,) = check_study(folder).errors
    return error


def halve(record: Path) -> None:
    """Keep the part of a loop in which its input rises."""
    lines = record.read_text().splitlines()
    column = next(i for i, name in enumerate(lines[0].split(",")) if "force" in name.lower())
    values = np.array([float(line.split(",")[column]) for line in lines[1:]])
    low, high = int(values.argmin()), int(values.argmax())
    first, last = sorted((low, high))
    record.write_text("\n".join([lines[0], *lines[1 + first : 2 + last]]) + "\n")


def test_a_sound_study_has_no_fault(tmp_path: Path) -> None:
    checked = check_study(small(tmp_path / "s"))
    assert checked.errors == () and checked.warnings == () and checked.study is not None


def test_a_record_of_one_branch(tmp_path: Path) -> None:
    study = small(tmp_path / "s")
    halve(study / "rig" / "brake.csv")
    checked = check_study(study)
    assert not checked.errors
    (warning,) = [w for w in checked.warnings if w.kind == "one_branch"]
    assert warning.where.endswith("brake.csv") and "friction" in warning.message
    measurement = study_measurement(read_study(study))
    assert np.isnan(measurement.curves.cases["brake"].half_width["toe"]).all()
    assert np.isfinite(measurement.curves.cases["brake"].mean["toe"]).all()


def test_every_bad_record_is_told(tmp_path: Path) -> None:
    study = write_study(tmp_path / "s", records={"brake": ["brake.csv"], "roll": ["roll.csv"]})
    for name in ("brake.csv", "roll.csv"):
        (study / "rig" / name).write_text("")
    assert [Path(e.where).name for e in check_study(study).errors] == ["roll.csv", "brake.csv"]


@pytest.mark.parametrize(
    "bounds", ["target = 1.0\nlow = 2.0", "low = 2.0\nhigh = 1.0", "target = 1.0\nlow = 0.5\nhigh = 0.5"]
)
def test_an_empty_interval(bounds: str, tmp_path: Path) -> None:
    study = small(tmp_path / "s", tables=f'[[characteristics]]\nmatch = "brake.wind_up"\n{bounds}')
    error = one_error(study)
    assert error.kind == "targets" and "is empty" in error.message
    with pytest.raises(InputError) as refused:
        study_problem(read_study(study), None)
    if "target" in bounds:
        assert error.message == str(refused.value)


WIND_UP = "[[characteristics]]\nmatch = 'brake.wind_up'\n"


def measured_wind_up(folder: Path) -> float:
    return study_measurement(read_study(small(folder))).characteristics["brake.wind_up"].value


@pytest.mark.parametrize("end", ["low", "high"])
def test_one_end_beyond_the_interval_of_what_is_measured(end: str, tmp_path: Path) -> None:
    value = measured_wind_up(tmp_path / "m")
    bound = value + (0.3 if end == "low" else -0.3) * abs(value)
    study = small(tmp_path / "s", tables=f"{WIND_UP}{end} = {bound}")
    error = one_error(study)
    assert error.kind == "targets" and "is empty" in error.message
    read = read_study(study)
    with pytest.raises(InputError) as refused:
        study_problem(read, Reduced(study_measurement(read), None))
    assert error.message == str(refused.value)


@pytest.mark.parametrize(("objective", "count"), [("", 1), ("\nobjective = false", 0)])
def test_an_interval_that_excludes_its_target_is_a_warning(
    objective: str, count: int, tmp_path: Path
) -> None:
    value = measured_wind_up(tmp_path / "m")
    low = value + 0.1 * abs(value)
    checked = check_study(small(tmp_path / "s", tables=f"{WIND_UP}low = {low}{objective}"))
    assert not checked.errors and len(checked.warnings) == count
    assert all(f"does not hold the target {value:g}" in w.message for w in checked.warnings)


def test_one_end_within_the_interval_is_sound(tmp_path: Path) -> None:
    low = measured_wind_up(tmp_path / "m") - 1e-6
    checked = check_study(small(tmp_path / "s", tables=f"{WIND_UP}low = {low}"))
    assert not checked.errors and not checked.warnings


def test_results_that_cannot_be_written(tmp_path: Path) -> None:
    study = small(tmp_path / "s")
    (tmp_path / "file").touch()
    error = check_study(study, out=tmp_path / "file" / "out").errors[0]
    assert error.kind == "out" and "--out" in error.message
    assert not (study / "out").exists()


def test_a_store_of_another_axle(tmp_path: Path) -> None:
    study = small(tmp_path / "s")
    assert invoke("sample", study, "--n", 2, "--workers", 1).code == 0
    assert not check_study(study).errors
    axle = study / "axle.toml"
    axle.write_text(axle.read_text().replace("rate = ", "rate = 1", 1))
    assert [e.kind for e in check_study(study).errors] == ["out"]


def test_what_the_study_names_is_known(tmp_path: Path) -> None:
    tables = '[correlation]\nmethod = "egg"\n[sampling]\nmethod = "luck"\n[surrogates]\nmodels = ["oracle"]'
    kinds = [e.kind for e in check_study(small(tmp_path / "s", tables=tables)).errors]
    assert kinds == ["method", "sampling", "surrogates"]


def test_what_needs_a_measurement(tmp_path: Path) -> None:
    tables = '[variables]\nuse = "selection"\n[correlation]\nset_first = ["ride_height"]'
    checked = check_study(write_study(tmp_path / "s", tables=tables))
    assert [e.kind for e in checked.errors] == ["variables", "measurement"]
    assert [w.kind for w in checked.warnings] == ["targets"]
    short = check_study(small(tmp_path / "t", tables='[correlation]\nset_first = ["ride_height"]'))
    assert "record of vertical motion" in short.errors[0].message


def test_another_set_up_is_a_warning(tmp_path: Path) -> None:
    study = small(tmp_path / "s")
    file = study / "rig" / "test.toml"
    file.write_text(file.read_text().replace("[alignment]", "[setup]\nrack_mm_per_rev = 40.0\n[alignment]"))
    checked = check_study(study)
    assert not checked.errors and [w.kind for w in checked.warnings] == ["setup"]


def test_the_command_tells_all_and_writes_them(tmp_path: Path) -> None:
    study = small(tmp_path / "s", tables='[correlation]\nmethod = "egg"')
    (study / "rig" / "brake.csv").write_text("")
    outcome = invoke("check", study, "--json", tmp_path / "c.json")
    assert outcome.code == 2 and outcome.err.count("doe-kc: ") == 2 and "all sound" not in outcome.out
    document = json.loads((tmp_path / "c.json").read_text())
    assert [set(e) for e in document["errors"]] == [{"where", "kind", "message"}] * 2
    assert [e["kind"] for e in document["errors"]] == ["record", "method"] and document["warnings"] == []
    assert invoke("check", tmp_path / "none", "--json", tmp_path / "c.json").code == 2
    assert json.loads((tmp_path / "c.json").read_text())["errors"][0]["kind"] == "study"
    (tmp_path / "c.json").unlink()
    assert invoke("check", small(tmp_path / "t"), "--json", tmp_path / "c.json").code == 0
    assert json.loads((tmp_path / "c.json").read_text()) == {"errors": [], "warnings": []}


TWIN = '[solver]\ncommand = ["solve"]\ntwin = "own.toml"\n'


def test_a_twin_with_other_numbers_is_told(tmp_path: Path) -> None:
    study = small(tmp_path / "s", tables=TWIN)
    text = (study / "axle.toml").read_text(encoding="utf-8")
    (study / "own.toml").write_text(text, encoding="utf-8")
    assert [w for w in check_study(study).warnings if w.kind == "twin"] == []
    (study / "own.toml").write_text(text.replace("[-2.0, -395.0, 212.0]", "[-2.0, -395.0, 221.0]"), "utf-8")
    (warning,) = [w for w in check_study(study).warnings if w.kind == "twin"]
    assert "LLF.z 221 for 212 in the study's axle" in warning.message and "own.toml" in warning.message
    (study / "own.toml").unlink()
    assert "own.toml" in one_error(study).message
