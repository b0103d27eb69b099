"""What holds for every registered surrogate."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.surrogate_models.interface import Fitted, LeftOut, SurrogateModel
from doe_kc.surrogate_models.models import SURROGATES, make
from doe_kc.surrogate_models.models.gp import FirstOrderTrend
from doe_kc.surrogate_models.models.gp_slopes import SlopeProcess
from doe_kc.surrogate_models.training import Scaling
from tests.surrogate_models.problems import differences, outputs, problem

ALL = sorted(SURROGATES)
P = problem()
SPREAD = Scaling.of(P.y).scale
ROUNDING = 1e-8
"""Of a variance: the small difference between the prior's and what the rows explain."""
LEAST_Q2 = {"linear": 0.5, "quadratic": 0.9}
"""Of the wave; what passes through the rows does better than 0.95."""


@cache
def fitted(name: str) -> Fitted:
    return model(name).fit(P.x, P.y, seed=3)


def model(name: str, which: list[int] | None = None) -> SurrogateModel:
    """With the expansion at the middle, for those that use one. which: outputs."""
    if not SURROGATES[name].uses_slopes:
        return make(name)
    at = np.full(5, 0.5)
    trend = FirstOrderTrend(at, outputs(at[None])[0], differences(outputs, at[None], 1e-5)[0])
    return SlopeProcess(trend if which is None else trend.of(np.array(which)))


def test_every_surrogate_says_what_it_is() -> None:
    kinds = list(SURROGATES.values())
    assert {"gp", "gp_ard", "kriging", "kpls", "rbf", "linear", "quadratic"} <= set(SURROGATES)
    assert len({k.complexity for k in kinds}) == len(kinds)
    for name, kind in SURROGATES.items():
        assert kind.id == name
        assert kind.label
        assert kind().fewest(5) >= 3


@pytest.mark.parametrize("name", ALL)
def test_shapes_and_signs(name: str) -> None:
    done = fitted(name)
    assert (done.variables, done.outputs) == (5, 3)
    assert done.predict(P.test).shape == done.variance(P.test).shape == (6, 3)
    assert done.gradient(P.test).shape == done.variance_gradient(P.test).shape == (6, 3, 5)
    assert (done.variance(P.test) >= 0.0).all()
    assert (done.variance(P.x) >= 0.0).all()


