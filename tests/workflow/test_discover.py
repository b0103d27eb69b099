"""The library and the parameters of a discovery, and what it refuses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from doe_kc.axle import with_values
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError
from doe_kc.measurement import reduce_measurement
from doe_kc.study import read_study
from doe_kc.variables import VariableOptions
from doe_kc.workflow.discover import discover_study, discovery_space, effect_library
from tests.reference import EXAMPLE, nominal
from tests.reference import MCPHERSON_EFFECTS as EFFECTS

RIG = Path(__file__).parents[1] / "data" / "rig"


def test_the_library_holds_every_place_of_every_effect_once() -> None:
    found = effect_library(nominal())
    assert {h.effect for h in found} == set(EFFECTS)
    assert len({h.name for h in found}) == len(found)


def test_what_the_axle_has_and_what_is_excluded_is_not_looked_for() -> None:
    axle = apply_effect(nominal(), "hub_compliance", {}, source="test")
    bent = with_values(axle, {"strut.flexibility": 0.5})
    ids = {h.effect for h in effect_library(bent, ["strut_friction"])}
    assert ids == set(EFFECTS) - {"hub_compliance", "strut_bending", "strut_friction"}


def test_an_unknown_effect_to_exclude_is_named() -> None:
    with pytest.raises(InputError, match=r'strut_bendng: is no effect.*Did you mean "strut_bending"'):
        effect_library(nominal(), ["strut_bendng"])


def test_parameters_that_are_effects_in_other_words_are_held() -> None:
    options = VariableOptions.model_validate(
        {
            "use": ["*", "ride_height"],
            "change": [{"match": "ride_height", "offset": [-3, 3]}, {"match": "LLF.x", "offset": [-1, 1]}],
        }
    )
    space = discovery_space(nominal(), options, "test")
    assert not {"ride_height", "strut.flexibility", "steer_arm.radius"} & set(space.paths)
    (narrow,) = [v for v in space.variables if v.path == "LLF.x"]
    assert narrow.upper - narrow.lower == pytest.approx(2.0)


def test_an_outside_solver_is_refused(tmp_path: Path) -> None:
    study = read_study(EXAMPLE, out=tmp_path)
    outside = replace(study, solver=study.solver.model_copy(update={"command": ["solve"]}))
    with pytest.raises(InputError, match="discovery needs exact sensitivities"):
        discover_study(outside, reduce_measurement(RIG / "car_b"))


def test_records_without_a_common_load_case_are_refused(tmp_path: Path) -> None:
    study = read_study(EXAMPLE, out=tmp_path)
    few = replace(study, axle=replace(study.axle, load_cases={}))
    with pytest.raises(InputError, match="no load case of the records"):
        discover_study(few, reduce_measurement(RIG / "car_b"))
