"""The influence matrix of the Python API."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import doe_kc as kc


@pytest.fixture(scope="module")
def steps() -> list[tuple[str, int, int]]:
    return []


@pytest.fixture(scope="module")
def result(folder: Path, steps: list[tuple[str, int, int]]) -> kc.InfluenceResult:
    return kc.influence(folder, workers=1, progress=lambda *step: steps.append(step))


def test_its_matrices(result: kc.InfluenceResult) -> None:
    percent, exact = result.to_frame(), result.to_frame("exact")
    assert percent.shape == (5, 21) and result.to_frame(every=True).shape == (5, 30)
    slopes = kc.sensitivities(result.study.axle, list(percent.index), list(percent.columns)).to_frame()
    step = kc.parameters(result.study.axle).loc[percent.index, "step"]
    np.testing.assert_allclose(exact, slopes.mul(step, axis=0), rtol=1e-8, atol=1e-12)
    absolute = result.to_frame("absolute")
    np.testing.assert_allclose(percent, 100.0 * absolute / absolute.abs().max(), atol=1e-9)
    with pytest.raises(kc.InputError, match="expected percent, absolute or exact"):
        result.to_frame("relative")  # type: ignore[arg-type]


def test_its_selection(result: kc.InfluenceResult) -> None:
    assert result.selection is not None
    assert set(result.selection.index) == set(result.to_frame().index) and not result.failures


def test_its_progress(result: kc.InfluenceResult, steps: list[tuple[str, int, int]]) -> None:
    assert {what for what, _, _ in steps} == {"one at a time"}
    assert steps[-1][1:] == (11, 11) and [s[1] for s in steps] == sorted(s[1] for s in steps)


def test_its_heat_map(result: kc.InfluenceResult) -> None:
    axes = result.plot()
    (mesh,) = [c for c in axes.collections if c.get_array() is not None]
    np.testing.assert_allclose(np.ravel(mesh.get_array()), result.to_frame().to_numpy().ravel())
    assert [t.get_text() for t in axes.get_yticklabels()] == list(result.to_frame().index)
    shown = {float(t.get_text()) for t in axes.texts}
    assert {100.0, -100.0} & shown and min(map(abs, shown)) >= 5.0


def test_it_writes_what_the_command_writes(result: kc.InfluenceResult, tmp_path: Path) -> None:
    written = {p.name: p for p in result.write(tmp_path)}
    assert set(written) == {
        "influence.xlsx",
        "report.html",
        *(f"influence_{k}.csv" for k in ("percent", "absolute", "exact")),
    }
    table = pd.read_csv(written["influence_percent.csv"], index_col="parameter")
    pd.testing.assert_frame_equal(table, result.to_frame(), check_exact=False, rtol=1e-8)
    assert written["influence.xlsx"].parent == tmp_path / "influence"
    assert "5 parameters x 21 characteristics" in repr(result) and len(repr(result)) < 500


def test_global_sensitivities_beside_it(folder: Path, tmp_path: Path) -> None:
    steps: list[tuple[str, int, int]] = []
    both = kc.influence(
        folder, methods={"morris": 4, "pawn": 50}, workers=1, out=tmp_path,
        progress=lambda *step: steps.append(step),
    )  # fmt: skip
    frame = both.overall("morris").set_index(["variable", "characteristic"])
    assert frame.loc[("ROB.z", "vertical.bump_steer"), "mu_star"] > 1.0
    assert set(both.overall("pawn")) >= {
        "variable",
        "characteristic",
        "effect",
        "share",
        "median",
        "median_error",
    }
    assert steps[-1] == ("global", 4 * 8 + 50, 4 * 8 + 50) and isinstance(both.not_linear, list)
    assert (tmp_path / "influence" / "influence_global.csv").is_file()
    with pytest.raises(kc.InputError, match="'sobol' was not among the methods; known are morris, pawn"):
        both.overall("sobol")
    with pytest.raises(kc.InputError, match="'fast' is no method of global sensitivity"):
        kc.influence(folder, methods=["fast"])
