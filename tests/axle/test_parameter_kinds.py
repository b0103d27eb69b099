"""What a parameter is, read from its declaration alone."""

from __future__ import annotations

from dataclasses import replace

import pytest

from doe_kc.axle.design_parameters import design_parameters
from doe_kc.axle.parameter_kinds import KINDS, SWITCHES, kind_of, quantity_of
from doe_kc.axle.parameters import switched_topology, with_values
from tests import axle_type_reference as axle_types
from tests.axle.test_parameters import nominal


@pytest.mark.parametrize(
    ("path", "quantity"),
    [
        ("LLF.y", "coordinate"),
        ("right.LLF.y", "coordinate"),
        ("ARB.y", "coordinate"),  # a point, though no design parameter
        ("scb.Tz", "stiffness"),
        ("left.llr.Fx", "stiffness"),
        ("spring.rate", "rate"),
        ("arb.radius", "radius"),
        ("arb.nominal_radius", "value"),
        ("strut.flexibility", "flexibility"),
        ("bump_stop.clearance", "clearance"),
        ("static.toe", "angle"),
        ("ride_height", "height"),
        ("hub.toe", "value"),
    ],
)
def test_quantity(path: str, quantity: str) -> None:
    assert quantity_of(path) == quantity


def test_units_and_groups_agree_with_the_quantity() -> None:
    for kind in KINDS.values():
        assert (kind.group == "HARDPOINTS") == (kind.quantity == "coordinate")
        assert (kind.group == "BUSHINGS") == (kind.quantity == "stiffness")
        assert (kind.unit == "deg") == (kind.quantity == "angle")
        assert kind.relative == (kind.quantity in {"stiffness", "rate", "radius"})


def test_a_side_has_the_declaration_of_both() -> None:
    assert kind_of("right.spring.rate") is KINDS["spring.rate"]
    assert kind_of("hub.toe") is None


@pytest.mark.parametrize("axle_type", axle_types.TYPES)
def test_a_path_alone_declares_the_parameters_of_every_axle_type(axle_type: str) -> None:
    """As an outside solver is told of them: ARB is a point of its own where no strut carries it."""
    for parameter in design_parameters(axle_types.nominal(axle_type)):
        kind = kind_of(parameter.path)
        assert kind is not None, parameter.path
        assert (kind.group, kind.unit, kind.quantity) == (parameter.group, parameter.unit, parameter.quantity)


def test_only_y_of_points_is_mirrored() -> None:
    mirrored = {p.path for p in design_parameters(nominal()) if p.mirrored}
    assert mirrored == {p for p, k in KINDS.items() if k.quantity == "coordinate" and p.endswith(".y")} - {
        f"{follower}.y" for follower in nominal().follow
    }


def test_scatter_between_cars() -> None:
    by_path = {p.path: p for p in design_parameters(nominal())}
    rate = by_path["spring.rate"]
    assert rate.production_sd == pytest.approx(0.03 * rate.nominal)
    assert by_path["static.toe"].production_sd == 0.1
    assert replace(rate, active=False).production_sd == 0.0


def test_a_strut_is_in_the_model_once_it_bends() -> None:
    (path,) = SWITCHES
    rigid = nominal()
    soft = with_values(rigid, {path: 0.5})
    for axle, there in ((rigid, False), (soft, True)):
        parameter = next(p for p in design_parameters(axle) if p.path == path)
        assert parameter.in_model == there and parameter.one_sided != there
        assert axle.topology.strut_bending == there
        assert (
            switched_topology(axle, path).strut_bending
            and switched_topology(axle, f"left.{path}").strut_bending
        )
    assert switched_topology(rigid, "spring.rate") == rigid.topology
