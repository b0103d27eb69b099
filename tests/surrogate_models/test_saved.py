"""A saved surrogate gives the same numbers in a fresh process; bad files and tables are named."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.surrogate_models.calibration import Calibrated
from doe_kc.surrogate_models.models import make
from doe_kc.surrogate_models.models.gp import FirstOrderTrend
from doe_kc.surrogate_models.models.gp_slopes import SlopeProcess
from doe_kc.surrogate_models.saved import Input, Output, SavedSurrogate, load_surrogate, save_surrogate
from doe_kc.surrogate_models.selection import join
from doe_kc.surrogate_models.varying import fit_varying
from doe_kc.variables import Tie
from doe_kc.workflow.predict import predict_table
from tests.cli.runner import fails, succeeds
from tests.surrogate_models.problems import differences, outputs, problem

P = problem()
AT = np.full(5, 0.5)
TREND = FirstOrderTrend(AT, outputs(AT[None])[0], differences(outputs, AT[None], 1e-5)[0])
INPUTS = tuple(
    Input(f"P{k}", "mm", lower, upper, start, k == 4)
    for k, (lower, upper, start) in enumerate(
        [(-1.0, 1.0, 0.0), (200.0, 210.0, 205.0), (0.0, 1.0, 0.5), (5.0, 6.0, 5.5), (0.5, 2.0, 1.0)]
    )
)
OUTPUTS = tuple(Output(f"o{k}", f"Output {k}", "deg", "gp", 0.99, 0.01) for k in range(3))
LOAD = """
import sys, numpy as np
from doe_kc.surrogate_models.saved import load_surrogate
mean, sd = load_surrogate(__import__("pathlib").Path(sys.argv[1])).predict(np.load(sys.argv[2]))
np.save(sys.argv[3], np.stack([mean, sd]))
"""


def saved(name: str = "gp") -> SavedSurrogate:
    model = SlopeProcess(TREND) if name == "gp_slopes" else make(name)
    fitted = Calibrated(model.fit(P.x, P.y), np.array([1.0, 2.0, 3.0]))
    return SavedSurrogate("small", len(P.x), INPUTS, OUTPUTS, fitted)


def values() -> np.ndarray:
    lower, upper = (np.array([getattr(i, end) for i in INPUTS]) for end in ("lower", "upper"))
    out = lower + P.test * (upper - lower)
    out[:, 4] = 0.5 * 4.0 ** P.test[:, 4]
    return np.asarray(out)


@pytest.mark.parametrize("name", ["gp", "gp_ard", "gp_slopes", "linear", "quadratic", "rbf", "kpls"])
def test_every_model_comes_back_with_the_same_numbers(name: str, tmp_path: Path) -> None:
    before = saved(name)
    after = load_surrogate(save_surrogate(tmp_path / "s.npz", before))
    assert (after.inputs, after.outputs, after.designs) == (INPUTS, OUTPUTS, len(P.x))
    np.testing.assert_allclose(after.places(values()), P.test, atol=1e-12)
    for one, two in zip(before.predict(values()), after.predict(values()), strict=True):
        np.testing.assert_array_equal(one, two)


def test_a_fresh_process_predicts_the_same(tmp_path: Path) -> None:
    model = fit_varying(make("gp"), P.x, np.column_stack([P.y[:, :2], np.full(len(P.x), 3.0)]))
    models = {"a": Calibrated(model, np.ones(3)), "b": Calibrated(model, np.full(3, 2.0))}
    chosen = join(models, ["a", "b", "a"])
    before = SavedSurrogate("small", len(P.x), INPUTS, OUTPUTS, chosen)
    file = save_surrogate(tmp_path / "s.npz", before)
    np.save(tmp_path / "x.npy", values())
    subprocess.run(
        [sys.executable, "-c", LOAD, file, tmp_path / "x.npy", tmp_path / "y.npy"], check=True, timeout=120
    )
    np.testing.assert_array_equal(np.load(tmp_path / "y.npy"), np.stack(before.predict(values())))


def test_what_is_no_surrogate_is_refused(tmp_path: Path) -> None:
    for content in (b"", b"text", b"PK\x03\x04broken"):
        (tmp_path / "s.npz").write_bytes(content)
        with pytest.raises(InputError, match=r"is no surrogate; expected the file surrogate\.npz"):
            load_surrogate(tmp_path / "s.npz")
    np.savez(tmp_path / "other.npz", header=np.frombuffer(b'{"format": "else"}', dtype=np.uint8))
    with pytest.raises(InputError, match="is a 'else', expected 'doe-kc surrogate 3'"):
        load_surrogate(tmp_path / "other.npz")


def table(folder: Path, frame: pd.DataFrame) -> Path:
    frame.to_csv(folder / "designs.csv", index=False)
    return folder / "designs.csv"


def frame() -> pd.DataFrame:
    return pd.DataFrame(values(), columns=[f"{i.path} [{i.unit}]" for i in INPUTS])


def test_a_table_and_a_list_are_predicted(tmp_path: Path) -> None:
    file = save_surrogate(tmp_path / "s.npz", saved())
    csv, out = table(tmp_path, frame()), tmp_path / "predictions.csv"
    outcome = succeeds("predict", file, csv, "--out", out)
    assert "o0" in outcome.out
    mean, sd = saved().predict(values())
    known = pd.read_csv(out)
    np.testing.assert_allclose(known[["o0", "o1", "o2"]], mean, rtol=1e-8)
    np.testing.assert_allclose(known[["o0 sd", "o1 sd", "o2 sd"]], sd, rtol=1e-8)
    listed = table(tmp_path, pd.DataFrame({"parameter": ["P1"], "value": [207.0], "unit": ["mm"]}))
    one = predict_table(load_surrogate(file), listed)
    np.testing.assert_array_equal(one.values, [[0.0, 207.0, 0.5, 5.5, 1.0]])


def test_designs_that_were_evaluated_are_predicted_again(tmp_path: Path) -> None:
    evaluated = frame().assign(status="ok", reason="", seconds=0.1, **{"vertical.bump_steer": -3.0})
    again = predict_table(saved(), table(tmp_path, evaluated))
    np.testing.assert_array_equal(again.values, values())


def test_tied_and_fixed_parameters_may_stand_beside_the_variables(tmp_path: Path) -> None:
    """With the values that they had in the surrogate's designs, to the digits of a table."""
    offset, ratio = Tie("Q1", "P1", False, 215.0, 205.0), Tie("Q4", "P4", True, 3.0, 1.0)
    with_ties = replace(saved(), ties=(offset, ratio), fixed={"F": 7.0})
    again = load_surrogate(save_surrogate(tmp_path / "s.npz", with_ties))
    assert again.dependent_paths == ("Q1", "Q4", "F")
    beside = {"Q1": values()[:, 1] + 10.0, "Q4 [-]": 3.0 * values()[:, 4], "F": np.full(len(values()), 7.0)}
    done = predict_table(again, table(tmp_path, frame().assign(**beside).round(9)))
    np.testing.assert_allclose(done.values, values(), rtol=1e-8, atol=1e-8)
    listed = pd.DataFrame({"parameter": ["Q1", "P1", "F"], "value": ["217", "207", "7"]})
    np.testing.assert_array_equal(predict_table(again, table(tmp_path, listed)).values[0, 1], 207.0)
    with pytest.raises(InputError, match=r"row 2, column 'F': 8\.0, but .* ties or fixes it to 7 there"):
        predict_table(again, table(tmp_path, frame().assign(F=8.0, **{"F [mm]": 7.0})))
    listed.loc[0, "value"] = "216"
    with pytest.raises(InputError, match=r"row 2, Q1: 216, but .* ties or fixes it to 217 there"):
        predict_table(again, table(tmp_path, listed))


