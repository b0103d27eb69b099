"""The study file: every key, its defaults, its messages; and any bytes at all."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from doe_kc.axle import Axle, design_parameters
from doe_kc.axle_file import read_axle
from doe_kc.ground.errors import InputError
from doe_kc.load_cases import LOAD_CASES
from doe_kc.study import Study, read_study, select
from tests.reference import EXAMPLE, nominal

GOOD = (EXAMPLE / "study.toml").read_bytes()


def written(folder: Path, text: str) -> Path:
    shutil.copy(EXAMPLE / "axle.toml", folder / "axle.toml")
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_example_has_every_key() -> None:
    study = read_study(EXAMPLE)
    assert study.name == "Front axle, car_a" and study.seed == 1
    assert study.source == EXAMPLE / "study.toml" and study.axle_path == EXAMPLE / "axle.toml"
    assert study.measurement == EXAMPLE / "rig" and study.out == EXAMPLE / "out"
    assert set(study.windows) == set(LOAD_CASES)
    assert {c: case.window for c, case in LOAD_CASES.items()} == study.windows
    assert list(study.parameters) == design_parameters(study.axle)


def test_the_shortest_study(tmp_path: Path) -> None:
    study = read_study(written(tmp_path, 'axle = "axle.toml"\nmeasurement = "rig"\n'))
    assert study.name == tmp_path.name and study.seed == 1 and study.windows == {}
    assert study.out == tmp_path / "out" and study.measured() == (tmp_path / "rig",)
    assert len(study.parameters) == len(design_parameters(nominal())) >= 70


def test_paths_are_relative_to_the_study_and_may_be_absolute(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "a"
    folder.mkdir()
    written(folder, f'axle = "{(EXAMPLE / "axle.toml").as_posix()}"\nout = "../b"\n')
    monkeypatch.chdir(tmp_path)
    study = read_study(Path("a"))
    assert study.axle_path == EXAMPLE / "axle.toml"
    assert study.out.resolve() == tmp_path / "b"
    assert study.name == "a"


def test_the_commands_options_take_the_place_of_the_studys(tmp_path: Path) -> None:
    path = written(tmp_path, 'axle = "axle.toml"\nmeasurement = "rig"\nout = "o"\nseed = 5\n')
    study = read_study(path, measurement=Path("m"), out=Path("n"), seed=0)
    assert (study.measurements, study.out, study.seed) == ((Path("m"),), Path("n"), 0)
    assert read_study(path).seed == 5


def test_a_study_names_one_measured_car_or_several(tmp_path: Path) -> None:
    path = written(tmp_path, 'axle = "axle.toml"\nmeasurement = ["rig_1", "rig_2"]\n')
    study = read_study(path)
    assert study.measurements == (tmp_path / "rig_1", tmp_path / "rig_2")
    assert study.measurement == tmp_path / "rig_1" and study.measured() == study.measurements
    assert read_study(path, measurement=[Path("a"), Path("b")]).measurements == (Path("a"), Path("b"))
    assert read_study(path, measurement=[]).measurements == study.measurements
    (tmp_path / "rig_2").mkdir()
    for wrong in ("[]", "3", '["rig_1", 2]'):
        with pytest.raises(InputError, match="measurement"):
            read_study(written(tmp_path, f'axle = "axle.toml"\nmeasurement = {wrong}\n'))
    among = 'axle = "axle.toml"\nmeasurement = ["rig_1", "rig_2"]\nout = "rig_2/out"\n'
    with pytest.raises(InputError, match="inside the records' folder"):
        read_study(written(tmp_path, among))


@pytest.mark.parametrize("out", ["axle.toml", "study.toml", "rig", "rig/out"])
def test_results_are_not_written_over_files_or_among_records(tmp_path: Path, out: str) -> None:
    (tmp_path / "rig").mkdir()
    with pytest.raises(InputError, match="out is"):
        read_study(written(tmp_path, f'axle = "axle.toml"\nmeasurement = "rig"\nout = "{out}"\n'))


def test_a_study_with_notepads_mark_is_read(tmp_path: Path) -> None:
    path = written(tmp_path, 'axle = "axle.toml"\n')
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert read_study(path).measurement is None


def test_a_pipe_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "study.toml")
    with pytest.raises(InputError, match="pipe or a device"):
        read_study(tmp_path / "study.toml")


def test_a_study_without_measurement_says_how_to_add_one(tmp_path: Path) -> None:
    study = read_study(written(tmp_path, 'axle = "axle.toml"\n'))
    assert study.measurement is None
    with pytest.raises(InputError, match=r"study\.toml: names no measurement.*--measurement DIR"):
        study.measured()


def test_globs_select_in_the_order_of_the_table() -> None:
    paths = [p.path for p in select(nominal(), ["llr.F?", "LLF.*", "LLF.x"], "x")]
    assert paths == ["LLF.x", "LLF.y", "LLF.z", "llr.Fx", "llr.Fy", "llr.Fz"]
    with pytest.raises(InputError, match=r"'llf\.G\?' matches no parameter.*LLF\.\* or llr\.F\?"):
        select(nominal(), ["*", "llf.G?"], "x")
    with pytest.raises(InputError, match=r"Did you mean \"spring\.rate\""):
        select(nominal(), ["spring.rat"], "x")


def test_case_of_a_glob_matters() -> None:
    assert {p.path[:3] for p in select(nominal(), ["LLR*"], "x")} == {"LLR"}


def test_a_follower_can_be_selected_once_it_is_free(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="matches no parameter"):
        select(nominal(), ["UPS.x"], "x")
    text = (EXAMPLE / "axle.toml").read_text()
    (tmp_path / "axle.toml").write_text(text.replace('UPS = "UPB"', ""))
    axle = read_axle(tmp_path / "axle.toml")
    assert [p.path for p in select(axle, ["UPS.x"], "x")] == ["UPS.x"]


@pytest.mark.parametrize(
    ("text", "pattern"),
    [
        ("", "key axle is missing; add it"),
        ("axle = 1", "axle is 1"),
        ('axle = "axle.toml"\nout = 1', "out is 1"),
        ('axle = "axle.toml"\nseed = 1.5', "seed is 1.5"),
        ('axle = "axle.toml"\nseed = true', "seed is True"),
        ('axle = "axle.toml"\nwindows = 1', "windows is 1"),
        ('axle = "axle.toml"\n[windows]\nroll = inf', "windows.roll is inf"),
        ('axle = "axle.toml"\n[windows]\nroll = "1"', "windows.roll is '1'"),
        ('axle = "axle.toml"\n[windows]\nroll = -1', "windows.roll is -1.*expected a number > 0"),
        ('axle = "axle.toml"\n[windows]\nbrake = 10', "brake = 10 N holds fewer than 3.*widen it to"),
        ('axle = "axle.toml"\n[windows]\nrol = 1', r"rol is not a load case.*Did you mean \"roll\""),
        ('axle = "axle.toml"\n[influence]\nparameters = [1]', r"influence\.parameters\.0 is 1"),
        ('axle = "axle.toml"\n[influense]\n', r"influense is unknown.*Did you mean \"influence\""),
        ('axle = "axle.toml"\nAxle = "x"', r"Axle is unknown.*\"axle\""),
        ('axle = "axle.toml"\nschema_ = "doe_kc.study/1"', "schema_ is unknown"),
        ('axle = ""', "is a folder"),
        ('axle = "a\\u0000"', "cannot be read"),
    ],
)
def test_messages_name_file_and_key(tmp_path: Path, text: str, pattern: str) -> None:
    path = written(tmp_path, text + "\n")
    with pytest.raises(InputError, match=pattern) as caught:
        read_study(path)
    assert str(tmp_path) in str(caught.value) and caught.value.exit_code == 2


def test_several_faults_are_told_at_once(tmp_path: Path) -> None:
    path = written(tmp_path, "a = 1\nb = 2\nc = 3\nd = 4\ne = 5\nf = 6\n")
    with pytest.raises(InputError) as caught:
        read_study(path)
    lines = str(caught.value).splitlines()
    assert len(lines) == 6 and all(line.startswith(f"{path}: ") for line in lines)
    assert lines[-1].endswith("and 2 more of the kind.")


def test_the_narrowest_window_that_is_told_is_taken(tmp_path: Path) -> None:
    for case, definition in LOAD_CASES.items():
        path = written(tmp_path, f'axle = "axle.toml"\n[windows]\n{case} = 1e-6\n')
        with pytest.raises(InputError, match="widen it to") as caught:
            read_study(path)
        told = float(str(caught.value).split("widen it to ")[1].split(" ")[0])
        assert 0 < told < definition.window
        written(tmp_path, f'axle = "axle.toml"\n[windows]\n{case} = {told * 1.001}\n')
        assert read_study(path).windows[case] == pytest.approx(told * 1.001)


def read_any(data: bytes) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "axle.toml").symlink_to(EXAMPLE / "axle.toml")
        (folder / "study.toml").write_bytes(data)
        with contextlib.suppress(InputError):
            assert isinstance(read_study(folder), Study)


@settings(max_examples=150, deadline=None)
@given(st.binary(max_size=200))
@example(b"\xef\xbb\xbf" + GOOD)
@example(b"axle = " + b"[" * 5000)
@example(b"seed = " + b"1" * 5000)
@example(b'axle = "' + b"a" * 5000 + b'"')
def test_any_bytes(data: bytes) -> None:
    read_any(data)


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    """The example with slices replaced by anything, or by pieces of itself."""
    data = GOOD
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(data)))
        stop = draw(st.integers(start, min(len(data), start + 30)))
        other = draw(st.integers(0, len(GOOD) - 20))
        piece = draw(st.one_of(st.binary(max_size=12), st.just(GOOD[other : other + 20])))
        data = data[:start] + piece + data[stop:]
    return data


@settings(max_examples=150, deadline=None)
@given(mutated())
def test_any_damaged_example(data: bytes) -> None:
    read_any(data)


VALUES = st.recursive(
    st.sampled_from(
        [
            "1",
            "-2.5",
            "0",
            "nan",
            "inf",
            "1e400",
            '"axle.toml"',
            '""',
            '"*"',
            '"\\u0000"',
            "true",
            "1979-05-27",
        ]
    ),
    lambda inner: st.lists(inner, max_size=3).map(lambda v: "[" + ", ".join(v) + "]"),
    max_leaves=4,
)
PLAIN = ["schema", "name", "axle", "measurement", "out", "seed", "windows", "influence"]
KEYS = st.sampled_from([*PLAIN, "windows.roll", "windows.x", "influence.parameters", "'a.b'"])


@settings(max_examples=200, deadline=None)
@given(st.lists(st.tuples(KEYS, VALUES), max_size=4))
def test_any_values(entries: list[tuple[str, str]]) -> None:
    text = 'axle = "axle.toml"\n' + "".join(f"{key} = {value}\n" for key, value in entries)
    read_any(text.encode())


def test_a_null_character_in_a_path_is_refused_by_its_key(tmp_path: Path) -> None:
    (tmp_path / "axle.toml").symlink_to(EXAMPLE / "axle.toml")
    (tmp_path / "study.toml").write_text('axle = "axle.toml"\nmeasurement = "rig\\u0000"\n', encoding="utf-8")
    with pytest.raises(InputError, match="measurement holds a null character"):
        read_study(tmp_path)


OUTSIDE = 'axle = "axle.toml"\n[solver]\ncommand = ["solve"]\n'


def test_the_twin_of_an_outside_model(tmp_path: Path) -> None:
    plain = read_study(written(tmp_path, OUTSIDE))
    assert plain.twin is not None and plain.twin.values == plain.axle.values
    assert plain.twin_path == plain.axle_path
    assert read_study(written(tmp_path, OUTSIDE + "twin = false\n")).twin is None
    assert read_study(written(tmp_path, 'axle = "axle.toml"\n')).twin is None
    few = read_study(written(tmp_path, OUTSIDE + 'load_cases = ["roll"]\n'))
    assert few.twin is not None and list(few.twin.load_cases) == ["roll"]
    text = (EXAMPLE / "axle.toml").read_text(encoding="utf-8")
    (tmp_path / "own.toml").write_text(text.replace("28.0", "29.0"), encoding="utf-8")
    named = read_study(written(tmp_path, OUTSIDE + 'twin = "own.toml"\n'))
    assert named.twin is not None and named.twin.values["spring.rate@L"] == 29.0
    assert named.twin_path == tmp_path / "own.toml"


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ('twn = "axle.toml"', "solver.twn is unknown.*twin"),
        ("twin = 3", "solver.twin: expected the path of an axle file, true or false"),
        ('twin = ""', "solver.twin: is no path"),
        ('twin = "none.toml"', "none.toml: there is no such TOML file"),
        ('twin = "short.toml"', "sweeps load case roll to 2 deg, the study's axle to 4; give"),
        ('twin = "other.toml"', "is of the type double_wishbone_front.*twin = false"),
    ],
)
def test_a_twin_that_cannot_be_one(tmp_path: Path, keys: str, message: str) -> None:
    other = EXAMPLE.parent / "double_wishbone_front" / "axle.toml"
    shutil.copy(other, tmp_path / "other.toml")
    text = (EXAMPLE / "axle.toml").read_text(encoding="utf-8")
    (tmp_path / "short.toml").write_text(text.replace("amplitude = 4.0", "amplitude = 2.0"), encoding="utf-8")
    path = written(tmp_path, OUTSIDE + keys + "\n")
    with pytest.raises(InputError, match=message) as caught:
        read_study(path)
    assert len(str(caught.value).splitlines()) == 1


def test_a_twin_without_a_load_case_that_the_outside_model_answers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read(path: Path) -> Axle:
        axle = read_axle(path)
        kept = {k: c for k, c in axle.load_cases.items() if k != "roll" or path.name != "few.toml"}
        return replace(axle, load_cases=kept)

    monkeypatch.setattr("doe_kc.study.read_axle", read)
    shutil.copy(EXAMPLE / "axle.toml", tmp_path / "few.toml")
    keys = OUTSIDE + 'twin = "few.toml"\n'
    with pytest.raises(InputError, match=r"few.toml: has no load case roll, which the outside model answers"):
        read_study(written(tmp_path, keys))
    few = read_study(written(tmp_path, keys + 'load_cases = ["vertical", "steer"]\n'))
    assert few.twin is not None and list(few.twin.load_cases) == ["vertical", "steer"]


def test_a_twin_without_an_outside_model(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="solver: twin names the twin of an outside model; add command"):
        read_study(written(tmp_path, 'axle = "axle.toml"\n[solver]\ntwin = "axle.toml"\n'))
