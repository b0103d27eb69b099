"""The matrix and its derivatives against the study's and finite differences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle.design_parameters import design_parameters
from doe_kc.characteristics import CHARACTERISTICS, appendix_c, reduce_all
from doe_kc.effects import apply_effect
from doe_kc.identification.matrix_model import in_windows, influence_matrix
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.parameter_influence.study import exact_changes
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests import axle_type_reference as axle_types
from tests.identification.cases import ROWS, car_matrix, model
from tests.reference import nominal


@pytest.mark.parametrize("technique", ["body", "counter_phase"])
def test_short_sweeps_have_the_matrix_of_long_ones(technique: str) -> None:
    axle = replace(
        nominal(), load_cases={**nominal().load_cases, "roll": ROLL_TECHNIQUES[technique]}
    )  # fmt: skip
    rows = [p for p in design_parameters(axle) if p.path in ROWS]
    full = exact_changes(axle, rows, appendix_c())
    short = in_windows(axle)
    assert max(c.steps for c in short.load_cases.values()) <= 10 < axle.load_cases["vertical"].steps
    own = influence_matrix(short, [p.path for p in rows], appendix_c())
    np.testing.assert_allclose(own, full, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("axle_type", axle_types.TYPES)
def test_every_parameter_of_every_axle_type_has_its_row(axle_type: str) -> None:
    axle = axle_types.nominal(axle_type)
    rows = [p for p in design_parameters(axle) if p.in_model]
    columns = [c for c in CHARACTERISTICS.values() if c.load_case == "vertical"]
    own = influence_matrix(in_windows(axle), [p.path for p in rows], columns)
    np.testing.assert_allclose(own, exact_changes(axle, rows, columns), rtol=1e-6, atol=1e-9)


def test_friction_keeps_its_loops() -> None:
    axle = apply_effect(nominal(), "strut_friction", {}, source="test")
    assert in_windows(axle) is axle


def test_a_factors_step_is_a_tenth_of_its_value() -> None:
    m = model(car_matrix())
    stiffer = m.unknowns.axle_at(np.array([0.0, 0.0, 1.0, 0.0]))
    own = influence_matrix(stiffer, ["llr.Fx"], m.measured.characteristics)
    np.testing.assert_allclose(
        m.matrix(np.array([0.0, 0.0, 1.0, 0.0]))[ROWS.index("llr.Fx")], own[0], rtol=1e-9, atol=1e-12
    )


def test_a_wheel_of_its_own_radius_takes_the_contact_point_along() -> None:
    """Against central differences of 0.1 mm: every point but the wheel centre lower, ground and wheel as they
    were."""
    axle, columns = in_windows(nominal()), appendix_c()
    rows = ["LWB.z", "WLC.z"]
    held = influence_matrix(axle, rows, columns, wheel_radius_held=True)
    plain = influence_matrix(axle, rows, columns)
    np.testing.assert_allclose(held[0], plain[0], rtol=1e-12)
    heights = [n for n in axle.values if n.partition("@")[0].endswith(".z") and not n.startswith("WLC")]
    ends = []
    for lower in (0.1, -0.1):
        values = reduce_all(curve_set(solve(axle.changed({n: axle.values[n] - lower for n in heights}))))
        ends.append(np.array([values[c.id] for c in columns]))
    slope = (ends[0] - ends[1]) / 0.2
    assert (np.abs(held[1] - slope) <= 1e-3 * np.abs(slope) + 1e-4 * np.abs(plain).max(axis=0)).all()
    kinematic = [c.load_case in ("vertical", "roll", "steer") for c in columns]
    peaks = np.abs(plain).max(axis=0)[
        kinematic
    ]  # the body rolls about the ground, so that height counts a bit
    assert (np.abs(held[1] - plain[1])[kinematic] <= 3e-3 * peaks).all()
    lateral = [c.id for c in columns].index("lateral.camber_change")
    assert abs(held[1][lateral]) > 5.0 * abs(plain[1][lateral])


def test_columns_are_the_slopes_of_the_residual() -> None:
    m, z = model(car_matrix()), np.array([0.3, -0.2, 0.4, -0.1])
    residual, sign = m.residual(z) or pytest.fail("no equilibrium")
    for i, column in enumerate(m.columns(z, residual, sign, range(4))):
        ends = [m.residual(z + h * np.eye(4)[i], sign) for h in (0.01, -0.01)]
        central = (ends[0][0] - ends[1][0]) / 0.02  # type: ignore[index]
        np.testing.assert_allclose(column, central, atol=2e-3 * np.abs(central).max())


def test_the_residual_is_in_shares_of_a_columns_length() -> None:
    """Two unit columns at an angle t: |u - v| = 2 sin(t / 2)."""
    m = model(car_matrix(), noise=0.5)
    residual, _ = m.residual(np.zeros(4)) or pytest.fail("no equilibrium")
    own, measured = m.matrix(np.zeros(4)), m.measured.values
    cosine = np.abs(np.einsum("ij,ij->j", own, measured)) / (
        np.linalg.norm(own, axis=0) * np.linalg.norm(measured, axis=0)
    )
    assert residual @ residual == pytest.approx(np.sum(2.0 - 2.0 * cosine) / 0.25)
