"""The rig's set-up against the model's."""

from __future__ import annotations

from doe_kc.axle import design_parameters, with_values
from doe_kc.axle_file import read_axle
from doe_kc.measurement import load_manifest
from doe_kc.solver.suite import solve
from doe_kc.workflow.measure import vertical_scatter
from doe_kc.workflow.setup import setup_differences
from tests.reference import EXAMPLE, nominal


def test_the_example_is_set_up_as_its_model() -> None:
    assert setup_differences(nominal(), load_manifest(EXAMPLE / "rig" / "test.toml")) == []


def test_another_ratio_or_load_is_told() -> None:
    axle = with_values(nominal(), {"steering.rack_mm_per_rev": 50.0, "tyre.static_load": 4000.0})
    told = setup_differences(axle, load_manifest(EXAMPLE / "rig" / "test.toml"))
    assert len(told) == 2
    assert "rack_mm_per_rev is 52, the model's 50" in told[0]
    assert "4300" in told[1] and "[tyre] static_load" in told[1]


def test_records_that_the_axle_has_no_load_case_for_are_told() -> None:
    axle = read_axle(EXAMPLE.parent / "five_link_rear" / "axle.toml")
    told = setup_differences(axle, load_manifest(EXAMPLE / "rig" / "test.toml"))
    assert "has records of steer, no load case of the axle: left out" in told[-1]


def test_scatter_starts_at_zero_and_leaves_out_what_is_looked_for() -> None:
    scatter = vertical_scatter(nominal(), solve(nominal(), ["vertical"], compiled=False))
    assert scatter["toe"].shape[0] == 65
    assert abs(scatter["toe"][32]).max() == 0.0
    by_path = {p.path: p.production_sd for p in design_parameters(nominal())}
    assert all(
        by_path[path] == 0.0 for path in ("ride_height", "bump_stop.clearance", "rebound_stop.clearance")
    )
    assert by_path["LLF.x"] == 1.0 and by_path["llr.Fx"] == 0.2