def test_bad_tables_are_named(tmp_path: Path) -> None:
    file = save_surrogate(tmp_path / "s.npz", saved())
    head = "P1 [mm]"
    holes = frame().astype(object)
    holes.loc[2, head] = None
    words = frame().astype(object)
    words.loc[1, head] = "long"
    endless = frame().astype(object)
    endless.loc[0, head] = "inf"
    low = frame()
    low["P4 [mm]"] = 0.0
    cases = {
        "no column 'P1', and 0 others": frame().drop(columns=head),
        r"column 'Q1': is no variable .* Did you mean": frame().rename(columns={head: "Q1"}),
        "unit 'm', expected 'mm'": frame().rename(columns={head: "P1 [m]"}),
        r"row 4, column 'P1 \[mm\]': the value is missing": holes,
        "'long' is not a number": words,
        "inf, expected a finite number": endless,
        "P4.*0, expected a number > 0 mm": low,
    }
    for sentence, bad in cases.items():
        fails(2, sentence, "predict", file, table(tmp_path, bad))
    fails(2, "is no surrogate", "predict", table(tmp_path, frame()), table(tmp_path, frame()))


def test_values_outside_the_bounds_are_a_warning(tmp_path: Path) -> None:
    beyond = frame()
    beyond["P1 [mm]"] += 20.0
    done = predict_table(saved(), table(tmp_path, beyond))
    assert len(done.warnings) == 1
    assert "P1 = " in done.warnings[0] and "outside the bounds [200, 210] mm" in done.warnings[0]
    assert "5 other rows" in done.warnings[0]
