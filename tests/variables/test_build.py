"""The space of variables that a study asks for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.axle.model import Axle
from doe_kc.ground.errors import InputError
from doe_kc.ground.files import validate
from doe_kc.variables import Space, VariableOptions, build_space
from doe_kc.variables.build import Advice
from tests.reference import nominal


@pytest.fixture(scope="module")
def axle() -> Axle:
    return nominal()


def space(axle: Axle, advice: Advice | None = None, **options: Any) -> Space:
    return build_space(axle, validate(VariableOptions, options, "study"), "study", advice=advice)


def test_default_is_every_parameter_that_the_model_contains(axle: Axle) -> None:
    found = space(axle)
    assert found.dimension == 72
    assert "strut.flexibility" not in found.paths and "steer_arm.radius" not in found.paths
    np.testing.assert_allclose(found.start, 0.5, atol=0.06)  # 0.44 where bounds are 0.8 and 1.25
    assert with_values(axle, found.values(found.start)).values == axle.values


def test_strut_flexibility_once_it_is_there_or_named(axle: Axle) -> None:
    assert "strut.flexibility" in space(with_values(axle, {"strut.flexibility": 0.5})).paths
    assert space(axle, use=["strut.flexibility"]).paths == ("strut.flexibility",)


def test_globs_and_leaving_out(axle: Axle) -> None:
    assert space(axle, use=["LLF.*", "llr.F?"], leave_out=["LLF.z"]).paths == (
        "LLF.x", "LLF.y", "llr.Fx", "llr.Fy", "llr.Fz",
    )  # fmt: skip


def test_bounds_by_offset_factor_and_range(axle: Axle) -> None:
    found = space(
        axle,
        use=["LLF.x", "llr.Fx", "spring.rate"],
        change=[
            {"match": "LLF.x", "offset": [-1.0, 2.0]},
            {"match": "llr.*", "factor": [0.25, 4.0]},
            {"match": "spring.rate", "range": [20.0, 40.0], "levels": 21},
        ],
    )
    x, f, k = found.variables
    assert (x.lower - x.parameter.nominal, x.upper - x.parameter.nominal) == (-1.0, 2.0)
    assert (f.lower, f.upper, f.logarithmic) == (0.25, 4.0, True)
    assert (k.lower, k.upper, k.levels, x.levels) == (20.0, 40.0, 21, None)


def test_later_changes_win(axle: Axle) -> None:
    found = space(
        axle,
        use=["LLF.*"],
        change=[{"match": "LLF.*", "offset": [-1.0, 1.0]}, {"match": "LLF.y", "offset": [-2.0, 2.0]}],
    )
    widths = [v.upper - v.lower for v in found.variables]
    assert widths == pytest.approx([2.0, 4.0, 2.0])


def test_a_tie_keeps_offset_or_ratio(axle: Axle) -> None:
    found = space(
        axle,
        use=["LLF.z", "llf.Fx"],
        change=[{"match": "LLR.z", "tie": "LLF.z"}, {"match": "llr.Fx", "tie": "llf.Fx"}],
    )
    assert set(found.paths) == {"LLF.z", "llf.Fx"}
    values = found.values(np.ones(2))
    at = axle.values
    assert values["LLR.z"] - at["LLR.z@L"] == pytest.approx(values["LLF.z"] - at["LLF.z@L"])
    assert values["llr.Fx"] / at["llr.Fx@L"] == pytest.approx(values["llf.Fx"] / at["llf.Fx@L"])


def test_fixed_values_are_in_every_design(axle: Axle) -> None:
    found = space(axle, use=["LLF.*"], change=[{"match": "sff.Fz", "fixed": 1.2}])
    assert found.values(found.start)["sff.Fz"] == 1.2


def test_selection_takes_paths_and_bounds_from_the_advice(axle: Axle) -> None:
    advice = Advice({"LLF.x": (-5.0, 5.0), "llr.Fx": (0.4, 2.5)})
    found = space(axle, use="selection", advice=advice)
    assert found.paths == ("LLF.x", "llr.Fx")
    assert (found.variables[1].lower, found.variables[1].upper) == (0.4, 2.5)


def test_one_side_alone_with_bounds_of_its_own(axle: Axle) -> None:
    found = space(axle, use=["right.llr.Fx"], change=[{"match": "right.llr.Fx", "range": [0.5, 2.0]}])
    moved = with_values(axle, found.values(np.ones(1)))
    assert moved.values["llr.Fx@R"] == pytest.approx(2.0) and moved.values["llr.Fx@L"] == 1.0


def test_started_moves_bounds_and_fixes_what_is_no_variable(axle: Axle) -> None:
    found = space(axle, use=["static.toe"]).started({"static.toe": 0.2, "ride_height": 7.0})
    assert found.variables[0].start == 0.2
    assert found.values(found.start) == pytest.approx({"static.toe": 0.2, "ride_height": 7.0})


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"use": ["LFF.x"]}, ["'LFF.x' matches no parameter", 'Did you mean "']),
        ({"use": ["LLF.x"], "leave_out": ["LLF.x"]}, ["none is left to vary"]),
        ({"change": [{"match": "llq.*"}]}, ["match = 'llq.*' fits no parameter"]),
        ({"change": [{"match": "LLF.q"}]}, ["unknown parameter 'LLF.q'"]),
        ({"change": [{"match": "LLF.x", "offset": [1.0, -1.0]}]}, ["lower bound comes first"]),
        ({"change": [{"match": "LLF.x", "offset": [-1, 1], "range": [0, 1]}]}, ["one of offset, factor"]),
        ({"change": [{"match": "LLF.x", "start": 99.0}]}, ["start 99 is outside the bounds"]),
        ({"change": [{"match": "LLF.x", "fixed": 0.0, "tie": "LLF.y"}]}, ["fixed or tied, not both"]),
        ({"use": ["LLF.x"], "change": [{"match": "LLR.x", "tie": "LWB.x"}]}, ["tied to LWB.x, which is not"]),
        ({"use": ["llr.Fx"], "change": [{"match": "llr.Fx", "range": [0.0, 2.0]}]}, ["> 0"]),
        ({"use": ["right.llr.Fx"]}, ["has no bounds", "range = [low, high]"]),
        ({"levels": 1}, ["levels"]),
        ({"distribution": "normal"}, ["distribution is 'normal'"]),
        ({"useful": ["*"]}, ["key useful is unknown", "use"]),
    ],
)
def test_one_message_for_what_is_wrong(axle: Axle, options: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        space(axle, **options)
    for word in ["study", *words]:
        assert word in str(caught.value)
