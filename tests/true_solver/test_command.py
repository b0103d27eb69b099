"""Outside solvers: a real one (the package's own command), and everything that one can do wrong."""

from __future__ import annotations

import json
import os
import re
import sys
import time
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.axle_file import read_axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError
from doe_kc.reports.simulation.tables import curves_frame
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.true_solver.answer import Unreadable, curves_from_frame, read_characteristics
from doe_kc.true_solver.command import CommandSolver
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.options import SolverOptions
from doe_kc.true_solver.own import AxleSolver
from tests.reference import EXAMPLE, nominal

PAGE = (EXAMPLE.parents[1] / "docs" / "outside_solver.md").read_text(encoding="utf-8")
(BRIDGE,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
WRITES = "import sys, pathlib, os, time; folder = pathlib.Path(sys.argv[1]); "
GOOD = {"vertical.bump_steer": {"value": -3.5, "unit": "deg/m"}}


@pytest.fixture(autouse=True)
def interpreted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DOE_KC_COMPILE", "0")


def python(code: str, folder: Path, *, timeout: float = 20.0) -> CommandSolver:
    """A solver that is a line of Python; `folder` is the run's."""
    words = (sys.executable, "-S", "-c", WRITES + code, "{folder}")
    return CommandSolver(words, nominal(), timeout=timeout, folder=folder)


def test_the_packages_own_command_as_an_outside_solver(tmp_path: Path) -> None:
    (tmp_path / "bridge.py").write_text(BRIDGE.replace("folder]\n", "folder, '--json', 'figures.json']\n"))
    (tmp_path / "axle.toml").write_bytes((EXAMPLE / "axle.toml").read_bytes())
    options = SolverOptions(command=[sys.executable, "bridge.py", "{parameters}", "{folder}", "axle.toml"])
    windows = {"vertical": 30.0, "roll": 2.0}
    design = {"LLF.z": 210.0 + 1.0 / 3.0, "WLC.y": -751.5, "llr.Fx": 0.7, "static.toe": 0.05}
    axle = read_axle(tmp_path / "axle.toml")
    outside = solver_for(axle, options, windows, tmp_path).evaluate(design)
    own = AxleSolver(axle, windows).evaluate(design)
    assert outside.reason == ""
    # ten digits in curves.csv: 5e-7 N of a tyre load, a part in a hundred million of a load transfer
    loads = [c.response == "tyre_load" for c in CHARACTERISTICS.values()]
    np.testing.assert_allclose(outside.characteristics, own.characteristics, rtol=2e-8, atol=1e-9)
    np.testing.assert_allclose(
        np.where(loads, 0.0, outside.characteristics), np.where(loads, 0.0, own.characteristics), rtol=1e-9
    )
    assert outside.curves is not None and own.curves is not None
    assert list(outside.curves.cases) == list(own.curves.cases)
    assert outside.curves.half_track == own.curves.half_track == 751.5
    for ident, case in own.curves.cases.items():
        for name, curve in case.mean.items():
            np.testing.assert_allclose(outside.curves.cases[ident].mean[name], curve, rtol=1e-8, atol=1e-6)

    (tmp_path / "figures.json").rename(tmp_path / "characteristics.json")
    figures = read_characteristics(tmp_path)
    assert figures is not None
    np.testing.assert_allclose(figures, AxleSolver(axle).evaluate(design).characteristics, rtol=1e-9)


def test_the_study_on_the_page_is_one() -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    options = SolverOptions.model_validate(tomllib.loads(text)["solver"])
    assert options.load_cases == ["vertical", "roll"] and options.timeout == 900.0


def test_loops_keep_their_hysteresis() -> None:
    cases = {i: nominal().load_cases[i] for i in ("roll", "steer")}
    axle = replace(apply_effect(nominal(), "steering_friction", {}, source="test"), load_cases=cases)
    solution = solve(axle, compiled=False)
    direct = curve_set(solution)
    again = curves_from_frame(curves_frame(solution), axle, tuple(cases), {})
    assert direct.static is not None and again.static is not None
    for name, value in direct.static.items():
        np.testing.assert_allclose(again.static[name], value, atol=1e-12)
    for ident, case in direct.cases.items():
        for name, curve in case.mean.items():
            np.testing.assert_allclose(again.cases[ident].mean[name], curve, atol=1e-9)
            np.testing.assert_allclose(again.cases[ident].half_width[name], case.half_width[name], atol=1e-9)
    assert np.abs(again.cases["steer"].half_width["toe"]).max() > 0


def test_what_the_command_is_given(tmp_path: Path) -> None:
    code = (
        "print((folder / 'parameters.json').read_text(), os.getcwd(), file=open('seen', 'w')); "
        f"(folder / 'characteristics.json').write_text({json.dumps(json.dumps(GOOD))})"
    )
    values = {"LLF.x": 0.1 + 0.2, "llr.Fx": 1.5, "right.LLR.y": 330.0, "spring.rate": 25.0}
    found = python(code, tmp_path).evaluate(values)
    assert found.reason == "" and found.curves is None and found.value("vertical.bump_steer") == -3.5
    text, _, cwd = (tmp_path / "seen").read_text().strip().rpartition(" ")
    assert json.loads(text) == {
        "parameters": values,
        "units": {"LLF.x": "mm", "llr.Fx": "-", "right.LLR.y": "mm", "spring.rate": "N/mm"},
    }
    assert Path(cwd) == tmp_path.resolve()


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("sys.exit('licence\\nserver is down')", "ended with exit code 1; it said last: server is down"),
        ("os.kill(os.getpid(), 9)", "was killed by signal 9"),
        ("pass", "wrote neither curves.csv nor characteristics.csv nor characteristics.json"),
        ("(folder / 'curves.csv').touch()", "curves.csv is not a table"),
        ("(folder / 'curves.csv').write_bytes(bytes(range(256)))", "curves.csv"),
        ("(folder / 'curves.csv').write_text('a,b')", "curves.csv has no row"),
        ("(folder / 'curves.csv').write_text('a,b\\n1,2')", "curves.csv has no column 'load_case'"),
        ("(folder / 'characteristics.csv').write_text('name,value\\na,1')", "has no column 'unit'"),
        ("(folder / 'characteristics.json').write_text('{')", "characteristics.json is not JSON"),
        ("(folder / 'characteristics.json').write_text('[1]')", 'expected {"characteristics"'),
        ("(folder / 'characteristics.json').write_text('{}')", "no characteristic was given"),
    ],
)
def test_what_a_command_does_wrong_is_a_reason(tmp_path: Path, code: str, reason: str) -> None:
    found = python(code, tmp_path).evaluate({"LLF.x": 0.0})
    assert found.failed and reason in found.reason, found.reason
    assert found.reason.startswith(Path(sys.executable).name)
    assert np.isnan(found.characteristics).all() and "\n" not in found.reason


