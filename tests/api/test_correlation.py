"""Correlations of the Python API."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import doe_kc as kc
from tests.cli.runner import invoke, succeeds


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("out")


@pytest.fixture(scope="module")
def result(folder: Path, out: Path) -> kc.CorrelationResult:
    return kc.correlate(folder, method="gauss_newton", budget=5, out=out, workers=1)


def test_its_frames(result: kc.CorrelationResult) -> None:
    assert result.status == "doubtful" and "Out of reach" in result.reasons[0]
    values = kc.simulate(result.axle).characteristics["value"]
    np.testing.assert_allclose(result.to_frame()["final"], values[result.characteristics.index], rtol=1e-9)
    assert list(result.parameters.index) == list(result.study.space.paths)
    final = result.parameters["final"]
    np.testing.assert_allclose(final, kc.parameters(result.axle).loc[final.index, "nominal"], rtol=1e-12)
    assert len(result.evaluations) <= 5 and len(result.curves) == 5


def test_it_says_it_shortly(result: kc.CorrelationResult) -> None:
    assert repr(result).startswith("CorrelationResult: Doubtful: ") and len(repr(result)) < 700
    assert len(repr(result.correlation)) < 200
    assert "<table" in result._repr_html_()


def test_its_picture(result: kc.CorrelationResult) -> None:
    lines = {line.get_label(): np.asarray(line.get_xdata()) for line in result.plot().get_lines()}
    np.testing.assert_array_equal(np.abs(lines["final"]) <= 1.0, result.characteristics["inside"])
    assert lines["baseline"].shape == lines["final"].shape


def test_out_is_the_folder_of_the_command(result: kc.CorrelationResult, folder: Path, out: Path) -> None:
    assert {p.name for p in out.iterdir()} == {"correlate", "store"} and not (folder / "out").exists()
    assert kc.read_axle(out / "correlate" / "axle.toml").values == pytest.approx(result.axle.values)
    outcome = invoke("report", folder, "--out", out)
    assert outcome.code in (0, 1) and result.assessment.line in outcome.out
    succeeds("check", folder)


def test_bad_options(folder: Path) -> None:
    with pytest.raises(kc.InputError, match="gauss_newton"):
        kc.correlate(folder, method="gaus_newton")
