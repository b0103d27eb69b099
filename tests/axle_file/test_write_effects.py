"""Axle files with the effects that a search has found: readable tables that load back to the same axle."""

from __future__ import annotations

import difflib
import tomllib
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.axle_file import read, read_axle
from doe_kc.axle_file.write import unit_beside, write_axle
from doe_kc.effects import apply_effect
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.variables import VariableOptions, build_space
from tests.reference import EXAMPLE
from tests.reference import MCPHERSON_EFFECTS as EFFECTS

AXLE = EXAMPLE / "axle.toml"
PLAIN = AXLE.read_text(encoding="utf-8")
LIBRARY = [h for e in EFFECTS.values() if not e.on_rig for h in e.hypotheses()]
THIRD = 1.0 / 3.0


def with_hypothesis(axle: Axle, hypothesis: Hypothesis, amplitude: float) -> Axle:
    sizes = {s.name: amplitude for s in hypothesis.sizes}
    return apply_effect(axle, hypothesis.effect, hypothesis.options(sizes), source="test")


def retuned(axle: Axle, seed: int) -> Axle:
    held = sorted({path for e in EFFECTS.values() for path in e.replaces})
    space = build_space(read_axle(AXLE), VariableOptions(leave_out=held), "test")
    shift = 0.05 * np.random.default_rng(seed).standard_normal(space.dimension)
    return with_values(axle, space.values(np.clip(space.start + shift, 0.0, 1.0)))


def written(axle: Axle, folder: Path, text: str = PLAIN) -> tuple[Axle, str]:
    (folder / "axle.toml").write_bytes(text.encode())
    path = write_axle(axle, folder / "axle.toml", folder / "new.toml")
    return read_axle(path), path.read_bytes().decode()


@pytest.mark.parametrize("hypothesis", LIBRARY, ids=lambda h: h.name)
def test_every_hypothesis_loads_back_with_the_tuned_parameters(
    hypothesis: Hypothesis, tmp_path: Path
) -> None:
    axle = retuned(with_hypothesis(read_axle(AXLE), hypothesis, 0.7 * THIRD), len(hypothesis.name))
    again, _ = written(axle, tmp_path)
    assert again.effects == axle.effects
    assert (again.topology, again.load_cases) == (axle.topology, axle.load_cases)
    for name, value in axle.values.items():
        assert again.values[name] == pytest.approx(value, rel=1e-12, abs=0.0)


def test_a_table_by_the_other_name_is_changed_in_its_place(tmp_path: Path) -> None:
    text = PLAIN + "\n[effects.damper_friction]  # measured\nforce_N = 80.0\n"
    (tmp_path / "other.toml").write_text(text, encoding="utf-8")
    axle = apply_effect(
        read_axle(tmp_path / "other.toml"), "strut_friction", {"force_N": 90.0}, source="test"
    )
    again, new = written(axle, tmp_path, text)
    assert again.effects["strut_friction"]["force_N"] == 90.0
    assert "[effects.damper_friction]  # measured" in new and "[effects.strut_friction]" not in new


def test_conditioning_loops_are_written_where_the_file_says_otherwise(tmp_path: Path) -> None:
    axle = with_hypothesis(read_axle(AXLE), next(h for h in LIBRARY if h.effect == "strut_friction"), 1.0)
    again, text = written(axle.conditioned(1), tmp_path)
    assert again.load_cases == axle.conditioned(1).load_cases
    back, shorter = written(axle, tmp_path, text)
    assert back.load_cases == axle.load_cases
    assert shorter.count("conditioning = 0") == len(axle.load_cases)


@pytest.mark.parametrize("ident", ["hub_compliance", "left_right_asymmetry", "steering_friction"])
def test_curves_are_the_same(ident: str, tmp_path: Path) -> None:
    hypothesis = next(h for h in LIBRARY if h.effect == ident)
    axle = retuned(with_hypothesis(read_axle(AXLE), hypothesis, 1.0), 3)
    again, _ = written(axle, tmp_path)
    one, two = curve_set(solve(axle)), curve_set(solve(again))
    for name, case in one.cases.items():
        for response, values in case.mean.items():
            np.testing.assert_allclose(two.cases[name].mean[response], values, rtol=0, atol=1e-9)


