"""Any content of the file ends in an axle or an InputError, never in another exception."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from doe_kc.axle import Axle, design_parameters, parameter_value, with_values
from doe_kc.axle_file import read_axle
from doe_kc.ground.errors import InputError
from tests.reference import EXAMPLE

TEXT = (EXAMPLE / "axle.toml").read_text()
LINES = TEXT.splitlines()
FEW = settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))


def read(content: bytes) -> Axle | InputError:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "axle.toml"
        path.write_bytes(content)
        try:
            axle = read_axle(path)
        except InputError as error:
            assert str(path) in str(error)
            assert len(str(error)) < 3000
            return error
    assert isinstance(axle, Axle)
    assert all(np.isfinite(v) for v in axle.values.values())
    return axle


@FEW
@given(st.binary(max_size=200))
def test_arbitrary_bytes(content: bytes) -> None:
    read(content)


@FEW
@given(st.integers(0, len(TEXT) - 1), st.binary(max_size=6), st.integers(0, 12))
def test_a_few_bytes_replaced(at: int, new: bytes, drop: int) -> None:
    raw = TEXT.encode()
    read(raw[:at] + new + raw[at + drop :])


VALUES = [
    *("1" + "0" * 400, "1" + "0" * 5000, "-1", "0", "1e308", "-1e308", "1e-308", "5e-324", "nan", "inf"),
    *("true", "1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", "[]", "[[]]", "[[0.0, 0.0]]", "{}"),
    *("{ a = 1 }", '""', '"\\u0000"', '"28.0"', "0xff", "0b1", "1_000", '[1, "a"]', "9223372036854775808"),
    *("[" * 200 + "]" * 200, "[" * 5000 + "]" * 5000, "{ a = { b = { c = [ { d = 1 } ] } } }", "-0.0"),
    *("[nan, 0.0, 0.0]", "[1, 2, 3]", "[true, false, true]", "[1e308, -1e308, 1e308]"),
]
KEYED = [i for i, line in enumerate(LINES) if " = " in line]


@FEW
@given(st.sampled_from(KEYED), st.sampled_from(VALUES))
def test_a_value_of_another_kind(line: int, value: str) -> None:
    key = LINES[line].split(" = ")[0]
    read("\n".join([*LINES[:line], f"{key} = {value}", *LINES[line + 1 :]]).encode())


@pytest.mark.parametrize("value", VALUES, ids=lambda v: v[:20] + str(len(v)))
@pytest.mark.parametrize(
    "where",
    [
        "[right]\n\"LLF.x\"",
        "[effects.hub_compliance]\ntoe_Nm_deg",
        "[effects.steering_friction]\nlaw",
        "[effects.tie_rod_free_play]\njoints",
        "[effects.left_right_asymmetry]\nscale",
        "[effects.left_right_asymmetry]\nLLR_R",
        "[effects.bushing_preload]\nLLR",
        "[effects.bushing_progression]\nLLR",
        "[effects.ride_height_offset]\noffset_mm",
        "[effects]\nhub_compliance",
        "[bushings.llr.table]\nFx",
        "[units]\nlength",
        "name",
    ],
    ids=lambda w: w.replace("\n", " "),
)  # fmt: skip
def test_a_value_of_any_kind_in_the_optional_places(where: str, value: str) -> None:
    key = where.rpartition("\n")[2]
    text = f"{where} = {value}\n{TEXT}" if "\n" not in where else f"{TEXT}\n{where} = {value}\n"
    if where in {"name", "[units]\nlength"}:
        text = "\n".join(f"{key} = {value}" if x.startswith(f"{key} = ") else x for x in LINES)
    read(text.encode())


@FEW
@given(st.lists(st.sampled_from(range(len(LINES))), max_size=6), st.integers(0, len(LINES)))
def test_lines_lost_or_the_end_missing(lost: list[int], end: int) -> None:
    read("\n".join(x for i, x in enumerate(LINES[: end or None]) if i not in lost).encode())


@FEW
@given(st.text(max_size=30), st.text(max_size=30))
def test_any_key_with_any_text(key: str, value: str) -> None:
    import json

    read(f"{json.dumps(key)} = {json.dumps(value)}\n{TEXT}".encode("utf-8", "surrogatepass"))


NUMBERS = [
    "rate = 28.0",
    "rate = 220.0",
    "static_load = 4300.0",
    "clearance = 22.0",
    "toe = 0.05",
    "camber = -0.50",
]


@FEW
@given(st.lists(st.floats(0.9, 1.1), min_size=len(NUMBERS), max_size=len(NUMBERS)))
def test_numbers_in_the_file_are_the_values_of_the_paths(factors: list[float]) -> None:
    text = TEXT
    paths = [
        "spring.rate",
        "tyre.rate",
        "tyre.static_load",
        "bump_stop.clearance",
        "static.toe",
        "static.camber",
    ]
    expected = {}
    for line, path, factor in zip(NUMBERS, paths, factors, strict=True):
        key, number = line.split(" = ")
        expected[path] = float(number) * factor
        text = text.replace(line, f"{key} = {expected[path]!r}")
    axle = read(text.encode())
    assert isinstance(axle, Axle)
    for path, value in expected.items():
        assert parameter_value(axle, path) == value


@FEW
@given(st.data())
def test_points_inside_the_bounds_are_axles(data: st.DataObject) -> None:
    from tests.reference import nominal

    values = {p.path: data.draw(st.floats(p.lower, p.upper)) for p in design_parameters(nominal())[::7]}
    axle = with_values(nominal(), values)
    for path, value in values.items():
        assert parameter_value(axle, path) == pytest.approx(value, rel=1e-12, abs=1e-12)
