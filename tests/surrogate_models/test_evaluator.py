"""Formulas, the Python evaluator and the workbook give the surrogate's own numbers."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from openpyxl import load_workbook

from doe_kc.ground.errors import InputError
from doe_kc.reports.surrogates.evaluator import FIRST, write_evaluator
from doe_kc.surrogate_models.formula import mean_formulas
from doe_kc.surrogate_models.models import make
from doe_kc.surrogate_models.saved import SavedSurrogate
from doe_kc.surrogate_models.selection import join
from doe_kc.surrogate_models.varying import fit_varying
from tests.surrogate_models.problems import problem
from tests.surrogate_models.test_saved import P, saved, values


@pytest.mark.parametrize("name", ["gp", "gp_ard", "gp_slopes", "linear", "rbf", "kpls"])
def test_formulas_are_the_means(name: str) -> None:
    model = saved(name).model
    found = np.column_stack([f.mean(P.test) for f in mean_formulas(model)])
    np.testing.assert_allclose(found, model.predict(P.test), rtol=1e-8)


def test_a_model_without_a_formula_says_so() -> None:
    with pytest.raises(InputError, match="quadratic model has no formula"):
        mean_formulas(saved("quadratic").model)


def mixed() -> SavedSurrogate:
    """A pinned process, a plane and a constant."""
    p = problem(14)
    y = np.column_stack([p.y[:, :2], np.full(len(p.x), 3.0)])
    trend = saved("gp_slopes").model
    linear, process = fit_varying(make("linear"), p.x, y), fit_varying(make("gp"), p.x, y)
    models = {"gp_slopes": trend, "linear": linear, "gp": process}
    return replace(saved(), model=join(models, list(models)))


def test_the_python_evaluator_needs_no_doe_kc(tmp_path: Path) -> None:
    surrogate = mixed()
    write_evaluator(tmp_path, surrogate)
    changes = [f"P{k}={value!r}" for k, value in enumerate(map(float, values()[0]))]
    bare = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    out = subprocess.run(
        [sys.executable, tmp_path / "evaluate_surrogate.py", *changes],
        check=True, capture_output=True, text=True, timeout=120, cwd=tmp_path, env=bare,
    ).stdout  # fmt: skip
    assert "import doe_kc" not in (tmp_path / "evaluate_surrogate.py").read_text()
    numbers = [float(line.split()[1]) for line in out.splitlines()]
    np.testing.assert_allclose(numbers, surrogate.predict(values()[:1])[0][0], rtol=1e-8)
    assert json.loads((tmp_path / "surrogate.json").read_text())["format"].endswith("1")


@pytest.mark.skipif(shutil.which("soffice") is None, reason="needs LibreOffice to recalculate the workbook")
def test_the_workbook_calculates_the_same(tmp_path: Path) -> None:
    surrogate = mixed()
    write_evaluator(tmp_path, surrogate)
    book = load_workbook(tmp_path / "surrogate_evaluator.xlsx")
    (asked,) = book["Evaluator"].data_validations.dataValidation
    assert (asked.formula1, asked.formula2, str(asked.sqref).split(":")[0]) == (
        f"$D{FIRST}",
        f"$E{FIRST}",
        f"B{FIRST}",
    )
    for i, value in enumerate(values()[0]):
        book["Evaluator"].cell(FIRST + i, 2).value = float(value)
    book.save(tmp_path / "typed.xlsx")
    subprocess.run(
        ["soffice", "--headless", f"-env:UserInstallation=file://{tmp_path}/profile", "--convert-to",
         "xlsx:Calc MS Excel 2007 XML", "--outdir", tmp_path / "done", tmp_path / "typed.xlsx"],
        check=True, capture_output=True, timeout=180,
    )  # fmt: skip
    sheet = load_workbook(tmp_path / "done" / "typed.xlsx", data_only=True)["Evaluator"]
    numbers = [sheet.cell(FIRST + j, 9).value for j in range(3)]
    np.testing.assert_allclose(numbers, surrogate.predict(values()[:1])[0][0], rtol=1e-8)
