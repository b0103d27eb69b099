"""Effects as switches: those of the axle file on, off and resized; those of the library by every law."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError
from doe_kc.live.effect_switches import effect_switches, effective_axle
from doe_kc.live.keep import export_axle, read_state, save_state
from doe_kc.live.model import live_model
from doe_kc.live.session import Session
from doe_kc.study import Study, read_study
from tests.live.cases import EXAMPLES, say

EFFECTS = """
[effects.hub_compliance]
camber_Nm_deg = 5000.0

[effects.bushing_preload]
LLR = [0.0, 300.0, 0.0]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study without records whose axle file has two effects."""
    place = tmp_path_factory.mktemp("effects")
    plain = (EXAMPLES / "front_axle" / "axle.toml").read_text("utf-8")
    (place / "axle.toml").write_text(plain + EFFECTS, encoding="utf-8")
    (place / "plain.toml").write_text(plain, encoding="utf-8")
    (place / "study.toml").write_text('schema = "doe_kc.study/1"\naxle = "axle.toml"\n', encoding="utf-8")
    return place


@lru_cache(maxsize=1)
def study(folder: Path) -> Study:
    return read_study(folder)


def test_sizes_are_those_of_the_file_and_its_defaults(folder: Path) -> None:
    switches = effect_switches(study(folder))
    hub, preload = switches["hub_compliance"], switches["bushing_preload"]
    assert hub.of_file and {s.name: (s.value, s.unit) for s in hub.sizes} == {
        "camber_Nm_deg": (5000.0, "Nm/deg"),
        "toe_Nm_deg": (9000.0, "Nm/deg"),
    }
    assert [(s.label, s.value, s.unit) for s in preload.sizes] == [
        ("LLR, X", 0.0, "N"),
        ("LLR, Y", 300.0, "N"),
        ("LLR, Z", 0.0, "N"),
    ]
    assert not any(name.startswith("bushing_preload ") for name in switches)  # it has that effect
    laws = {s.law for s in switches.values() if s.effect == "strut_friction"}
    assert laws == {"", "iwan", "duhem", "lognormal", "backbone"}


def test_an_effect_of_the_file_is_switched_off_resized_and_put_back(folder: Path) -> None:
    own = study(folder)
    assert effective_axle(own, {}) is own.axle
    off = effective_axle(own, {"hub_compliance": None, "bushing_preload": None})
    plain = read_axle(folder / "plain.toml")
    assert off.values == plain.values and off.topology == plain.topology and not off.effects
    sizes = {"camber_Nm_deg": 2000.0, "toe_Nm_deg": 3000.0}
    resized = effective_axle(own, {"hub_compliance": sizes, "bushing_preload": None})
    wanted = apply_effect(plain, "hub_compliance", sizes, source="test")
    assert resized.values == wanted.values and resized.effects == wanted.effects
    same = effective_axle(own, {"hub_compliance": {}})
    assert same.values == own.axle.values and same.topology == own.axle.topology


def test_every_switch_of_the_library_can_be_put_on(folder: Path) -> None:
    own = study(folder)
    for name, switch in effect_switches(own).items():
        axle = effective_axle(own, {name: {s.name: s.value for s in switch.sizes}})
        assert switch.effect in axle.effects
        assert all(s.number_in(switch.options({s.name: 7.5})) == 7.5 for s in switch.sizes)


@pytest.mark.parametrize(
    ("effects", "words"),
    [
        ({"warp": {}}, "none that this axle can be given"),
        ({"strut_friction": None}, "not in the axle file"),
        ({"strut_friction": {}, "strut_friction, iwan": {}}, "on as 'strut_friction' already"),
        ({"hub_compliance": {"camber": 1.0}}, "has no size 'camber'"),
        ({"hub_compliance": {"camber_Nm_deg": -1.0}}, "expected a number > 0"),
    ],
)
def test_what_cannot_be_is_said(folder: Path, effects: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        effective_axle(study(folder), effects)


def test_a_page_switches_locks_saves_and_undoes_them(folder: Path) -> None:
    live = Session(live_model(study(folder), None))
    row = "lateral"
    before = live.present.curves.cases[row].mean["camber"]
    say(live, kind="effect", name="hub_compliance", sizes=None)
    live.solve_now()
    assert live.settled and "hub_compliance" not in live.model.axle.effects
    assert np.abs(live.present.curves.cases[row].mean["camber"] - before).max() > 1e-3
    say(live, kind="lock_effect", name="hub_compliance", on=True)
    save_state(live)
    export_axle(live)
    written = read_axle(folder / "out" / "live" / "axle.toml")
    assert set(written.effects) == {"bushing_preload"}
    assert say(live, kind="reset_effect", name="hub_compliance").sliders and not live.state.effects
    live.solve_now()
    np.testing.assert_allclose(live.present.curves.cases[row].mean["camber"], before, atol=1e-9)
    saved = read_state(live)
    assert saved.effects == {"hub_compliance": None} and saved.locked_effects == {"hub_compliance"}
    say(live, kind="undo")
    assert live.state.effects == {"hub_compliance": None}
    live.compilation.wait()