@pytest.mark.parametrize(
    ("name", "value", "unit", "reason"),
    [
        ("vertical.bump_steer", "nan", "deg/m", "expected a finite number"),
        ("vertical.bump_steer", "", "deg/m", "expected a finite number"),
        ("vertical.bump_steer", "soft", "deg/m", "expected a finite number"),
        ("vertical.bump_steer", "1", "deg/mm", "is in 'deg/mm', expected 'deg/m'"),
        ("vertical.bump_stear", "1", "deg/m", 'Did you mean "vertical.bump_steer"'),
    ],
)
def test_characteristics_that_cannot_be(
    tmp_path: Path, name: str, value: str, unit: str, reason: str
) -> None:
    line = f"name,value,unit\\n{name},{value},{unit}\\n"
    found = python(f"(folder / 'characteristics.csv').write_text('{line}')", tmp_path).evaluate({})
    assert reason in found.reason


@pytest.mark.skipif(os.name == "nt", reason="POSIX processes")
def test_a_command_that_hangs_ends_with_its_children(tmp_path: Path) -> None:
    code = "child = os.fork(); print(os.getpid(), file=open(f'pid{bool(child)}', 'w')); time.sleep(60)"
    started = time.monotonic()
    found = python(code, tmp_path, timeout=0.5).evaluate({})
    assert "was ended: it took longer than 0.5 s" in found.reason and time.monotonic() - started < 10.0
    time.sleep(0.05)
    for file in (tmp_path / "pidTrue", tmp_path / "pidFalse"):
        stat = Path(f"/proc/{file.read_text().strip()}/stat")
        assert not stat.exists() or stat.read_text().rpartition(")")[2].split()[0] == "Z"


def test_no_folder_is_left_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = tmp_path / "temporary"
    place.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(place))
    assert python("sys.exit(3)", tmp_path).evaluate({}).failed
    assert not list(place.iterdir())


def test_a_command_that_is_not_there_is_bad_input(tmp_path: Path) -> None:
    solver = CommandSolver(("no_such_solver", "{folder}"), nominal(), folder=tmp_path)
    with pytest.raises(InputError, match=r"\[solver\] command: 'no_such_solver' cannot be run"):
        solver.evaluate({})
    with pytest.raises(InputError, match="unknown parameter"):
        solver.prepare([{"LLF.q": 1.0}])


def test_the_fingerprint_knows_command_files_and_model(tmp_path: Path) -> None:
    (tmp_path / "bridge.py").write_text("1")
    base = CommandSolver(("python", "bridge.py"), nominal(), folder=tmp_path)
    prints = [base.fingerprint(), replace(base, timeout=1.0, windows={"roll": 2.0}).fingerprint()]
    assert prints[0] == prints[1]
    (tmp_path / "bridge.py").write_text("2")
    stiff = with_values(nominal(), {"spring.rate": 26.0})
    prints += [s.fingerprint() for s in (base, replace(base, axle=stiff), replace(base, command=("python",)))]
    assert len(set(prints)) == 4


