"""Studies of the Python API."""

from __future__ import annotations

from pathlib import Path

import pytest

import doe_kc as kc
from doe_kc.api.studies import stored


def test_what_replaces_the_studys_own(folder: Path, tmp_path: Path) -> None:
    study = kc.read_study(str(folder), measurement="records", out=str(tmp_path), seed=7, pictures="svg")
    assert (study.measurement, study.out, study.seed, study.pictures) == (Path("records"), tmp_path, 7, "svg")
    assert kc.read_study(folder).measurement == folder / "rig"
    assert repr(study) == f"Study('Front axle', 7 variables, from {folder / 'study.toml'})"
    with pytest.raises(kc.InputError, match=r"study\.toml"):
        kc.read_study(tmp_path)


def test_the_example_to_edit(tmp_path: Path) -> None:
    study = kc.init(tmp_path / "new")
    assert study.source == tmp_path / "new" / "study.toml" and study.measurement is not None
    with pytest.raises(kc.InputError, match="not an empty folder"):
        kc.init(tmp_path / "new")


def test_where_evaluations_are_kept(folder: Path, tmp_path: Path) -> None:
    study = kc.read_study(folder)
    with stored(study, None) as kept:
        place = kept.out
        assert place.is_dir() and place != study.out
    assert not place.exists()
    with stored(study, tmp_path) as kept:
        assert kept.store == tmp_path / "store" / "evaluations.sqlite"


def test_answers_of_an_outside_solver_are_never_lost(folder: Path, tmp_path: Path) -> None:
    text = (folder / "study.toml").read_text().replace('"axle.toml"', repr(str(folder / "axle.toml")))
    command = '[solver]\ncommand = ["solver", "{axle}", "{curves}"]\n'
    (tmp_path / "study.toml").write_text(text + command)
    study = kc.read_study(tmp_path)
    with stored(study, None) as kept:
        assert kept.out == tmp_path / "out"


def test_errors_are_of_one_kind() -> None:
    assert issubclass(kc.InputError, kc.DoeKcError) and issubclass(kc.RunError, kc.DoeKcError)


def test_the_example_of_another_axle_type(tmp_path: Path) -> None:
    study = kc.init(tmp_path / "new", "double_wishbone_front")
    assert study.axle.topology.structure.type == "double_wishbone_front"
    assert study.measurement == tmp_path / "new" / "rig"
    with pytest.raises(kc.InputError, match="expected one of mcpherson_front"):
        kc.init(tmp_path / "other", "swing_axle")