@pytest.mark.parametrize("name", ALL)
def test_the_model_of_some_outputs_predicts_them_alike(name: str) -> None:
    whole, some = fitted(name), np.array([2, 0])
    part = whole.of(some)
    assert (part.variables, part.outputs) == (5, 2)
    for ask in ("predict", "variance", "gradient", "variance_gradient"):
        ours, all_of_them = (getattr(m, ask)(P.test) for m in (part, whole))
        np.testing.assert_allclose(ours, all_of_them[:, some], rtol=ROUNDING, atol=1e-12)
    held, of_all = part.cross_validate(), whole.cross_validate()
    np.testing.assert_allclose(held.residual, of_all.residual[:, some], rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(held.variance, of_all.variance[:, some], rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("name", ALL)
def test_it_predicts(name: str) -> None:
    from tests.surrogate_models.problems import points

    x = points(200, 50)
    error = fitted(name).predict(x) - outputs(x)
    q2 = 1.0 - np.square(error).mean(axis=0) / outputs(x).var(axis=0)
    assert (q2 > LEAST_Q2.get(name, 0.9)).all(), q2


@pytest.mark.parametrize("name", ALL)
def test_gradients_are_those_of_the_predictions(name: str) -> None:
    done = fitted(name)
    found = done.gradient(P.test) / SPREAD[:, None]
    wanted = differences(done.predict, P.test, 2e-3) / SPREAD[:, None]
    assert np.abs(found - wanted).max() < 1e-5 * np.abs(wanted).max()


@pytest.mark.parametrize("name", ALL)
def test_variance_gradients_are_those_of_the_variance(name: str) -> None:
    done = fitted(name)
    found = done.variance_gradient(P.test) / SPREAD[:, None] ** 2
    wanted = differences(done.variance, P.test, 2e-3) / SPREAD[:, None] ** 2
    assert np.abs(found - wanted).max() <= 1e-5 * max(np.abs(wanted).max(), 1e-2)


@pytest.mark.parametrize("name", ALL)
def test_all_at_once_is_the_same(name: str) -> None:
    done = fitted(name)
    everything = done.predict_all(P.test)
    np.testing.assert_allclose(everything.mean, done.predict(P.test), rtol=1e-12)
    np.testing.assert_allclose(everything.variance, done.variance(P.test), rtol=1e-9)
    np.testing.assert_allclose(everything.gradient, done.gradient(P.test), rtol=1e-12)
    np.testing.assert_allclose(everything.variance_gradient, done.variance_gradient(P.test), rtol=1e-9)


@pytest.mark.parametrize("name", [n for n in ALL if SURROGATES[n].interpolates])
def test_it_passes_through_its_rows(name: str) -> None:
    error = (fitted(name).predict(P.x) - P.y) / SPREAD
    assert np.abs(error).max() < 1e-3
    if name != "rbf":  # whose variance is the same everywhere
        assert (fitted(name).variance(P.x) / SPREAD**2).max() < 1e-5


@pytest.mark.parametrize("name", ALL)
def test_it_is_the_same_again_and_leaves_its_data_alone(name: str) -> None:
    x, y = P.x.copy(), P.y.copy()
    again = model(name).fit(x, y, seed=3)
    assert (x == P.x).all()
    assert (y == P.y).all()
    x[:], y[:] = 0.5, 0.0
    np.testing.assert_array_equal(again.predict(P.test), fitted(name).predict(P.test))
    np.testing.assert_array_equal(again.variance(P.test), fitted(name).variance(P.test))


@pytest.mark.parametrize("name", ALL)
def test_the_order_of_the_outputs_does_not_matter(name: str) -> None:
    other = model(name, [2, 0, 1]).fit(P.x, P.y[:, [2, 0, 1]], seed=3)
    expected = fitted(name).predict(P.test)[:, [2, 0, 1]]
    iterated = name == "gp_ard"  # by a maximisation that round-off leads another way
    error = np.abs(other.predict(P.test) - expected) / SPREAD[[2, 0, 1]]
    assert error.max() < (1e-4 if iterated else 1e-6)


@pytest.mark.parametrize("name", ALL)
def test_units_do_not_matter(name: str) -> None:
    kind = model(name)
    if isinstance(kind, SlopeProcess) and kind.trend is not None:
        t = kind.trend
        kind = SlopeProcess(FirstOrderTrend(t.point, 1e-4 * t.value + 7.0, 1e-4 * t.slope))
    other = kind.fit(P.x, 1e-4 * P.y + 7.0, seed=3)
    expected = 1e-4 * fitted(name).predict(P.test) + 7.0
    assert np.abs(other.predict(P.test) - expected) / (1e-4 * SPREAD) == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize("name", ALL)
def test_left_out_residuals_have_the_shape_of_the_data(name: str) -> None:
    held = fitted(name).cross_validate()
    assert isinstance(held, LeftOut)
    assert held.residual.shape == held.variance.shape == P.y.shape
    assert (held.variance > 0.0).all()
    assert (np.square(held.residual).sum(axis=0) < np.square(P.y - P.y.mean(axis=0)).sum(axis=0)).all()


@pytest.mark.parametrize("name", ALL)
def test_many_points_come_in_chunks(name: str) -> None:
    from tests.surrogate_models.problems import points

    x = points(2500, 9)
    whole = fitted(name).predict(x)
    some = [0, 1200, 2499]
    assert np.abs((whole[some] - fitted(name).predict(x[some])) / SPREAD).max() < 1e-6


@pytest.mark.parametrize("name", ALL)
def test_bad_data_is_named(name: str) -> None:
    kind = model(name)
    holes = P.y.copy()
    holes[4, 1] = np.nan
    constant = P.y.copy()
    constant[:, 2] = 3.0
    twice = np.vstack([P.x[:-1], P.x[:1]])
    cases = {
        "not finite, the first is row 5": (P.x, holes),
        "output 3 has the same value in every design": (P.x, constant),
        "design 40 is there twice": (twice, P.y),
        "40 points but 39 rows": (P.x, P.y[1:]),
        "2 designs for 5 variables, needs at least": (P.x[:2], P.y[:2]),
        "values of shape": (P.x, P.y[:, 0]),
    }
    for words, (x, y) in cases.items():
        with pytest.raises(InputError, match=words):
            kind.fit(x, y)
    with pytest.raises(InputError, match="points of 4 variables, fitted with 5"):
        fitted(name).predict(P.test[:, :4])


def test_an_unknown_name_is_corrected() -> None:
    with pytest.raises(InputError, match=r'study: models: \'krigin\' .* Did you mean "kriging"'):
        make("krigin", "study")


@pytest.mark.parametrize("name", ["gp", "gp_ard", "gp_slopes"])
def test_many_points_are_predicted_as_few(name: str) -> None:
    """Outputs one by one for many points, all abreast for few."""
    many = np.random.default_rng(8).random((90, P.x.shape[1]))
    few = np.concatenate([fitted(name).predict(many[k : k + 30]) for k in (0, 30, 60)])
    np.testing.assert_allclose(fitted(name).predict(many) / SPREAD, few / SPREAD, atol=1e-9)
