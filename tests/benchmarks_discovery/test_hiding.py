"""What is hidden does what it says, by other laws than the analyser's."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.discovery.car import Car, CleanRecords, with_tables
from benchmarks.discovery.catalogue import CATALOGUE, REFERENCE
from benchmarks.discovery.chance import stream
from benchmarks.discovery.further import FURTHER
from benchmarks.discovery.generator import HiddenCar
from benchmarks.discovery.hidden import Hidden
from benchmarks.discovery.laws import REFERENCE as DEFLECTION
from benchmarks.discovery.laws import SHAPES, Shape, table
from benchmarks.discovery.other_laws import OTHER_LAWS, rubber
from benchmarks.discovery.outside import OUTSIDE, Outside
from benchmarks.discovery.path import Bench, triangle
from benchmarks.discovery.suites import ALIKE, SUITES
from doe_kc.curves import RIG_RESPONSES
from doe_kc.effects import EFFECTS, apply_effect

NOISE = {"toe": 0.003, "camber": 0.003, "spin": 0.003, "wc_x": 0.02, "wc_y": 0.02, "wc_z": 0.02}


def _records(
    plain: HiddenCar, hidden: tuple[Hidden, ...] = (), outside: Outside | None = None
) -> CleanRecords:
    return Car(plain.car.axle, hidden, (), outside, plain.car.warp).clean()


def _largest(one: CleanRecords, other: CleanRecords) -> float:
    """Largest difference over the white noise of its sensor."""
    return max(
        float(np.abs(one.recorded(case, r) - other.recorded(case, r)).max()) / NOISE.get(r, 4.0)
        for case in one.loops
        for r in RIG_RESPONSES
    )


@pytest.mark.parametrize("ident", [*REFERENCE, *FURTHER])
def test_every_effect_changes_the_records(ident: str, plain: HiddenCar) -> None:
    hidden = CATALOGUE[ident](stream(1, ident), 1.0, plain.nominal)
    assert hidden.id in EFFECTS
    assert _largest(_records(plain, (hidden,)), plain.clean) > 1.0


@pytest.mark.parametrize("ident", [*REFERENCE, *FURTHER])
def test_parameters_are_those_of_the_library(ident: str, plain: HiddenCar) -> None:
    """Else a right answer could not be scored."""
    hidden = CATALOGUE[ident](stream(2, ident), 1.3, plain.nominal)
    fitting = [h for h in EFFECTS[ident].hypotheses() if h.location == hidden.location]
    assert fitting
    assert set(hidden.parameters) <= {s.name for h in fitting for s in h.sizes}


def test_friction_runs_its_steady_cycle(plain: HiddenCar) -> None:
    friction = {"force_N": 250.0, "presliding_mm": 0.05, "law": "iwan"}
    axle = apply_effect(plain.car.axle, "steering_friction", friction, source="test")
    case = axle.load_cases["lateral"]
    toe = Bench(axle).loop(case, triangle(case.amplitude, 0.2))["toe"][0]
    falling, rising = toe[:257], np.append(toe[256:], toe[0])[::-1]
    assert np.abs(falling - rising).max() > 0.01
    # it closes: the sample that would follow the last one is the first
    assert abs(2.0 * toe[-1] - toe[-2] - toe[0]) < 2e-4
    assert abs(toe[0] - toe[1]) > 0.0


@pytest.mark.parametrize("shape", SHAPES)
def test_tables_agree_with_the_cubic_at_one_deflection_only(shape: Shape) -> None:
    d, force = np.array(table(1500.0, 0.01, 0.05, shape, 0.4)).T
    cubic = 1500.0 * (d + 0.06 * d**3)
    alike, other = np.abs(d) == DEFLECTION, np.abs(d) == 1.0
    np.testing.assert_allclose(force[alike], cubic[alike], rtol=1e-6)
    assert np.abs(force[other] / cubic[other] - 1.0).min() > 0.003
    assert (np.diff(force) > 0).all()


def test_table_replaces_the_stiffness_on_both_sides(plain: HiddenCar) -> None:
    axle = with_tables(plain.car.axle, {("llr", "Fx"): table(1500.0, 0.0, 0.0, "soft_stop", 0.4)})
    straight = plain.car.axle.changed({f"llr.cubic.Fx@{s}": 0.0 for s in "LR"})
    case = axle.load_cases["brake"]
    inputs = triangle(case.amplitude, 0.0)
    got, want = (Bench(a).loop(case, inputs)["wc_x"] for a in (axle, straight))
    np.testing.assert_allclose(got, want, atol=1e-3)


@pytest.mark.parametrize("kind", list(OUTSIDE))
def test_outside_effects_show_where_they_say(kind: str, plain: HiddenCar) -> None:
    outside = OUTSIDE[kind](stream(4, kind))
    changed = _records(plain, outside=outside)
    seen = {
        (case, r)
        for case in changed.loops
        for r in RIG_RESPONSES
        if np.abs(changed.recorded(case, r) - plain.clean.recorded(case, r)).max() > 4.0 * NOISE.get(r, 4.0)
    }
    assert seen & set(outside.shows)
    assert kind not in EFFECTS


def test_suites_hide_what_they_are_for(plain: HiddenCar) -> None:
    drawn = {
        suite: [fill(seed, stream(seed, suite), plain.nominal) for seed in range(26)]
        for suite, fill in SUITES.items()
    }
    assert all(not c.hidden and c.outside is None for c in drawn["null"])
    assert {c.hidden[0].id for c in drawn["single"]} == set(REFERENCE)
    assert all(0.5 <= c.hidden[0].size <= 2.0 for c in drawn["single"])
    assert all(0.1 <= c.hidden[0].size <= 0.3 for c in drawn["weak"])
    assert all(len({h.id for h in c.hidden}) == 2 for c in drawn["two"])
    assert all(c.exclude == (c.hidden[0].id,) for c in drawn["library_deleted"])
    assert {c.outside.kind for c in drawn["outside"] if c.outside} == set(OUTSIDE)
    assert all(c.hidden[0].id in c.pair for c in drawn["confounded"])
    assert {c.spread.width for c in drawn["wrong_priors"]} == {0.5, 2.0}


def test_suites_of_real_cars_hide_several_effects_rubber_and_other_laws(plain: HiddenCar) -> None:
    names = ("many", "many_rubber", "rubber", "other_law")
    drawn = {s: [SUITES[s](i, stream(i, s), plain.nominal).hidden for i in range(26)] for s in names}
    for hidden in drawn["many"]:
        ids = {h.id for h in hidden}
        assert len(ids) == len(hidden) <= 6
        assert not any(set(pair) <= ids for pair in ALIKE)
    assert np.mean([len(hidden) for hidden in drawn["many"]]) > 3.0
    assert all("rubber_hysteresis" in {h.id for h in hidden} for hidden in drawn["many_rubber"])
    assert all([h.id for h in hidden] == ["rubber_hysteresis"] for hidden in drawn["rubber"])
    assert {h.id for (h,) in drawn["other_law"]} >= {"bushing_progression", "strut_friction"}


def test_frictions_on_a_mount_follow_every_law_alike_often(plain: HiddenCar) -> None:
    fill = SUITES["friction_on_mount"]
    drawn = [fill(i, stream(i, "friction_on_mount"), plain.nominal).hidden for i in range(24)]
    assert all([h.id for h in hidden] == ["steering_friction", "rack_mount_compliance"] for hidden in drawn)
    laws = [(f.options["law"], f.options.get("spread")) for f, _ in drawn]
    assert set(laws) == {("iwan", None), ("lognormal", 1.0), ("lognormal", 0.4), ("backbone", None)}
    assert all(laws.count(law) == 6 for law in set(laws))


@pytest.mark.parametrize("law", ["rubber", *OTHER_LAWS])
def test_an_effect_by_another_law_changes_the_records(law: str, plain: HiddenCar) -> None:
    draw = {"rubber": rubber, **OTHER_LAWS}[law]
    hidden = draw(stream(1, law), 1.0, plain.nominal)
    assert hidden.id in EFFECTS
    assert _largest(_records(plain, (hidden,)), plain.clean) > 1.0
