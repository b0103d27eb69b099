"""`doe-kc simulate`: its files against the reference curves, `--set`, `--effect`, `--case`, `--roll`."""

from __future__ import annotations

import json
import tomllib
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from doe_kc.axle import parameter_value, with_values
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.cli.commands.simulate import apply_effects, apply_settings
from doe_kc.ground.errors import InputError
from doe_kc.load_cases import CASE_ORDER
from tests.cli.runner import AXLE, fails, succeeds
from tests.reference import CASE_NAMES, DATA, OTHER_PATHS, POINT_NAMES, nominal, reference_curves

COLUMNS = [
    "load_case",
    "branch",
    "step",
    "input",
    "input_unit",
    "side",
    "toe_deg",
    "camber_deg",
    "caster_deg",
    "spin_deg",
    "wc_x_mm",
    "wc_y_mm",
    "wc_z_mm",
    "tyre_load_N",
]
THEIRS = {
    "toe_deg": "toe_deg",
    "camber_deg": "camber_deg",
    "caster_deg": "caster_deg",
    "spin_deg": "caster_knuckle_deg",
    "wc_x_mm": "wc_dx_mm",
    "wc_y_mm": "wc_dy_mm",
    "wc_z_mm": "wc_dz_mm",
    "tyre_load_N": "fz_N",
}
EFFECTS = sorted(p.stem.removeprefix("effect_") for p in DATA.glob("effect_*.toml"))


def tolerance(column: str, values: np.ndarray) -> np.ndarray:
    if column.endswith("_deg"):
        return np.full(len(values), 1e-3)
    return np.full(len(values), 1e-2) if column.endswith("_mm") else np.maximum(1.0, 2e-4 * np.abs(values))


def simulated(folder: Path, *options: str) -> pd.DataFrame:
    succeeds("simulate", AXLE, *options, "--out", folder)
    return pd.read_csv(folder / "curves.csv")


@lru_cache
def expected(name: str) -> pd.DataFrame:
    """The reference curves with the project's load cases and inputs."""
    table = reference_curves(name).copy()
    table["load_case"] = table["case"].map(CASE_NAMES)
    steer = table["load_case"] == "steer"
    table.loc[steer, "input"] *= 360.0 / 52.0
    return table[table["load_case"].isin(CASE_ORDER)]


def assert_agrees(ours: pd.DataFrame, name: str) -> None:
    """Every point of the reference is among ours, within the accuracy asked for."""
    groups = dict(iter(ours.groupby(["load_case", "branch", "side"])))
    compared = 0
    for key, rows in expected(name).groupby(["load_case", "branch", "side"]):
        own = groups[key]
        index = np.abs(own["input"].to_numpy()[:, None] - rows["input"].to_numpy()).argmin(axis=0)
        np.testing.assert_allclose(own["input"].to_numpy()[index], rows["input"], atol=1e-4)
        for column, theirs in THEIRS.items():
            gap = np.abs(own[column].to_numpy()[index] - rows[theirs].to_numpy())
            limit = tolerance(column, rows[theirs].to_numpy())
            assert (gap <= limit).all(), (key, column, (gap / limit).max())
        compared += 1
    assert compared == len(groups)


def as_settings(number: int) -> list[str]:
    """variant_N.toml as a user would type it: points add, factors of the axle's own scale, angles add."""
    document = tomllib.loads((DATA / f"variant_{number}.toml").read_text())
    out = []
    for point, change in document["points"].items():
        out += [f"{POINT_NAMES.get(point, point)}.{axis}+={d}" for axis, d in zip("xyz", change, strict=True)]
    for bushing, factors in document["bushing"].items():
        axes = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")
        out += [f"{bushing.lower()}.{axis}={f}" for axis, f in zip(axes, factors, strict=True)]
    for key, value in document["other"].items():
        out.append(f"{OTHER_PATHS[key]}{'+=' if key.startswith('wheel.') else '*='}{value}")
    return [word for setting in out for word in ("--set", setting)]


def as_effect(ident: str) -> str:
    """effect_ID.toml as ID:key=value,..."""
    (options,) = tomllib.loads((DATA / f"effect_{ident}.toml").read_text()).values()
    return f"{ident}:" + ",".join(f"{k}={as_toml(v)}" for k, v in options.items())


def as_toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {v}" for k, v in value.items()) + " }"
    return str(value)


