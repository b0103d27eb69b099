"""What discovery asks of every effect: words, and sizes that grow from nothing to a typical effect."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, lru_cache

import numpy as np
import pytest

from doe_kc.axle import Axle
from doe_kc.axle.design_parameters import design_parameters
from doe_kc.axle.parameters import settable_paths
from doe_kc.curves import CurveSet
from doe_kc.effects import EFFECTS as ALL_EFFECTS
from doe_kc.effects import apply_effect, observed
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests.reference import MCPHERSON_EFFECTS as EFFECTS
from tests.reference import nominal, steps_only

HYPOTHESES = [h for e in EFFECTS.values() for h in e.hypotheses()]
SIZED = [h for h in HYPOTHESES if h.sizes]
GROWING = (0.1, 0.3, 1.0, 3.0)
NEARLY_NOTHING = 1e-3
"""Share of the typical effect that may be left at amplitude 0: a stiffness is 1e4 times the typical one."""


def ident(h: Hypothesis) -> str:
    return h.name


def options(h: Hypothesis, amplitude: float, shape: float = 0.0) -> dict[str, object]:
    return h.options({s.name: shape if s.shape else amplitude for s in h.sizes})


def with_hypothesis(h: Hypothesis, amplitude: float, shape: float = 0.0) -> Axle:
    return apply_effect(short(), h.effect, options(h, amplitude, shape), source="test")


@lru_cache
def short() -> Axle:
    """Every fourth step: each is as good a check as the next."""
    cases = {i: replace(c, steps=c.steps // 4) for i, c in nominal().load_cases.items()}
    return replace(nominal(), load_cases=cases)


def numbers(curves: CurveSet) -> np.ndarray:
    """Every curve in one vector, in units of what a rig resolves: 0.01 deg, 0.1 mm, 10 N."""
    scale = {"wc": 0.1, "ty": 10.0}
    parts = []
    for _, case in sorted(curves.cases.items()):
        for curve in (case.mean, case.half_width):
            parts += [curve[r].ravel() / scale.get(r[:2], 0.01) for r in sorted(curve)]
    assert curves.static is not None
    return np.concatenate([*parts, *[curves.static[r] / 0.01 for r in sorted(curves.static)]])


@lru_cache
def plain() -> CurveSet:
    return curve_set(solve(short(), lanes=True))


def change(h: Hypothesis, amplitude: float, shape: float = 0.0) -> np.ndarray:
    return _change(h.name, amplitude, shape)


@cache
def _change(name: str, amplitude: float, shape: float) -> np.ndarray:
    (h,) = (h for h in HYPOTHESES if h.name == name)
    axle = with_hypothesis(h, amplitude, shape)
    curves = steps_only(curve_set(solve(axle, lanes=True)), axle)
    return numbers(observed(axle, curves)) - numbers(plain())


@pytest.mark.parametrize("name", EFFECTS)
def test_every_effect_says_what_it_is_and_how_it_shows(name: str) -> None:
    effect = EFFECTS[name]
    for text in (effect.physics, effect.shown_by):
        assert len(text.split()) > 5 and text == text.strip()
    assert effect.physics[0].isupper() and effect.physics.endswith(".")
    assert not effect.shown_by[0].isupper() and not effect.shown_by.endswith(".")
    assert effect.mistaken_for and effect.id not in effect.mistaken_for
    known = {*ALL_EFFECTS, *settable_paths(nominal())}
    assert set(effect.mistaken_for) <= known
    assert set(effect.replaces) <= {p.path for p in design_parameters(nominal())}
    assert effect.hypotheses()


def test_hypotheses_have_names_of_their_own() -> None:
    names = [h.name for h in HYPOTHESES]
    assert len(set(names)) == len(names)
    assert {"roll_technique counter_phase", "bushing_preload LLR", "left_right_asymmetry LLR_R"} <= set(names)
    assert {"tie_rod_free_play ROB", "rig_input_gain steer", "rig_channel_gain tyre_load"} <= set(names)


@pytest.mark.parametrize("h", HYPOTHESES, ids=ident)
def test_sizes_are_options_at_their_typical_values(h: Hypothesis) -> None:
    names = [s.name for s in h.sizes]
    assert len(set(names)) == len(names)
    effect = EFFECTS[h.effect]
    table = effect.read(options(h, 1.0), "test")
    for size in h.sizes:
        assert size.typical > 0
        if option := effect.options.get(size.key):
            value = (
                0.0 if size.growth == "bend" else size.typical
            )  # a bend is none where the others are typical
            assert (option.default, option.unit) == (value, size.unit)
            assert table[size.key] == pytest.approx(value)


@pytest.mark.parametrize("h", SIZED, ids=ident)
def test_it_grows_from_nothing(h: Hypothesis) -> None:
    changes = [change(h, a) for a in GROWING]
    typical = np.abs(changes[GROWING.index(1.0)]).max()
    assert typical > 1e-3
    assert np.abs(change(h, 0.0)).max() <= NEARLY_NOTHING * typical
    sizes = [float(np.linalg.norm(c)) for c in changes]
    assert sizes == sorted(sizes)
    # near its beginning the effect is in proportion to its amplitude
    small, larger = changes[0], changes[1]
    assert np.linalg.norm(larger / 0.3 - small / 0.1) < 0.25 * np.linalg.norm(small / 0.1)


@pytest.mark.parametrize("h", [h for h in SIZED if all(s.signed for s in h.sizes)], ids=ident)
def test_a_signed_one_also_shrinks(h: Hypothesis) -> None:
    up, down = change(h, 0.3), change(h, -0.3)
    assert np.linalg.norm(up + down) < 0.2 * np.linalg.norm(up)


@pytest.mark.parametrize("h", [h for h in SIZED if any(s.shape for s in h.sizes)], ids=ident)
def test_a_shape_changes_how_and_not_whether(h: Hypothesis) -> None:
    middle = change(h, 1.0)
    for shape in (-2.0, 2.0):
        other = change(h, 1.0, shape)
        assert 0.3 < np.linalg.norm(other) / np.linalg.norm(middle) < 3.0
        assert np.linalg.norm(other - middle) > 0.01 * np.linalg.norm(middle)


@pytest.mark.parametrize("h", [h for h in HYPOTHESES if not h.sizes], ids=ident)
def test_one_without_sizes_is_there_or_not(h: Hypothesis) -> None:
    assert np.abs(change(h, 1.0)).max() > 1.0


@pytest.mark.parametrize("h", SIZED, ids=ident)
@pytest.mark.parametrize("amplitude", [1e-3, 10.0])
def test_it_solves_far_from_its_typical_size(h: Hypothesis, amplitude: float) -> None:
    assert np.isfinite(change(h, amplitude)).all()


def test_a_sharp_stop_of_a_wide_gap() -> None:
    for gap, contact in ((6.0, 0.0), (0.0, 6.0)):
        (h,) = (h for h in HYPOTHESES if h.name == "tie_rod_free_play ROB")
        table = h.options({"gap_mm": gap, "contact_N_mm": contact})
        axle = apply_effect(nominal(), h.effect, table, source="test")
        assert solve(axle, lanes=True).failure is None


def test_values_of_sizes() -> None:
    assert Size("k", 6000.0, "N/mm", "compliance").value(2.0) == 3000.0
    assert Size("k", 6000.0, "N/mm", "compliance").value(0.0) == 6e7
    assert Size("r", 14.0, "mm", "compliance", power=4.0).value(16.0) == 7.0
    assert Size("f", 1.2, "-", "factor", signed=True).value(-1.0) == pytest.approx(1 / 1.2)
    assert Size("g", 0.2, "mm").value(-1.0) == Size("g", 0.2, "mm").value(0.0) == pytest.approx(2e-5)
    assert Size("g", 0.2, "mm", signed=True).value(-2.0) == -0.4
    assert Size("z", 0.3, "mm", "shape").value(0.0) == 0.3


@pytest.mark.parametrize(
    ("size", "value", "times"),
    [
        (Size("k", 6000.0, "N/mm", "compliance"), 3000.0, 2.0),
        (Size("r", 14.0, "mm", "compliance", power=4.0), 7.0, 16.0),
        (Size("f", 1.2, "-", "factor", signed=True), 1.0 / 1.2, -1.0),
        (Size("g", 0.2, "mm", signed=True), -0.4, -2.0),
        (Size("z", 0.3, "mm", "shape"), 0.6, 2.0),
        (Size("b", 0.5, "-", "bend"), -0.25, -0.5),
    ],
)
def test_a_value_over_the_typical_size(size: Size, value: float, times: float) -> None:
    assert size.over_typical(value) == pytest.approx(times)


@pytest.mark.parametrize("h", SIZED, ids=ident)
def test_an_amplitude_is_that_of_its_value(h: Hypothesis) -> None:
    for size in h.sizes:
        for amplitude in (0.3, 1.0, 2.0):
            assert size.amplitude(size.value(amplitude)) == pytest.approx(amplitude)


@pytest.mark.parametrize("h", SIZED, ids=ident)
def test_numbers_by_another_law_are_numbers_of_that_law(h: Hypothesis) -> None:
    """A law that does nearly the same has them all in reach, and one that stays has none that change."""
    effect = ALL_EFFECTS[h.effect]
    variants = effect.variants(h)
    for law in variants:
        assert not effect.numbers_by(law.law, options(law, 1.0))
        for before in variants:
            numbers = effect.numbers_by(law.law, options(before, 1.0))
            assert set(numbers) <= {size.key for size in law.sizes}
            at = dict(options(law, 1.0)) | dict(numbers)
            assert apply_effect(short(), h.effect, at, source="test").values


def test_variants_of_a_friction_are_its_laws() -> None:
    (own,) = EFFECTS["strut_friction"].hypotheses()
    variants = EFFECTS["strut_friction"].variants(own)
    assert [v.law for v in variants] == ["", "iwan", "duhem", "lognormal", "backbone"]
    assert {v.name for v in variants} == {own.name}
    for variant in variants:
        assert variant.sizes[: len(own.sizes)] == own.sizes
        assert all(size.shape for size in variant.sizes[1:])
        axle = apply_effect(nominal(), own.effect, options(variant, 1.0), source="test")
        assert axle.topology.strut_friction == (variant.law or "dahl")
        assert axle.effects[own.effect].get("law", "dahl") == axle.topology.strut_friction
        assert axle.values["strut_friction.share2@L"] == pytest.approx(0.10)
    (arm,) = EFFECTS["steer_arm_compliance"].hypotheses()
    assert EFFECTS["steer_arm_compliance"].variants(arm) == (arm,)


@pytest.mark.parametrize(("effect", "prefix"), [("hub_compliance", "hub"), ("strut_bending", "strut")])
def test_a_hub_or_a_clamp_is_linear_or_stiffens(effect: str, prefix: str) -> None:
    (own,) = EFFECTS[effect].hypotheses()
    linear, stiffening = EFFECTS[effect].variants(own)
    assert linear == own and [s.name for s in stiffening.sizes] == [
        *(s.name for s in own.sizes), "loaded_factor", "reference_Nm",
    ]  # fmt: skip
    at_typical = {s.name: 0.0 if s.shape else 1.0 for s in stiffening.sizes}
    axle = apply_effect(nominal(), own.effect, stiffening.options(at_typical), source="test")
    assert getattr(axle.topology, f"{prefix}_stiffens")
    assert (axle.values[f"{prefix}.loaded_factor@R"], axle.values[f"{prefix}.reference@R"]) == (1.0, 300.0)
    linear_axle = apply_effect(nominal(), own.effect, {}, source="test")
    assert not getattr(linear_axle.topology, f"{prefix}_stiffens")
