"""Global methods on functions whose indices are known, and against SALib's own."""

from __future__ import annotations

import math

import numpy as np
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.global_methods import GLOBAL_METHODS, GlobalIndex, find_global_method
from doe_kc.parameter_influence.global_methods._base import salib
from doe_kc.parameter_influence.global_methods.pawn import PAWN_SLICES, pawn_medians
from doe_kc.parameter_influence.options import InfluenceOptions

A, B = 7.0, 0.1


def ishigami(points: FloatArray) -> FloatArray:
    """(n, 1) sin x + 7 sin² y + 0.1 z⁴ sin x of x, y, z in -+pi (Ishigami and Homma 1990)."""
    x, y, z = (2.0 * points.T - 1.0) * math.pi
    return np.asarray(np.sin(x) + A * np.sin(y) ** 2 + B * z**4 * np.sin(x))[:, None]


def truth() -> tuple[FloatArray, FloatArray]:
    """First-order and total shares in closed form."""
    one = 0.5 * (1.0 + B * math.pi**4 / 5.0) ** 2
    two = A**2 / 8.0
    both = B**2 * math.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    full = one + two + both
    return np.array([one, two, 0.0]) / full, np.array([one + both, two, both]) / full


def indices(method: str, size: int, points: FloatArray | None = None) -> dict[str, GlobalIndex]:
    chosen = find_global_method(method, "test")
    sample = chosen.points(3, size, 1) if points is None else points
    assert sample.shape == (size * chosen.block(3), 3)
    assert sample.min() >= 0.0 and sample.max() <= 1.0
    np.testing.assert_array_equal(sample, chosen.points(3, size, 1))
    return {i.id: i for i in chosen.indices(sample, ishigami(sample), np.zeros((len(sample), 1)), 1)}


def test_sobol_of_ishigami() -> None:
    done = indices("sobol", 2048)
    first, total = truth()
    np.testing.assert_allclose(done["first"].values[:, 0], first, atol=0.03)
    np.testing.assert_allclose(done["total"].values[:, 0], total, atol=0.03)
    for index, known in (("first", first), ("total", total)):
        assert np.all(np.abs(done[index].values[:, 0] - known) <= 1.5 * done[index].error[:, 0] + 1e-9)
        assert 0.0 < done[index].error.max() < 0.15


def test_what_slopes_miss_of_ishigami() -> None:
    """With the slope of sin x at 0 taken off, y and z are missed wholly; of a plane nothing is."""
    chosen = find_global_method("sobol", "test")
    points = chosen.points(3, 1024, 1)
    x = (2.0 * points[:, :1] - 1.0) * math.pi
    y = ishigami(points)
    done = {i.id: i.values[:, 0] for i in chosen.indices(points, y, x, 1)}
    np.testing.assert_allclose(done["missed"][1:], done["total"][1:], rtol=1e-6)
    plain = {i.id: i.values[:, 0] for i in chosen.indices(points, x, x, 1)}
    np.testing.assert_array_equal(plain["missed"], 0.0)
    np.testing.assert_allclose(plain["total"], [1.0, 0.0, 0.0], atol=0.05)
    bent = {i.id: i for i in find_global_method("morris", "test").indices(*_bent())}
    np.testing.assert_allclose(bent["missed"].values[:, 0], [0.0, bent["sigma"].values[1, 0]], atol=1e-9)


def _bent() -> tuple[FloatArray, FloatArray, FloatArray, int]:
    """A plane and, beyond it, a parabola without a mean slope, on trajectories through a square."""
    points = find_global_method("morris", "test").points(2, 40, 2)
    points = np.vstack([points, 1.0 - points])
    plane = 2.0 * points[:, :1]
    return points, plane + (points[:, 1:] - 0.5) ** 2, plane, 1


def test_morris_of_a_plane_and_of_ishigami() -> None:
    chosen = find_global_method("morris", "test")
    points = chosen.points(3, 10, 2)
    plane = (points @ np.array([3.0, -2.0, 0.0]))[:, None]
    mean, sigma, missed = chosen.indices(points, plane, plane, 1)
    np.testing.assert_allclose(missed.values, 0.0, atol=1e-12)
    np.testing.assert_allclose(mean.values[:, 0], [3.0, 2.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(sigma.values, 0.0, atol=1e-12)
    done = indices("morris", 60)
    assert np.all(done["sigma"].values > 0.3 * done["mu_star"].values)  # none of its effects is constant


def test_pawn_is_salibs() -> None:
    rng = np.random.default_rng(3)
    points = rng.random((300, 4))
    values = np.column_stack([points[:, 0] ** 2 + 0.3 * points[:, 1], np.round(4.0 * points[:, 2])])
    problem = {"num_vars": 4, "names": list("abcd"), "bounds": [[0.0, 1.0]] * 4}
    analyze = salib("analyze.pawn", "PAWN").analyze
    theirs = np.column_stack([analyze(problem, points, y, S=PAWN_SLICES)["median"] for y in values.T])
    np.testing.assert_allclose(pawn_medians(points, values), theirs, atol=1e-12)


def test_pawn_of_ishigami() -> None:
    """Ranked as in Pianosi and Wagener 2018; the third acts at the ends of its range alone, so that the
    median of its slices is that of chance."""
    done = indices("pawn", 800)
    median, chance = done["median"].values[:, 0], done["chance"].values[:, 0]
    assert np.all(median[:2] > 2.0 * chance[:2]) and median[1] > median[0] > median[2]
    assert np.all((done["median"].error > 0.0) & (done["median"].error < 0.2))


def test_every_method_has_its_size_in_the_study() -> None:
    options = InfluenceOptions()
    assert set(GLOBAL_METHODS) == {"morris", "sobol", "pawn"}
    for name, method in GLOBAL_METHODS.items():
        assert getattr(options, name) > 0 and method.label and method.id == name


def test_names_and_extras_that_are_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match=r"--global: 'soboll' is no method .* Did you mean \"sobol\"\?"):
        find_global_method("soboll", "--global")
    monkeypatch.setitem(__import__("sys").modules, "SALib.sample.sobol", None)
    with pytest.raises(InputError, match=r"needs the extra `sensitivity`; install doe-kc\[sensitivity\]"):
        find_global_method("sobol", "--global").points(3, 8, 1)
