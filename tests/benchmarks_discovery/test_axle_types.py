"""Hidden cars of other axle types: what is drawn for them, and records that the analyser can read."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from benchmarks.discovery.chance import stream
from benchmarks.discovery.clutter import clutter
from benchmarks.discovery.generator import hidden_car
from benchmarks.discovery.scatter import Spread, scattered, unequal
from benchmarks.discovery.suites import ALIKE, of_type
from benchmarks.discovery.vehicles import TYPE_BASES, nominal_axle
from doe_kc.axle.places import places_of
from doe_kc.axle_file import read_axle
from doe_kc.effects import EFFECTS
from doe_kc.measurement import reduce_measurement


@pytest.mark.parametrize("base", TYPE_BASES)
def test_cars_have_one_or_two_effects_that_their_axle_can_have(base: str) -> None:
    axle = nominal_axle(base, 0)
    drawn = []
    for seed in range(24):
        hidden = of_type(seed, stream(seed, "test"), axle).hidden
        assert len(hidden) == 1 + seed % 2 and len({h.id for h in hidden}) == len(hidden)
        assert not any({h.id for h in hidden} == set(pair) for pair in ALIKE)
        drawn += [h.id for h in hidden]
    assert all(EFFECTS[ident].possible(places_of(axle)) for ident in drawn)
    usual = ("hub_compliance", "subframe_flexibility", "damper_friction")
    assert {e for e in usual if EFFECTS[e].possible(places_of(axle))} <= set(drawn)
    assert ("rack_mount_compliance" in drawn) == (axle.rack_mm_per_rev > 0)


@pytest.mark.parametrize("base", TYPE_BASES)
def test_scatter_and_clutter_are_of_the_axles_own_parts(base: str) -> None:
    axle = nominal_axle(base, 0)
    points = axle.topology.structure.points
    values = scattered(axle, stream(1, "car"), Spread())
    assert {f"{p}.z" for p in points if p != "ARB"} <= set(values)
    sides = unequal(axle, stream(1, "car"), 1.0)
    assert {f"{p}.x@R" for p in points} <= set(sides) <= set(axle.values)
    small = clutter(axle, stream(1, "clutter"), {"hub_compliance"})
    assert "strut_bending" not in {h.id for h in small} and "hub_compliance" not in {h.id for h in small}
    (preload,) = [h for h in small if h.id == "bushing_preload"]
    assert set(preload.options) == {name.upper() for name in places_of(axle).bushings}


def test_records_of_a_rear_axle_are_read(tmp_path: Path) -> None:
    car = hidden_car(0, "type", base="five_link_rear", clutter_in=False)
    folder = car.write(tmp_path)
    assert read_axle(folder / "axle.toml").values == car.nominal.values
    setup = tomllib.loads((folder / "records" / "test.toml").read_text())["setup"]
    assert setup["steering"] == "none" and "rack_mm_per_rev" not in setup
    measured = reduce_measurement(folder / "records", half_track=car.nominal.half_track)
    assert set(measured.curves.cases) == set(car.nominal.load_cases)
    assert np.isfinite(measured.characteristics["vertical.bump_steer"].value)