def test_several_places_share_a_table(tmp_path: Path) -> None:
    axle = read_axle(AXLE)
    for place in ("LLR", "UPB"):
        hypothesis = next(h for h in LIBRARY if (h.effect, h.location) == ("bushing_preload", place))
        axle = with_hypothesis(axle, hypothesis, THIRD)
    again, text = written(axle, tmp_path)
    assert text.count("[effects.") == 1
    assert set(tomllib.loads(text)["effects"]["bushing_preload"]) == {"LLR", "UPB"}
    assert (again.values, again.effects) == (axle.values, axle.effects)


def test_options_of_effects_are_tried_without_checks_of_the_axle(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whether its bodies are guided matters only once it reads as wanted."""
    axle = retuned(apply_effect(read_axle(AXLE), "rubber_hysteresis", {}, source="test"), 4)
    checked: list[Axle] = []
    monkeypatch.setattr(read, "check_freedoms", lambda axle, structure, source: checked.append(axle))
    write_axle(axle, AXLE, tmp_path / "new.toml")
    assert [dict(each.values) for each in checked] == [dict(axle.values)]


def test_a_place_is_added_to_a_table_that_the_file_has(tmp_path: Path) -> None:
    text = PLAIN + "\n[effects.bushing_cubic] # mine\nLLR = [0.05, 0.05, 0.05] # kept\n"
    (tmp_path / "axle.toml").write_text(text, encoding="utf-8")
    axle = read_axle(tmp_path / "axle.toml")
    hypothesis = next(h for h in LIBRARY if (h.effect, h.location) == ("bushing_progression", "UPB"))
    axle = with_hypothesis(axle, hypothesis, THIRD)
    again, new = written(axle, tmp_path, text)
    assert (again.values, again.effects) == (axle.values, axle.effects)
    assert "[effects.bushing_cubic] # mine\nLLR = [0.05, 0.05, 0.05] # kept\nUPB = [" in new


def test_the_diff_is_a_few_readable_lines(tmp_path: Path) -> None:
    axle = apply_effect(
        read_axle(AXLE), "hub_compliance", {"camber_Nm_deg": 5000.0 + THIRD, "toe_Nm_deg": 9000.0}, source="t"
    )
    _, text = written(axle, tmp_path)
    added = [x[2:] for x in difflib.ndiff(PLAIN.splitlines(), text.splitlines()) if x[0] in "+-"]
    assert added[1:] == [
        "",
        "[effects.hub_compliance] # Hub and wheel-bearing compliance",
        f"# {EFFECTS['hub_compliance'].physics}",
        f"camber_Nm_deg = {5000.0 + THIRD!r}",
        "toe_Nm_deg = 9000.0",
    ]


def test_faults_of_the_measurement_stay_out(tmp_path: Path) -> None:
    axle = read_axle(AXLE)
    for effect in EFFECTS.values():
        if effect.on_rig:
            axle = with_hypothesis(axle, effect.hypotheses()[0], 0.5)
    again, text = written(axle, tmp_path)
    assert "[effects" not in text
    assert again.values == read_axle(AXLE).values


def test_windows_line_ends_are_kept_in_new_tables(tmp_path: Path) -> None:
    text = PLAIN.replace("\n", "\r\n")
    axle = apply_effect(read_axle(AXLE), "strut_bending", {}, source="test")
    _, new = written(axle, tmp_path, text)
    assert new.count("\n") == new.count("\r\n") == text.count("\n") + 4


def test_units_stand_beside_keys_that_do_not_say_them() -> None:
    assert unit_beside("bushing_preload", "LLR") == "N"
    assert unit_beside("hub_compliance", "camber_Nm_deg") == ""
    assert unit_beside("left_right_asymmetry", "LLR_R") == ""
    assert unit_beside("steering_friction", "law") == ""
