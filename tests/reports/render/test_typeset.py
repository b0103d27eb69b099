"""Signs of print and words for codes."""

from __future__ import annotations

import pytest
from markupsafe import Markup

from doe_kc.axle.parameter_kinds import KINDS
from doe_kc.reports.render.typeset import meaning, signs, typeset, unsigned_zero, with_own_meanings
from tests.reports.correlations import EVIL


@pytest.mark.parametrize(
    ("typed", "printed"),
    [
        ("-3.5 mm", "−3.5 mm"),
        ("(-3)", "(−3)"),
        ("2026-01-31", "2026-01-31"),
        ("run-2.csv", "run-2.csv"),
        ("1e-05", "1e-05"),
        ("5.2 -> 1.0", "5.2 → 1.0"),
        ("0 +- 1 1/mm^2", "0 ± 1 1/mm²"),
        ("over +-0.05 mm", "over ±0.05 mm"),
    ],
)
def test_signs_of_print(typed: str, printed: str) -> None:
    assert signs(typed) == printed


@pytest.mark.parametrize(
    ("text", "shown"), [("-0.0", "0.0"), ("+0.00", "0.00"), ("-0.1", "-0.1"), ("+3", "+3")]
)
def test_zero_has_no_sign(text: str, shown: str) -> None:
    assert unsigned_zero(text) == shown


def test_every_parameter_says_what_it_is() -> None:
    assert all(kind.label in meaning(path) for path, kind in KINDS.items())
    assert meaning("right.llr.Fx") == f"{meaning('llr.Fx')}, right side alone"
    assert meaning("ARB.z") == "Anti-roll bar drop link, upper end, z, mm"
    assert "WC lateral displacement" in meaning("roll.wc_lateral_disp")
    assert meaning("lateral.toe_change") and meaning("LWB") and meaning("hub_compliance")
    assert meaning("spring") == meaning("of") == meaning("report.html") == ""


def test_codes_within_prose_are_explained_and_all_else_is_escaped() -> None:
    text = typeset(f"{EVIL} llr.Fx, LWB.x. Next")
    assert "<script>" not in text and "&lt;script&gt;" in text
    assert (
        '<abbr title="Lower link rear bush, stiffness x: factor of the axle file&#39;s">llr.Fx</abbr>' in text
    )
    assert ">LWB.x</abbr>. Next" in text
    assert typeset(Markup("<b>-1</b>")) == "<b>-1</b>"


def test_codes_say_what_they_are_on_their_own_axle() -> None:
    page = str(typeset("llf.Fx of LLF, right.UFI.z, static.toe"))
    own = with_own_meanings(page, {"llf": "Lower arm front", "LLF": "Lower arm front", "UFI": "Inner"})
    assert 'title="Lower arm front bush, stiffness x: factor of the axle file&#39;s">llf.Fx' in own
    assert 'title="Hardpoint: lower arm front">LLF' in own
    assert 'title="Inner, z, mm, right side alone">right.UFI.z' in own
    assert with_own_meanings(page, {}) == page
    assert own.count("<abbr") == page.count("<abbr") and "Static toe" in own
