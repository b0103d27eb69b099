"""A McPherson axle of the user's own type: the same equations and numbers by way of the general reader."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import Axle, design_parameters, with_values
from doe_kc.axle.places import places_of
from doe_kc.axle_file import read_axle
from doe_kc.axle_types.read import FOLDER
from doe_kc.effects import EFFECTS, apply_effect
from doe_kc.solver.suite import solve
from tests.reference import EXAMPLE, MCPHERSON_EFFECTS, nominal


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Axle:
    folder: Path = tmp_path_factory.mktemp("own")
    text = (FOLDER / "mcpherson_front.toml").read_text(encoding="utf-8")
    own_type = text.replace('type = "mcpherson_front"', 'type = "own_strut"')
    (folder / "own_strut.toml").write_text(own_type, encoding="utf-8")
    axle = (EXAMPLE / "axle.toml").read_text(encoding="utf-8")
    clamp = " ".join(f"{nominal().values[f'CLAMP.{a}@L']!r}," for a in "xyz")
    named = axle.replace('schema = "doe_kc.axle/1"', 'schema = "doe_kc.axle/1"\ntype = "own_strut.toml"')
    if not re.search("(?m)^CLAMP", named):
        named = named.replace("[hardpoints]\n", f"[hardpoints]\nCLAMP = [{clamp}]\n")
    (folder / "axle.toml").write_text(named, encoding="utf-8")
    return read_axle(folder / "axle.toml")


def test_it_has_the_parameters_and_effects_of_the_built_in_type(own: Axle) -> None:
    assert own.topology.structure.type == "own_strut"
    assert dict(own.values) == dict(nominal().values)
    assert [p.path for p in design_parameters(own)] == [p.path for p in design_parameters(nominal())]
    assert {e.id for e in EFFECTS.values() if e.possible(places_of(own))} == set(MCPHERSON_EFFECTS)


@pytest.mark.parametrize("effect", ["", "strut_bending", "steer_arm_compliance", "ball_joint_compliance"])
def test_its_curves_are_those_of_the_built_in_type(own: Axle, effect: str) -> None:
    one, other = (apply_effect(a, effect, {}, source="t") if effect else a for a in (own, nominal()))
    first, second = (solve(axle, ["lateral", "steer"], compiled=False) for axle in (one, other))
    for case in ("lateral", "steer"):
        for a, b in zip(first.cases[case].branches, second.cases[case].branches, strict=True):
            np.testing.assert_allclose(a.y, b.y, rtol=1e-9, atol=1e-7)


def test_its_strut_bends_once_it_is_flexible(own: Axle) -> None:
    assert not own.topology.strut_bending
    assert with_values(own, {"strut.flexibility": 0.5}).topology.strut_bending
