"""Designs under constraints hold them, fill what is left, and say what leaves nothing."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError

from doe_kc.ground.errors import InputError
from doe_kc.sampling import Design, LinearConstraint, sample
from doe_kc.sampling.options import ConstraintOptions
from doe_kc.variables import Space, VariableOptions, build_space
from tests.reference import nominal

pytestmark = pytest.mark.usefixtures("few_exchanges")
RACK_BELOW = LinearConstraint((("ROB.z", 1.0), ("RIB.z", -1.0)), low=4.0, high=6.0)
"""Of ROB.z = 282 and RIB.z = 279, each by 3 mm: differences from -3 to 9."""


def space(**options: object) -> Space:
    return build_space(nominal(), VariableOptions(use=["ROB.*", "RIB.*"], **options), "test")  # type: ignore[arg-type]


def difference(design: Design) -> np.ndarray:
    columns = [design.paths.index(p) for p in ("ROB.z", "RIB.z")]
    return np.asarray(design.values[:, columns] @ np.array([1.0, -1.0]))


@pytest.mark.parametrize("method", ["lhs", "sobol"])
def test_all_designs_hold_the_constraints(method: str) -> None:
    design = sample(space(), 40, seed=1, method=method, constraints=[RACK_BELOW])
    assert design.values.shape == (40, 6)
    assert len(set(design.labels)) == 40
    found = difference(design)
    assert found.min() >= 4.0
    assert found.max() <= 6.0
    assert np.array_equal(
        sample(space(), 40, seed=1, method=method, constraints=[RACK_BELOW]).values, design.values
    )


def test_the_rest_of_the_box_is_filled_evenly() -> None:
    """Of a triangle x + y <= 1 the means are 1 / 3, of a variable without constraint 1 / 2."""
    box = space(levels="continuous")
    low, high = (box.values(np.full(6, u)) for u in (0.0, 1.0))
    factors = tuple((p, 1.0 / (high[p] - low[p])) for p in ("ROB.z", "RIB.z"))
    most = 1.0 + sum(f * low[p] for p, f in factors)
    design = sample(box, 300, seed=2, constraints=[LinearConstraint(factors, high=most)])
    places = np.array([box.unit(row) for row in design.rows()]).mean(axis=0)
    wanted = {"ROB.z": 1 / 3, "RIB.z": 1 / 3}
    assert places == pytest.approx([wanted.get(p, 0.5) for p in box.paths], abs=0.04)


def test_new_designs_complete_those_that_are_there() -> None:
    box = space()
    first = sample(box, 20, seed=1, constraints=[RACK_BELOW])
    known = np.array([box.unit(row) for row in first.rows()])
    more = sample(box, 10, seed=1, existing=known, constraints=[RACK_BELOW])
    assert more.labels[0] == "sample 21"
    assert difference(more).min() >= 4.0


def test_a_full_factorial_keeps_what_holds() -> None:
    design = sample(space(), 1, seed=0, method="full_factorial", levels=3, constraints=[RACK_BELOW])
    assert set(np.round(difference(design), 9)) == {6.0}
    assert len(design.values) == 2 * 3**4  # 285 with 279 and 282 with 276


def test_followers_of_a_tie_can_be_constrained() -> None:
    box = space(change=[{"match": "ROB.z", "tie": "RIB.z"}])
    free = LinearConstraint((("ROB.z", 1.0),), low=282.0)
    assert difference(sample(box, 8, seed=1, constraints=[free])) == pytest.approx(np.full(8, 3.0))


def test_what_cannot_be_is_said() -> None:
    with pytest.raises(InputError, match=r"no variable of the study.*\"ROB.z\""):
        sample(space(), 4, seed=1, constraints=[LinearConstraint((("ROB.zz", 1.0),), low=0.0)])
    with pytest.raises(InputError, match=r"no design within the bounds has 300 <= \+1 ROB.z; widen"):
        sample(space(), 4, seed=1, constraints=[LinearConstraint((("ROB.z", 1.0),), low=300.0)])
    narrow = LinearConstraint((("ROB.z", 1.0), ("RIB.z", -1.0)), low=8.9)
    with pytest.raises(InputError, match=r"% of the designs hold all constraints, less than 1 %"):
        sample(space(), 4, seed=1, constraints=[narrow])
    with pytest.raises(InputError, match="one_at_a_time has its designs from elsewhere"):
        sample(space(), 4, seed=1, method="one_at_a_time", constraints=[RACK_BELOW])


@pytest.mark.parametrize(
    ("keys", "reason"),
    [
        ({"factors": {"ROB.z": 1.0}}, "give low, high or both"),
        ({"factors": {"ROB.z": 1.0}, "low": 2.0, "high": 1.0}, "low = 2 is above high = 1"),
        ({"factors": {}, "low": 0.0}, "at least 1"),
    ],
)
def test_the_study_says_what_is_wrong(keys: dict[str, object], reason: str) -> None:
    with pytest.raises(ValidationError, match=reason):
        ConstraintOptions.model_validate(keys)
    assert ConstraintOptions(factors={"ROB.z": 1.0}, low=2.0).build() == LinearConstraint(
        (("ROB.z", 1.0),), low=2.0
    )
