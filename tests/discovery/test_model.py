"""A model's axles: at a point, and beside it."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.axle.parameters import names_touched
from doe_kc.discovery.search.law_variants import other_laws
from doe_kc.discovery.thresholds import DIRECTION_STEP
from doe_kc.effects import EFFECTS
from tests.discovery.cases import LOAD_CASES, library, model, nominal, space


@pytest.mark.parametrize("effect", EFFECTS)
@pytest.mark.parametrize("first", [True, False])
def test_the_axle_beside_a_point_is_the_one_there(effect: str, first: bool) -> None:
    """Whether the effect comes before or behind another, and whether tuning sets what it moves or not."""
    for member in EFFECTS[effect].hypotheses():
        others = [h for h in library("hub_compliance", "steering_friction") if h.effect != effect]
        car = model("pair", LOAD_CASES)
        for each in (member, *others) if first else (*others, member):
            car = car.extended(each)
        z = np.concatenate([car.centre[: car.dimension], np.full(len(car.sizes), 0.3)])
        z[: car.parameters] += 0.01
        places = range(car.dimension, z.size)
        beside = dict(car.axles_beside(z, car.axle_at(z), places, DIRECTION_STEP))
        assert sorted(beside) == list(places)
        for i, axle in beside.items():
            there = car.axle_at(z + DIRECTION_STEP * np.eye(z.size)[i])
            assert axle.values == there.values, (member.name, i)
            assert (axle.topology, axle.load_cases) == (there.topology, there.load_cases)


@pytest.mark.parametrize(("side", "twin"), [("L", "R"), ("R", "L")])
def test_an_unequal_bushing_is_so_many_times_what_both_are_tuned_to(side: str, twin: str) -> None:
    """Also on the left, whose value a plain path reads: a mount of 1.49 there was told as 1.26."""
    (member,) = (h for h in library("left_right_asymmetry") if h.location == f"LLR_{side}")
    car = model("none").extended(member)
    z = np.append(car.centre[: car.dimension] + 0.1, 1.5)
    axle, tuned = car.axle_at(z), car.space.values(z[: car.parameters])
    stiffnesses = [p for p in tuned if p.startswith("llr.F")]
    assert stiffnesses
    for path in stiffnesses:
        assert axle.values[f"{path}@{twin}"] == pytest.approx(tuned[path], rel=1e-12)
        assert axle.values[f"{path}@{side}"] == pytest.approx(tuned[path] * 1.25**1.5, rel=1e-12)


def test_a_member_is_the_one_of_its_name_by_the_law_that_the_model_has() -> None:
    friction, mount = library("steering_friction", "rack_mount_compliance")
    other = other_laws(friction)[0]
    both = model("friction").extended(mount).extended(other)
    assert both.member(friction.name) is other and both.member(mount.name) is mount
    with pytest.raises(KeyError, match="strut_friction"):
        both.member("strut_friction")


def test_what_tuning_touches_are_all_values_that_it_changes() -> None:
    before = nominal()
    touched = names_touched(before, space().paths)
    after = with_values(before, space().values(space().start + 0.1))
    changed = {name for name, value in after.values.items() if value != before.values[name]}
    assert changed and changed <= touched < before.values.keys()
