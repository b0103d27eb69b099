"""The map of disagreement: its null distribution, and that it points to where something is wrong."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.projection import changes
from doe_kc.discovery.screening.contrasts import Contrasts, contrasts
from doe_kc.discovery.screening.disagreement import raw_map, residual_map
from doe_kc.discovery.thresholds import NOISE_SIZE_DOUBT
from tests.discovery.cases import model


@pytest.fixture(scope="module")
def tuned() -> Fit:
    car = model("none")
    return fit(car, car.centre)


@pytest.fixture(scope="module")
def shapes(tuned: Fit) -> Contrasts:
    return contrasts(tuned.model.likelihood)


def test_rows_are_of_unit_length_and_named_once(shapes: Contrasts) -> None:
    assert np.allclose(np.linalg.norm(shapes.rows.toarray(), axis=0), 1.0)
    assert len(set(shapes.names)) == len(shapes.names) == shapes.rows.shape[1]


def test_noise_passes_the_threshold_as_often_as_it_says(tuned: Fit, shapes: Contrasts) -> None:
    rng = np.random.default_rng(4)
    noise = rng.standard_normal((300, tuned.residual.size)) * np.sqrt(1.0 + NOISE_SIZE_DOUBT)
    first = raw_map(shapes, noise[0])
    threshold, scale = first.threshold, np.sqrt(1.0 + NOISE_SIZE_DOUBT)
    passed = np.mean([np.abs(shapes.rows.T @ row / scale).max() > threshold for row in noise])
    assert 0.01 < passed < 0.11


def test_nothing_hidden_leaves_nothing(tuned: Fit, shapes: Contrasts) -> None:
    assert residual_map(shapes, tuned.remainder, tuned.projection).chance > 0.01


def test_a_shape_that_tuning_cannot_make_is_found_where_it_is(tuned: Fit, shapes: Contrasts) -> None:
    at = next(
        i
        for i, c in enumerate(shapes.names)
        if (c.load_case, c.response, c.shape, c.wheels) == ("steer", "camber", "loop width", "both")
    )
    shifted = tuned.residual + 12.0 * shapes.rows.toarray()[:, at]
    found = residual_map(shapes, changes(tuned.jacobian, shifted, is_residual=True), tuned.projection)
    assert not found.agrees
    worst, z = found.worst(1)[0]
    assert worst == shapes.names[at]
    assert z == pytest.approx(12.0, abs=4.0)


def test_a_change_that_a_parameter_makes_is_not_counted(tuned: Fit, shapes: Contrasts) -> None:
    columns = tuned.jacobian.dense[:, : tuned.model.parameters]
    column = columns[:, int(np.argmax(np.linalg.norm(columns, axis=0)))]
    shifted = tuned.residual + 20.0 * column / np.linalg.norm(column)
    assert raw_map(shapes, shifted).largest > 8.0
    assert residual_map(shapes, changes(tuned.jacobian, shifted, is_residual=True), tuned.projection).agrees


def test_contrasts_of_no_data_are_none() -> None:
    assert contrasts(Likelihood((), ())).names == ()
