"""A model's axles: at a point, and beside it."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.axle.parameters import names_touched
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


def test_what_tuning_touches_are_all_values_that_it_changes() -> None:
    before = nominal()
    touched = names_touched(before, space().paths)
    after = with_values(before, space().values(space().start + 0.1))
    changed = {name for name, value in after.values.items() if value != before.values[name]}
    assert changed and changed <= touched < before.values.keys()
