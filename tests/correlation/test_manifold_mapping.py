"""Manifold mapping against closed forms."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.modelled.linear_model import LinearModel
from doe_kc.correlation.modelled.manifold_mapping import ManifoldMapping

RNG = np.random.default_rng(3)
OUTPUTS = 6


def mapped(designs: int) -> tuple[ManifoldMapping, np.ndarray, np.ndarray, np.ndarray]:
    """The mapping by so many designs, of a linear relation f = A c + b, with A, b and the twin's answers."""
    a, b = RNG.normal(size=(OUTPUTS, OUTPUTS)), RNG.normal(size=OUTPUTS)
    cheap = RNG.normal(size=(designs, OUTPUTS))
    scale = RNG.uniform(0.1, 10.0, OUTPUTS)
    return ManifoldMapping.of(cheap @ a.T + b, cheap, designs // 2, scale), a, b, cheap


def test_enough_designs_give_a_linear_relation_exactly() -> None:
    mapping, a, b, _ = mapped(OUTPUTS + 1)
    other = RNG.normal(size=OUTPUTS)
    np.testing.assert_allclose(mapping.at(other), a @ other + b, rtol=1e-9, atol=1e-9)


def test_few_designs_are_met_and_other_directions_left_to_the_twin() -> None:
    mapping, a, b, cheap = mapped(3)
    for answer in cheap:
        np.testing.assert_allclose(mapping.at(answer), a @ answer + b, rtol=1e-9, atol=1e-9)


def test_one_design_alone_is_a_constant_difference() -> None:
    mapping, *_ = mapped(1)
    np.testing.assert_array_equal(mapping.matrix, np.eye(OUTPUTS))


def test_a_direction_across_the_known_ones_keeps_the_twins_change() -> None:
    cheap = np.zeros((2, 3))
    cheap[1, 0] = 2.0
    real = np.array([[1.0, 1.0, 1.0], [5.0, 2.0, 1.0]])
    mapping = ManifoldMapping.of(real, cheap, 0, np.ones(3))
    np.testing.assert_allclose(mapping.at(np.array([1.0, 0.0, 0.0])), [3.0, 1.5, 1.0])
    np.testing.assert_allclose(mapping.at(np.array([0.0, 4.0, -1.0])), [1.0, 5.0, 0.0])


def test_an_expansion_is_taken_at_its_word() -> None:
    slope, point = RNG.normal(size=(2, 3)), RNG.normal(size=3)
    model = LinearModel.expansion(point, np.array([1.0, 2.0]), slope)
    far = RNG.normal(size=(4, 3))
    np.testing.assert_allclose(model.predict(far), [1.0, 2.0] + (far - point) @ slope.T)
    assert not model.variance(far).any() and not model.variance_gradient(far).any()
    np.testing.assert_array_equal(model.gradient(far)[2], slope)
