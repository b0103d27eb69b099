"""Surrogates of stored designs by the Python API."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import doe_kc as kc
from tests.cli.runner import succeeds

MODELS = ["linear", "quadratic"]


@pytest.fixture(scope="module")
def out(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("sampled")
    kc.sample(folder, 40, out=root, workers=1)
    return root


@pytest.fixture(scope="module")
def result(folder: Path, out: Path) -> kc.SurrogatesResult:
    return kc.surrogates(folder, MODELS, out=out, workers=1)


def test_its_frames(result: kc.SurrogatesResult) -> None:
    frame = result.to_frame()
    assert frame.index.is_unique and set(frame["model"]) <= {*MODELS} and (frame["q2"] > 0.9).all()
    assert len(result.quality) == 2 * len(frame)
    assert result.influence.shape == result.shares.shape == (7, len(frame))
    assert len(result.predictions) == 40 * len(frame)
    assert len(repr(result)) < 500 and "linear" in result._repr_html_()


def test_it_predicts_as_an_estimator(result: kc.SurrogatesResult, folder: Path, out: Path) -> None:
    sampling = kc.sample(folder, 40, out=out, workers=1)
    mean, sd = result.surrogate.predict(sampling.designs, return_std=True)
    assert list(mean.columns) == list(result.to_frame().index) and (sd.to_numpy() > 0.0).all()
    spread = sampling.responses[mean.columns].std().to_numpy()
    error = np.abs((mean - sampling.responses[mean.columns]).to_numpy()).max(axis=0)
    assert (error < spread).all()
    direct = kc.Surrogate(MODELS, space=sampling.space, seed=1).fit(sampling.designs, sampling.responses)
    assert np.allclose(direct.predict(sampling.designs)[mean.columns], mean, rtol=1e-9, atol=1e-9)


def test_its_picture_is_of_the_worst(result: kc.SurrogatesResult) -> None:
    assert result.to_frame()["q2"].idxmin() in result.plot().get_title()
    with pytest.raises(kc.InputError, match="vertical"):
        result.plot("vertical.bump_stear")


def test_the_command_gives_the_same(result: kc.SurrogatesResult, folder: Path, out: Path) -> None:
    before = pd.read_csv(out / "surrogates" / "quality.csv")
    target = out / "surrogates.json"
    succeeds(
        "surrogates", folder, "--out", out, "--models", ",".join(MODELS), "--json", target, "--workers", 1
    )
    assert before.equals(pd.read_csv(out / "surrogates" / "quality.csv"))
    assert json.loads(target.read_text())["chosen"] == result.to_frame()["model"].to_dict()


def test_without_designs(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(kc.InputError, match="run doe-kc sample"):
        kc.surrogates(folder, out=tmp_path)
