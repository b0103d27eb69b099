"""The estimator of the Python API, by the conventions of scikit-learn."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from sklearn.base import clone
from sklearn.exceptions import NotFittedError
from sklearn.model_selection import cross_val_score
from sklearn.pipeline import make_pipeline

import doe_kc as kc

FAST = ["linear", "quadratic"]


def data(n: int, seed: int = 0) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Designs in real units, and a plane and a curved response of them."""
    rng = np.random.default_rng(seed)
    x = pd.DataFrame({"LLF.z": rng.uniform(209.0, 215.0, n), "llr.Fx": rng.uniform(0.5, 2.0, n)})
    return x, pd.DataFrame({"plane": 3.0 * x["LLF.z"] - 2.0 * x["llr.Fx"], "bowl": x["llr.Fx"] ** 2})


@pytest.fixture(scope="module")
def sampling(folder: Path) -> kc.SamplingResult:
    return kc.sample(folder, 40, workers=1)


@pytest.fixture(scope="module")
def model(sampling: kc.SamplingResult) -> kc.Surrogate:
    return kc.Surrogate(FAST, space=sampling.space).fit(sampling.designs[:30], sampling.responses[:30])


def test_it_predicts_the_true_solver(model: kc.Surrogate, sampling: kc.SamplingResult) -> None:
    designs, truth = sampling.designs[30:], sampling.responses[30:]
    mean, sd = model.predict(designs, return_std=True)
    assert list(mean.columns) == list(truth.columns) and list(mean.index) == list(truth.index)
    error = (mean - truth)["vertical.bump_steer"]
    assert error.std() < 0.1 * truth["vertical.bump_steer"].std()
    assert (error.abs() < 4.0 * sd["vertical.bump_steer"]).all()
    assert model.score(designs, truth) > 0.8
    assert model.to_frame().loc["vertical.bump_steer", "q2"] > 0.99


def test_the_bounds_are_those_of_the_space(model: kc.Surrogate, sampling: kc.SamplingResult) -> None:
    assert list(model.feature_names_in_) == list(sampling.space.paths)
    design = sampling.designs[:1]
    np.testing.assert_allclose(
        model._unit(design.to_numpy())[0], sampling.space.unit(design.iloc[0].to_dict()), rtol=1e-12
    )
    factor = sampling.space.paths.index("llr.Fx")
    assert sampling.space.variables[factor].logarithmic
    assert model._unit(np.where(np.arange(7) == factor, 1.0, design.to_numpy()))[0, factor] == pytest.approx(
        0.5
    )


def test_without_a_space_the_data_are_the_bounds() -> None:
    x, y = data(30)
    model = kc.Surrogate(FAST).fit(x, y)
    np.testing.assert_array_equal(model.lower_, x.min())
    np.testing.assert_array_equal(model.upper_, x.max())
    new, truth = data(20, seed=1)
    np.testing.assert_allclose(model.predict(new), truth, rtol=1e-6)
    assert model.score(new, truth) == pytest.approx(1.0)


def test_columns_are_taken_by_name() -> None:
    x, y = data(30)
    model = kc.Surrogate(FAST).fit(x, y)
    other = x[["llr.Fx", "LLF.z"]].assign(label="design")
    pd.testing.assert_frame_equal(model.predict(other), model.predict(x))


@pytest.mark.parametrize("form", ["frame", "series", "vector", "matrix"])
def test_the_answer_is_shaped_as_y(form: str) -> None:
    x, y = data(30)
    given: Any = {
        "frame": y, "series": y["bowl"], "vector": y["bowl"].to_numpy(), "matrix": y.to_numpy()
    }[form]  # fmt: skip
    mean, sd = kc.Surrogate(FAST).fit(x, given).predict(x, return_std=True)
    assert type(mean) is type(given) is type(sd) and mean.shape == given.shape == sd.shape
    np.testing.assert_allclose(mean, given, rtol=1e-6)


def test_the_conventions_of_estimators(sampling: kc.SamplingResult) -> None:
    x, y = data(40)
    model = kc.Surrogate(FAST, folds=5, seed=3, space=sampling.space)
    copy = clone(model)
    assert copy is not model and copy.get_params().keys() == {"models", "space", "folds", "seed", "workers"}
    assert copy.get_params()["seed"] == 3 and copy.space == sampling.space
    assert copy.set_params(space=None, models=["linear"]) is copy and copy.models == ["linear"]
    assert copy.fit(x, y["plane"]) is copy
    assert (cross_val_score(kc.Surrogate(FAST), x, y, cv=3) > 0.999).all()
    assert make_pipeline(kc.Surrogate(FAST)).fit(x, y).score(x, y) > 0.999
    with pytest.raises(NotFittedError):
        clone(copy).predict(x)


def test_the_same_seed_gives_the_same_surrogate() -> None:
    x, y = data(20)
    first, second = (kc.Surrogate(["gp"], seed=1).fit(x, y).predict(x) for _ in range(2))
    pd.testing.assert_frame_equal(first, second)


def test_its_picture(model: kc.Surrogate) -> None:
    axes = model.plot("vertical.bump_steer")
    np.testing.assert_allclose(
        axes.get_lines()[1].get_xdata(), model.study_.y[:, model.output_names_.index("vertical.bump_steer")]
    )
    with pytest.raises(kc.InputError, match="no output"):
        model.plot("vertical.bump")
    assert "Surrogate" in repr(model) and len(repr(kc.Surrogate(FAST))) < 200


def bad(x: pd.DataFrame, y: pd.DataFrame, case: str) -> tuple[Any, Any]:
    """Data with one thing wrong."""
    if case == "sizes":
        return x, y[:-1]
    if case == "nan":
        return x.where(np.arange(30)[:, None] != [4, 4]), y
    if case == "words":
        return x.assign(label="a"), y
    if case == "fixed":
        return x.assign(same=1.0), y
    if case == "few":
        return x[:5], y[:5]
    if case == "equal":
        return x.iloc[[0, 0, *range(2, 30)]], y
    return x["LLF.z"].to_numpy(), y


@pytest.mark.parametrize(
    ("case", "message"),
    [
        ("sizes", "30 designs but 29 rows of y"),
        ("nan", r"row 5 of X, column 'LLF\.z': is not a finite number"),
        ("words", "X holds what is no number"),
        ("fixed", "column 'same' of X never changes"),
        ("few", "5 designs, needs at least 10"),
        ("equal", "design 2 is there twice"),
        ("flat", "one row a design"),
    ],
)
def test_data_that_no_surrogate_can_be_fitted_to(case: str, message: str) -> None:
    with pytest.raises(kc.InputError, match=message):
        kc.Surrogate(FAST).fit(*bad(*data(30), case))


def test_columns_that_the_space_does_not_have(sampling: kc.SamplingResult) -> None:
    designs, responses = sampling.designs, sampling.responses
    with pytest.raises(kc.InputError, match="the column 'status', no variable of the space"):
        kc.Surrogate(FAST, space=sampling.space).fit(designs.assign(status="ok"), responses)
    with pytest.raises(kc.InputError, match=r"X has no column 'ROB\.z'"):
        kc.Surrogate(FAST, space=sampling.space).fit(designs.drop(columns="ROB.z"), responses)
    with pytest.raises(kc.InputError, match=r"linearr"):
        kc.Surrogate(["linearr"]).fit(designs, responses)
