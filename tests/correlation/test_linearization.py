"""First-order expansions against differences of solved characteristics."""

from __future__ import annotations

import numpy as np

from doe_kc.axle import with_values
from doe_kc.axle.parameters import internal_gradient
from doe_kc.characteristics import reduce_all
from doe_kc.correlation.linearization import linearize, to_places, value_gradients
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.variables import VariableOptions, build_space
from tests.discovery.cases import nominal

STEP = 2e-3
FORWARD = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0
"""Of five equidistant values, for the derivative at the first: exact for polynomials of degree four."""


def test_at_a_rigid_strut_the_derivative_is_the_one_sided_one() -> None:
    """At 0 itself: a flexibility of 0.001, whose derivative is 1e-6 to 1e-5 away, does not stand for it."""
    space = build_space(nominal(), VariableOptions(use=["strut.flexibility"]), "test")
    assert space.start == 0.0

    def characteristics(place: float) -> FloatArray:
        axle = with_values(nominal(), space.values(np.array([place])))
        return np.array(list(reduce_all(curve_set(solve(axle))).values()))

    differences = FORWARD @ [characteristics(k * STEP) for k in range(5)] / STEP
    exact = linearize(nominal(), space, space.start).characteristics[:, 0]
    moved = np.abs(differences) > 0.01
    assert moved.sum() >= 10
    np.testing.assert_allclose(exact[moved], differences[moved], rtol=1e-7)


def test_a_direction_of_internal_values_is_the_path_that_moves_them() -> None:
    """Per unit of the parameter, where a variable's column is per unit of its place between the bounds."""
    space = build_space(nominal(), VariableOptions(use=["spring.rate", "ROB.z"]), "test")
    there = with_values(nominal(), space.values(space.start))
    directions = {
        "rate": internal_gradient(there, "spring.rate"),
        "height": internal_gradient(there, "ROB.z"),
    }
    curves = value_gradients(there, solve(there), space, directions, "gain")
    order = [curves.paths.index(path) for path in ("spring.rate", "ROB.z")]
    assert curves.paths[2:] == ("rate", "height", "gain")
    slopes = space.slopes(space.start)[order]
    for case in curves.cases.values():
        for values in case.values():
            columns = to_places(values, space, space.slopes(space.start))
            np.testing.assert_allclose(columns[..., 2:4] * slopes, columns[..., order], atol=1e-12)


def test_what_follows_a_variable_moves_with_it() -> None:
    """A tied path has no column of its own: that of its leader holds it."""
    tied = VariableOptions.model_validate(
        {"use": ["spring.rate", "ROB.z"], "change": [{"match": "RIB.z", "tie": "ROB.z"}]}
    )
    space = build_space(nominal(), tied, "test")
    assert len(space.ties) == 1 and space.ties[0].slope == 1.0
    axle, solution = nominal(), solve(nominal())
    free = build_space(nominal(), VariableOptions(use=["spring.rate", "ROB.z", "RIB.z"]), "test")
    own = value_gradients(axle, solution, space, {}, "gain")
    alone = value_gradients(axle, solution, free, {}, "gain")
    rob, rib = (alone.paths.index(path) for path in ("ROB.z", "RIB.z"))
    slopes = free.slopes(free.start)
    share = slopes[rob] / slopes[rib]
    for case, responses in own.cases.items():
        for response, values in responses.items():
            columns = to_places(values, space, space.slopes(space.start))
            expected = to_places(alone.cases[case][response], free, free.slopes(free.start))
            both = expected[..., rob] + share * expected[..., rib]
            np.testing.assert_allclose(columns[..., own.paths.index("ROB.z")], both, atol=1e-9)
            np.testing.assert_allclose(columns[..., -1], expected[..., -1], atol=1e-12)
