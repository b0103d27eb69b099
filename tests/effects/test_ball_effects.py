"""Ball joints that yield or have play, on an axle whose type is data."""

from __future__ import annotations

import pytest

from doe_kc.axle.places import places_of
from doe_kc.effects import EFFECTS, apply_effect
from doe_kc.ground.errors import InputError
from tests import reference
from tests.axle_type_reference import nominal

BALL_EFFECTS = ("ball_compliance", "ball_free_play")


@pytest.mark.parametrize("ident", BALL_EFFECTS)
def test_every_ball_joint_is_a_place(ident: str) -> None:
    hypotheses = EFFECTS[ident].hypotheses(places_of(nominal("five_link_rear")))
    assert [h.location for h in hypotheses] == ["UFO", "URO", "TLO"]
    assert hypotheses[2].fixed == {"joints": ["TLO_L", "TLO_R"]}
    (single,) = EFFECTS[ident].hypotheses(places_of(nominal("rigid_rear")))
    assert single.fixed == {"joints": ["PHA"]}


@pytest.mark.parametrize("ident", BALL_EFFECTS)
def test_an_axle_without_such_joints_has_none(ident: str) -> None:
    for axle in (nominal("twist_beam_rear"), reference.nominal()):
        assert not EFFECTS[ident].possible(places_of(axle))
        with pytest.raises(InputError, match="nothing that it is an effect of"):
            apply_effect(axle, ident, {}, source="test")


@pytest.mark.parametrize("ident", BALL_EFFECTS)
def test_an_unknown_joint_is_named(ident: str) -> None:
    with pytest.raises(InputError, match=r"TLO_X.*TLO_L"):
        apply_effect(nominal("five_link_rear"), ident, {"joints": ["TLO_X"]}, source="test")


def test_one_side_alone() -> None:
    axle = apply_effect(nominal("five_link_rear"), "ball_compliance", {"joints": ["TLO_L"]}, source="test")
    assert axle.topology.elastic_balls == ("tlo@L",)
    assert axle.values["tlo.rate@L"] == 12000.0 and "tlo.rate@R" not in axle.values