@pytest.fixture(scope="module")
def model() -> Axle:
    return replace(nominal(), load_cases={i: nominal().load_cases[i] for i in ("vertical", "roll")})


@pytest.fixture(scope="module")
def table(model: Axle) -> pd.DataFrame:
    return curves_frame(solve(model, compiled=False))


def without(table: pd.DataFrame, **wanted: object) -> pd.DataFrame:
    keep = ~np.logical_and.reduce([table[k] == v for k, v in wanted.items()])
    return table[keep]


def with_nan(table: pd.DataFrame) -> pd.DataFrame:
    copy = table.copy()
    copy.loc[5, "camber_deg"] = np.nan
    return copy


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda t: t[: len(t) - 10], "sides L and R have other inputs; cut off"),
        (lambda t: without(t, load_case="roll"), "no rows of load case roll"),
        (lambda t: without(t, load_case="roll", branch="neg"), "has branch pos alone; cut off"),
        (lambda t: without(t, load_case="roll", step=0), "has no point at input 0"),
        (lambda t: t[t["input"].abs() < 0.9], "too few within the fit window|ends at"),
        (lambda t: without(t, load_case="vertical")[0:0], "no rows of load case"),
        (with_nan, "camber_deg is missing or not finite"),
        (lambda t: t.astype({"toe_deg": object}).replace({"toe_deg": {t["toe_deg"][3]: "x"}}), "holds text"),
        (lambda t: t.rename(columns={"toe_deg": "toe_rad"}), "column toe_rad, expected toe_deg"),
        (lambda t: t.rename(columns={"wc_y_mm": "wc_y_m"}), "column wc_y_m, expected wc_y_mm"),
        (lambda t: t.replace({"input_unit": {"mm": "m"}}), "input_unit m, expected mm"),
        (lambda t: t[["load_case", "branch", "input", "input_unit", "side"]], "has no response"),
        (lambda t: t.replace({"branch": {"pos": "a", "neg": "b"}}), "has branches a, b"),
    ],
)
def test_curves_that_cannot_be(model: Axle, table: pd.DataFrame, change: object, reason: str) -> None:
    changed = change(table)  # type: ignore[operator]
    with pytest.raises(Unreadable, match=reason):
        curves_from_frame(changed, model, ("vertical", "roll"), {})


def test_a_single_branch_and_few_responses_do(model: Axle, table: pd.DataFrame) -> None:
    few = table.drop(columns=["spin_deg", "tyre_load_N"]).replace({"branch": {"pos": "all", "neg": "all"}})
    curves = curves_from_frame(few.sample(frac=1.0, random_state=1), model, ("roll",), {})
    assert set(curves.cases) == {"roll"} and "spin" not in curves.cases["roll"].mean
    whole = curve_set(solve(model, compiled=False)).cases["roll"]
    np.testing.assert_allclose(curves.cases["roll"].mean["toe"], whole.mean["toe"], atol=1e-12)
    np.testing.assert_array_equal(curves.cases["roll"].input, whole.input)


def test_curves_and_own_characteristics_together(tmp_path: Path, model: Axle, table: pd.DataFrame) -> None:
    """What curves say is reduced from them; the command's own figures fill the rest."""
    table.to_csv(tmp_path / "ready.csv", index=False, float_format="%.10g")
    given: Mapping[str, Mapping[str, object]] = {
        "vertical.bump_steer": {"value": 99.0, "unit": "deg/m"},
        "steer.steering_ratio": {"value": -0.06, "unit": "deg/deg"},
    }
    (tmp_path / "ready.json").write_text(json.dumps({"characteristics": given}))
    code = (
        "[(folder / new).write_bytes(open(old, 'rb').read()) for old, new in "
        "(('ready.csv', 'curves.csv'), ('ready.json', 'characteristics.json'))]"
    )
    found = replace(python(code, tmp_path), axle=model).evaluate({})
    assert found.reason == ""
    own = AxleSolver(model).evaluate({})
    assert found.value("vertical.bump_steer") == pytest.approx(own.value("vertical.bump_steer"), rel=1e-7)
    assert found.value("steer.steering_ratio") == -0.06 and len(found.characteristics) == len(CHARACTERISTICS)


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        ({"command": [""]}, "empty"),
        ({"load_cases": ["heave"]}, "heave is no load case"),
        ({"timeout": 0.0}, "greater than 0"),
    ],
)
def test_options_that_cannot_be(options: dict[str, object], pattern: str) -> None:
    with pytest.raises(ValueError, match=pattern):
        SolverOptions.model_validate(options)
