"""The axle of the Python API."""

from __future__ import annotations

from pathlib import Path

import pytest

import doe_kc as kc
from tests.cli.runner import succeeds
from tests.reference import EXAMPLE

AXLE = EXAMPLE / "axle.toml"


def test_a_path_is_a_string_or_a_path() -> None:
    assert kc.read_axle(str(AXLE)).values == kc.read_axle(AXLE).values
    assert kc.with_values(str(AXLE), {"LLF.z": 213.0}).values["LLF.z@R"] == 213.0


def test_the_axle_given_is_not_changed() -> None:
    axle = kc.read_axle(AXLE)
    changed = kc.with_effects(
        kc.with_values(axle, {"llr.Fx": 0.5}), {"tie_rod_compliance": {"k_N_mm": 4000.0}}
    )
    assert axle.values["llr.Fx@L"] == 1.0 and not axle.effects
    assert changed.values["llr.Fx@L"] == 0.5 and list(changed.effects) == ["tie_rod_compliance"]
    assert repr(changed) == "Axle('Front axle, McPherson', effects: tie_rod_compliance)"


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"LFF.z": 213.0}, "with_values: unknown parameter 'LFF.z'"),
        ({"llr.Fx": 0.0}, "with_values: llr.Fx = 0, expected a number > 0"),
        ({"LLF.y": 395.0}, "with_values: hardpoint LLF of the left side lies on the other side"),
    ],
)
def test_values_that_no_axle_has(values: dict[str, float], message: str) -> None:
    with pytest.raises(kc.InputError, match=message):
        kc.with_values(AXLE, values)


def test_an_effect_that_is_none() -> None:
    with pytest.raises(kc.InputError, match=r"with_effects: .*hub_complianse.*hub_compliance"):
        kc.with_effects(AXLE, {"hub_complianse": {}})


def test_parameters_are_those_that_can_be_set() -> None:
    frame = kc.parameters(AXLE)
    assert list(frame.columns) == ["label", "group", "unit", "nominal", "lower", "upper", "step", "active"]
    same = kc.with_values(AXLE, frame["nominal"].to_dict())
    assert same.values == kc.read_axle(AXLE).values
    assert (frame["lower"] <= frame["nominal"]).all() and (frame["nominal"] <= frame["upper"]).all()


def test_the_types_are_those_of_the_command() -> None:
    frame = kc.types()
    listed = succeeds("types").out.splitlines()[:-1]
    assert [line.split()[0] for line in listed] == list(frame.index)
    assert all(row["label"] in line for (_, row), line in zip(frame.iterrows(), listed, strict=True))
    assert frame["bushings"].iloc[1:].ge(0).all() and Path(frame["file"].iloc[1]).is_file()
