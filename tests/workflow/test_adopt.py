"""Which effects of a discovery are added to the axle that is correlated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.discovery.options import DiscoveryOptions
from doe_kc.discovery.thresholds import AMPLITUDE_STEP
from doe_kc.ground.errors import InputError
from doe_kc.study import read_study
from doe_kc.workflow.adopt import adopt, adopted
from tests.discovery.cases import discovery, library
from tests.workflow.chain_cases import study


def test_named_effects_are_added_at_the_sizes_found(tmp_path: Path) -> None:
    plain, found = study(tmp_path), discovery("named")
    adoption = adopt(plain, found)
    (effect,) = adoption.effects
    assert effect.id == "hub_compliance" and not effect.uncertain and not effect.on_rig
    sizes = {e.key: e.value for e in found.findings[0].estimates}
    assert adoption.axle.effects["hub_compliance"]["camber_Nm_deg"] == pytest.approx(
        sizes["camber_Nm_deg"], rel=1e-3
    )
    assert "hub_compliance" not in plain.axle.effects
    assert adoption.axle.values["LLF.z@L"] == plain.axle.values["LLF.z@L"], "parameters stay nominal"
    assert adoption.refit["LLF.z"] != plain.axle.values["LLF.z@L"] and not adoption.without
    assert adoption.sentences == ("hub and wheel-bearing compliance: added to the axle",)


def test_every_size_of_an_effect_has_an_axle_in_which_it_alone_is_larger(tmp_path: Path) -> None:
    found, plain = discovery("pair"), study(tmp_path)
    adoption = adopt(plain, found)
    sizes = [
        (effect.id, size)
        for effect, finding in zip(adoption.effects, found.findings, strict=True)
        for size in finding.hypothesis.sizes
    ]
    assert len(adoption.effects) == 2 and len(sizes) >= 4
    before = {ident: _numbers(options) for ident, options in adoption.axle.effects.items()}
    for (effect, size), axle in zip(sizes, adoption.size_steps, strict=True):
        after = {ident: _numbers(options) for ident, options in axle.effects.items()}
        assert {k for k in after[effect] if after[effect][k] != before[effect][k]} == {size.name}
        low, high = (size.amplitude(float(o[effect][size.name])) for o in (before, after))
        assert high - low == pytest.approx(AMPLITUDE_STEP, rel=1e-6)
        assert all(after[e.id] == before[e.id] for e in adoption.effects if e.id != effect)


def _numbers(options: Mapping[str, Any]) -> dict[str, Any]:
    """An effect's options by `Size.name`, of lists place by place."""
    out: dict[str, Any] = {}
    for key, value in options.items():
        out |= {f"{key}[{i}]": v for i, v in enumerate(value)} if isinstance(value, list) else {key: value}
    return out


@pytest.mark.parametrize("added", [True, False])
def test_a_refit_beside_a_bushing_unlike_on_the_left_has_the_stiffness_of_both(
    added: bool, tmp_path: Path
) -> None:
    """The effect comes on top where it is added to the axle; where it is not, nothing of it is left."""
    found, plain = discovery("named"), study(tmp_path)
    (member,) = (h for h in library("left_right_asymmetry") if h.location == "LLR_L")
    before = found.fitted
    fitted = replace(before, model=before.model.extended(member), z=np.append(before.z, 1.5))
    named = replace(found.findings[0], hypothesis=member)
    findings = (*found.findings, named) if added else found.findings
    search = replace(found.search, with_effects=fitted)
    adoption = adopt(plain, replace(found, search=search, findings=findings))
    axle = with_values(adoption.axle, adoption.refit)
    asked = fitted if added else before
    expected = asked.model.axle_at(asked.z)
    for side in "LR":
        assert axle.values[f"llr.Fx@{side}"] == pytest.approx(expected.values[f"llr.Fx@{side}"], rel=1e-9)
    ratio = axle.values["llr.Fx@L"] / axle.values["llr.Fx@R"]
    assert ratio == pytest.approx(1.25**1.5 if added else 1.0, rel=1e-6)


def test_the_leading_one_of_a_class_is_added_and_marked(tmp_path: Path) -> None:
    found = discovery("class")
    assert found.verdict == "class"
    adoption = adopt(study(tmp_path), found)
    assert [e.id for e in adoption.effects] == [f.hypothesis.effect for f in found.findings]
    assert any(e.uncertain for e in adoption.effects)
    assert "the leading one of a class" in adoption.sentences[0]


@pytest.mark.parametrize("car", ["unexplained", "lead"])
def test_where_nothing_is_named_nothing_is_added_and_what_is_unexplained_is_left_out(
    car: str, tmp_path: Path
) -> None:
    found, plain = discovery(car), study(tmp_path)
    assert found.verdict == "unexplained"
    adoption = adopt(plain, found)
    assert adoption.axle is plain.axle and not adoption.effects
    worst = {(c.load_case, c.response) for c, _ in found.tuned_map.worst(8)}
    assert adoption.without <= worst
    assert all(f"{c} {r}: left out" in " ".join(adoption.sentences) for c, r in adoption.without)


def test_never_and_a_list(tmp_path: Path) -> None:
    found, plain = discovery("two"), study(tmp_path)
    ids = [f.hypothesis.effect for f in found.findings]
    assert len(ids) == 2
    assert adopt(study(tmp_path, "never"), found).axle is plain.axle
    one = adopt(study(tmp_path, [ids[1]]), found)
    assert [e.id for e in one.effects] == [ids[1]]


def test_a_fault_of_the_rig_is_taken_into_account_but_not_in_the_axle_file(tmp_path: Path) -> None:
    adoption = adopt(study(tmp_path), discovery("two"))
    (fault,) = [e for e in adoption.effects if e.on_rig]
    assert fault.id == "rig_channel_gain"
    assert any("fault of the measurement" in s for s in adoption.sentences)


def test_what_was_adopted_is_read_back(tmp_path: Path) -> None:
    plain = study(tmp_path)
    adoption = adopt(plain, discovery("two"))
    again = adopted(plain, adoption.records, sorted(adoption.without))
    assert again.axle.values == adoption.axle.values and again.axle.effects == adoption.axle.effects
    assert again.effects == adoption.effects and again.without == adoption.without


def test_an_unknown_effect_to_adopt_is_named(tmp_path: Path) -> None:
    plain = study(tmp_path)
    file = tmp_path / "study.toml"
    file.write_text(file.read_text() + '[discovery]\nadopt = ["hub_complaince"]\n')
    with pytest.raises(InputError, match=r'discovery.adopt: .hub_complaince. is no effect.*"hub_compliance"'):
        read_study(tmp_path)
    assert replace(plain, discovery=DiscoveryOptions()).discovery.adopt == "auto"