@pytest.fixture(scope="module")
def nominal_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Files of the unchanged axle."""
    folder = tmp_path_factory.mktemp("nominal")
    succeeds("simulate", AXLE, "--out", folder / "new" / "out", "--json", folder / "deep" / "f.json")
    return folder


def test_curves_have_the_agreed_columns(nominal_run: Path) -> None:
    curves = pd.read_csv(nominal_run / "new" / "out" / "curves.csv")
    assert list(curves.columns)[:14] == COLUMNS
    assert list(dict.fromkeys(curves["load_case"])) == list(CASE_ORDER)
    assert set(curves["side"]) == {"L", "R"} and set(curves["branch"]) == {"pos", "neg"}
    assert not curves.isna().any().any()
    units = curves.groupby("load_case")["input_unit"].unique().map(list)
    assert units["vertical"] == ["mm"] and units["roll"] == ["deg"] and units["brake"] == ["N"]
    keys = curves[["load_case", "branch", "step", "side"]]
    assert not keys.duplicated().any()


def test_angles_are_absolute_and_the_wheel_centre_is_a_change(nominal_run: Path) -> None:
    curves = pd.read_csv(nominal_run / "new" / "out" / "curves.csv")
    start = curves[curves["step"] == 0]
    assert (start["input"] == 0).all()
    assert start[["wc_x_mm", "wc_y_mm", "wc_z_mm"]].abs().max().max() < 1e-9
    np.testing.assert_allclose(start["camber_deg"], -0.518686, atol=1e-5)
    np.testing.assert_allclose(start["caster_deg"], 4.205785, atol=1e-5)
    np.testing.assert_allclose(start["tyre_load_N"], 4300.0, atol=1e-4)


def test_curves_agree_with_the_reference(nominal_run: Path) -> None:
    assert_agrees(pd.read_csv(nominal_run / "new" / "out" / "curves.csv"), "nominal")


def test_characteristics_table_and_json_hold_the_same(nominal_run: Path) -> None:
    table = pd.read_csv(nominal_run / "new" / "out" / "characteristics.csv")
    assert list(table.columns) == ["name", "load_case", "response", "unit", "value"]
    assert list(table["name"]) == list(CHARACTERISTICS)
    document = json.loads((nominal_run / "deep" / "f.json").read_text())
    assert set(document) == {"characteristics", "seconds"} and document["seconds"] > 0
    for row in table.to_dict("records"):
        entry = document["characteristics"][row["name"]]
        assert set(entry) == {"value", "unit", "load_case"}
        assert (entry["unit"], entry["load_case"]) == (row["unit"], row["load_case"])
        assert entry["value"] == pytest.approx(row["value"], rel=1e-8, abs=1e-12)


def test_settings_reach_the_variant(tmp_path: Path) -> None:
    assert_agrees(simulated(tmp_path, *as_settings(1)), "variant_1")


@pytest.mark.parametrize("ident", EFFECTS)
def test_effects_reach_the_reference(tmp_path: Path, ident: str) -> None:
    assert_agrees(simulated(tmp_path, "--effect", as_effect(ident)), f"effect_{ident}")


def test_counter_phase_roll_mirrors_the_reference_pads(tmp_path: Path) -> None:
    """Theirs raises the left pad with a positive input, ours the right one."""
    ours = simulated(tmp_path, "--roll", "counter_phase", "--case", "roll")
    assert set(ours["input_unit"]) == {"mm"}
    theirs = reference_curves("nominal").query("case == 'roll_pads'")
    for side in "LR":
        own = ours[ours["side"] == side].sort_values("input")
        rows = theirs[theirs["side"] == side]
        for column in ("toe_deg", "camber_deg", "tyre_load_N"):
            values = np.interp(-rows["input"], own["input"], own[column])
            limit = tolerance(column, rows[THEIRS[column]].to_numpy())
            assert (np.abs(values - rows[THEIRS[column]]) <= limit).all(), (side, column)
    up = ours[(ours["side"] == "R") & (ours["branch"] == "pos")]
    assert up["tyre_load_N"].iloc[-1] > up["tyre_load_N"].iloc[0]


def test_a_load_case_alone_is_what_it_is_among_all(nominal_run: Path, tmp_path: Path) -> None:
    outcome = succeeds(
        "simulate", AXLE, "--case", "brake", "--case", "drive", "--out", tmp_path, "--json", tmp_path / "j"
    )
    some, every = (pd.read_csv(p / "curves.csv") for p in (tmp_path, nominal_run / "new" / "out"))
    assert list(dict.fromkeys(some["load_case"])) == ["brake", "drive"]
    for case in ("brake", "drive"):
        pd.testing.assert_frame_equal(
            some[some["load_case"] == case].reset_index(drop=True),
            every[every["load_case"] == case].reset_index(drop=True),
            check_dtype=False,
        )
    names = set(json.loads((tmp_path / "j").read_text())["characteristics"])
    wanted = {i for i in CHARACTERISTICS if i.split(".")[0] in {"brake", "drive", "static"}}
    assert names == wanted | {"vertical.static_caster"}
    assert {line.split()[0] for line in outcome.out.splitlines()} == names


def test_results_go_to_stdout_and_the_rest_to_stderr(tmp_path: Path) -> None:
    outcome = succeeds("simulate", AXLE, "--case", "lateral", "--out", tmp_path)
    assert "wrote" not in outcome.out and "lateral.toe_change" in outcome.out
    assert outcome.err.splitlines() == [
        f"wrote {tmp_path / 'curves.csv'}",
        f"wrote {tmp_path / 'characteristics.csv'}",
    ]


def test_settings_set_add_and_scale_in_order() -> None:
    start = parameter_value(nominal(), "LLF.x")
    cases = {
        ("LLF.x=100",): 100.0,
        ("LLF.x+=1.5",): start + 1.5,
        ("LLF.x+=-1.5",): start - 1.5,
        ("LLF.x*=1.01",): start * 1.01,
        ("LLF.x=100", "LLF.x+=1", "LLF.x*=2"): 202.0,
        ("LLF.x=100", "LLF.x*=2", "LLF.x+=1"): 201.0,
        ("LLF.x+=1", "LLF.x=7"): 7.0,
        (" LLF.x += 1e0 ",): start + 1.0,
    }
    for settings, value in cases.items():
        assert parameter_value(apply_settings(nominal(), settings), "LLF.x") == pytest.approx(value, 1e-14)


def test_settings_hold_absolute_values_and_carry_followers() -> None:
    changed = apply_settings(nominal(), ["llr.Fx=0.8", "UPB.x+=2", "right.LLR.y+=1"])
    assert parameter_value(changed, "llr.Fx") == 0.8
    for point in ("UPB.x", "UPS.x", "right.UPS.x"):
        assert parameter_value(changed, point) == pytest.approx(parameter_value(nominal(), point) + 2.0)
    assert parameter_value(changed, "LLR.y") == parameter_value(nominal(), "LLR.y")
    assert parameter_value(changed, "right.LLR.y") == parameter_value(nominal(), "right.LLR.y") + 1.0
    assert apply_settings(nominal(), []) is nominal()


def test_effects_come_before_settings(tmp_path: Path) -> None:
    """So that --set reaches what --effect brings."""
    direct, later = (
        simulated(tmp_path / name, "--case", "lateral", *options)
        for name, options in {
            "a": ("--effect", "hub_compliance:camber_Nm_deg=3000,toe_Nm_deg=9000"),
            "b": ("--set", "hub.camber*=0.5", "--effect", "hub_compliance"),
        }.items()
    )
    pd.testing.assert_frame_equal(direct, later, check_exact=False, rtol=1e-7, atol=1e-9)


def test_effect_values_may_be_words_lists_and_tables() -> None:
    axle = apply_effects(
        nominal(),
        [
            "strut_friction:law=iwan,force_N=100",
            "bushing_preload:LLR=[0, 600, 0],LLF=[1,2,3]",
            "tie_rod_free_play:joints=[ROB_L],gap_mm=0.1",
            "left_right_asymmetry:LLR_R=1.25",
            "ride_height_offset",
        ],
    )
    assert axle.effects["strut_friction"] == {"law": "iwan", "force_N": 100}
    assert axle.effects["bushing_preload"] == {"LLR": [0, 600, 0], "LLF": [1, 2, 3]}
    assert axle.effects["tie_rod_free_play"]["joints"] == ["ROB_L"]
    assert axle.effects["ride_height_offset"] == {}


@pytest.mark.parametrize(
    "text", ["1" * 5000, "[" * 3000 + "]" * 3000, "[" * 300 + "x" + "]" * 300, "{", "1979-05-27", "nan"]
)
def test_no_effect_value_breaks_the_reader(text: str) -> None:
    with pytest.raises(InputError, match="strut_friction"):
        apply_effects(nominal(), [f"strut_friction:force_N={text}"])


def test_settings_are_those_of_the_library() -> None:
    ours = apply_settings(nominal(), ["LLF.z+=1", "arb.radius*=1.1"])
    wanted = {
        "LLF.z": parameter_value(nominal(), "LLF.z") + 1.0,
        "arb.radius": parameter_value(nominal(), "arb.radius") * 1.1,
    }
    assert ours.values == with_values(nominal(), wanted).values


def test_the_deformed_shape_is_drawn_where_asked_for(tmp_path: Path) -> None:
    succeeds("simulate", str(AXLE), "--case", "drive", "--out", str(tmp_path), "--pictures", "svg")
    assert (tmp_path / "shape_drive.svg").stat().st_size > 5000
    fails(2, "--pictures: needs a folder", "simulate", str(AXLE), "--case", "drive", "--pictures", "png")


def test_kinematic_has_no_compliance(tmp_path: Path) -> None:
    outcome = succeeds("simulate", AXLE, "--kinematic", "--case", "lateral", "--json", tmp_path / "k.json")
    elastic = succeeds("simulate", AXLE, "--case", "lateral", "--json", tmp_path / "e.json")
    assert not outcome.err and elastic.out != outcome.out
    rigid, soft = (
        json.loads((tmp_path / f"{name}.json").read_text())["characteristics"]["lateral.wc_lateral_disp"]
        for name in "ke"
    )
    assert abs(rigid["value"]) < 0.05 * abs(soft["value"])
    fails(2, "--kinematic: the axle has the effect hub_compliance", "simulate", AXLE, "--kinematic",
          "--effect", "hub_compliance")  # fmt: skip
