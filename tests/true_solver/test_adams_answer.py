"""What ADAMS/Car writes of a parallel travel analysis is the load case `vertical`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from doe_kc.adams.results import read_result
from doe_kc.curves import CurveSet
from doe_kc.ground.errors import InputError
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.true_solver.answer import Unreadable, read_curves
from tests.reference import nominal


def own_curves() -> CurveSet:
    return curve_set(solve(nominal(), ["vertical"]))


def result_text(curves: CurveSet, *, radians: bool = False) -> str:
    """The curves in the XML of ADAMS: wheel travel as input, angles absolute."""
    case, static = curves.cases["vertical"], curves.static
    assert static is not None
    columns: dict[tuple[str, str], tuple[str, np.ndarray]] = {
        ("time", "TIME"): ("sec", np.arange(case.input.size, dtype=float))
    }
    angle = "rad" if radians else "deg"
    scale = np.pi / 180.0 if radians else 1.0
    for row, side in enumerate(("left", "right")):
        for response in ("toe", "camber", "caster"):
            columns[f"{response}_angle", side] = (
                angle,
                scale * (static[response][row] + case.mean[response][row]),
            )
        columns["wheel_travel", f"vertical_{side}"] = "mm", case.mean["wc_z"][row]
        columns[f"{side}_tire_forces", "normal"] = "newton", case.mean["tyre_load"][row]
    entities = "\n".join(
        f'<Entity name="{e}"><Component name="{c}" unitsValue="{u}" id="{i}"/></Entity>'
        for i, ((e, c), (u, _)) in enumerate(columns.items(), start=1)
    )
    steps = "\n".join(
        f'<Step type="quasiStatic">\n{" ".join(repr(float(v)) for v in row)}\n</Step>'
        for row in np.array([values for _, values in columns.values()]).T
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<Results xmlns="http://www.mscsoftware.com/:xrf10">'
        f'<Analysis name="a"><Units angle="deg" length="mm" force="newton"/><StepMap name="m">{entities}'
        f'</StepMap><Data name="quasiStatic_001">{steps}</Data></Analysis></Results>\n'
    )


@pytest.mark.parametrize("radians", [False, True])
def test_the_curves_are_those_that_were_written(radians: bool, tmp_path: Path) -> None:
    """The pad's travel follows from wheel travel and tyre load. The tyre gives way in the plane of the wheel,
    whose camber of 2 deg makes 0.02 mm of a stroke of 80."""
    own = own_curves()
    (tmp_path / "run_parallel_travel.res").write_text(result_text(own, radians=radians))
    curves = read_curves(tmp_path / "curves.csv", nominal(), ["vertical"], {})
    assert curves is not None and curves.static is not None and own.static is not None
    case, truth = curves.cases["vertical"], own.cases["vertical"]
    inside = np.isin(truth.input, case.input)
    assert inside.sum() > 55 and case.input[0] < -70.0 and case.input[-1] > 70.0
    for response in ("toe", "camber", "caster", "wc_z", "tyre_load"):
        gap = np.abs(case.mean[response] - truth.mean[response][:, inside]).max()
        assert gap < {"tyre_load": 5.0, "wc_z": 0.025}.get(response, 1e-3), response
    assert curves.static["toe"] == pytest.approx(own.static["toe"], abs=1e-6)


def test_a_curves_file_counts_before_it(tmp_path: Path) -> None:
    from doe_kc.reports.simulation.tables import write_simulation

    write_simulation(solve(nominal(), ["vertical", "roll"]), tmp_path)
    (tmp_path / "x_parallel_travel.res").write_text("not even XML")
    curves = read_curves(tmp_path / "curves.csv", nominal(), ["vertical", "roll"], {})
    assert curves is not None and "wc_x" in curves.cases["vertical"].mean


def test_it_completes_a_curves_file_of_other_load_cases(tmp_path: Path) -> None:
    from doe_kc.reports.simulation.tables import write_simulation

    write_simulation(solve(nominal(), ["roll"]), tmp_path)
    (tmp_path / "x_parallel_travel.res").write_text(result_text(own_curves()))
    curves = read_curves(tmp_path / "curves.csv", nominal(), ["vertical", "roll"], {})
    assert curves is not None and set(curves.cases) == {"vertical", "roll"}
    assert "wc_x" in curves.cases["roll"].mean and "wc_x" not in curves.cases["vertical"].mean


@pytest.mark.parametrize(
    ("old", "new", "pattern"),
    [
        ("</Results>", "", "not whole XML"),
        ("<?xml", "REQUEST", "is no XML"),
        ('name="toe_angle"', 'name="other"', "^$"),
        ("left_tire_forces", "tyre", "has no request left_tire_forces.normal"),
        ('unitsValue="newton"', 'unitsValue="stone"', "is in 'stone', expected a unit of force"),
        ('id="3"', 'id="2"', "names a component or an id twice"),
        ('id="3"', 'id="x"', "has the id 'x'"),
        ("<Step type", "<Step><!-- --></Step><Step type", "a step has 0 values"),
        ("<StepMap", "<Map", "not whole XML"),
    ],
)
def test_results_that_are_wrong_are_told(old: str, new: str, pattern: str, tmp_path: Path) -> None:
    text = result_text(own_curves())
    assert old in text
    (tmp_path / "x_parallel_travel.res").write_text(text.replace(old, new, 1))
    if pattern == "^$":  # toe of one side lacks: the response is not there
        with pytest.raises(Unreadable, match="toe_deg is missing"):
            read_curves(tmp_path / "curves.csv", nominal(), ["vertical"], {})
        return
    with pytest.raises(Unreadable, match=pattern):
        read_curves(tmp_path / "curves.csv", nominal(), ["vertical"], {})


TEXT = result_text(own_curves()).encode()


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, len(TEXT) - 1), st.binary(max_size=6), st.integers(0, 40), st.booleans())
def test_any_content_ends_in_numbers_or_one_sentence(
    tmp_path_factory: pytest.TempPathFactory, at: int, new: bytes, drop: int, cut: bool
) -> None:
    path = tmp_path_factory.mktemp("res") / "a_parallel_travel.res"
    path.write_bytes(TEXT[:at] + new + (b"" if cut else TEXT[at + drop :]))
    try:
        result = read_result(path)
    except InputError as error:
        assert str(path) in str(error) and "\n" not in str(error)
        return
    assert all(np.isfinite(v).all() for v in result.values.values())
