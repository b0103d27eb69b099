"""Whatever bytes arrive, the readers answer with data or with one InputError."""

from __future__ import annotations

import contextlib
import tempfile
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from doe_kc.ground.errors import InputError
from doe_kc.measurement import load_manifest, read_record
from tests.measurement.synthetic import csv_text, record_columns

GOOD_CSV = csv_text(record_columns("vertical", samples=64)).encode()
GOOD_TOML = (
    b'name = "a"\n'
    + b"[setup]\nrack_mm_per_rev = 52\n[alignment]\nleft = { toe_deg = 0.1 }\n[records]\nroll = 'r'\n"
)


@st.composite
def damaged(draw: st.DrawFn, good: bytes) -> bytes:
    """Good bytes with a slice replaced by anything."""
    start = draw(st.integers(0, len(good)))
    stop = draw(st.integers(start, min(len(good), start + 40)))
    return good[:start] + draw(st.binary(max_size=20)) + good[stop:]


def read_any(data: bytes, name: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(data)
        with contextlib.suppress(InputError):
            if name.endswith(".toml"):
                load_manifest(path)
            else:
                read_record(path, "vertical")


@settings(max_examples=60, deadline=None)
@given(st.one_of(st.binary(max_size=300), damaged(GOOD_CSV)))
def test_any_csv(data: bytes) -> None:
    read_any(data, "a.csv")


@settings(max_examples=60, deadline=None)
@given(st.binary(max_size=300).map(lambda b: b"PK\x03\x04" + b))
def test_any_workbook(data: bytes) -> None:
    read_any(data, "a.xlsx")


TOML_TEXT = st.recursive(
    st.sampled_from(["1", "-2.5", "nan", '"x"', "true", "1979-05-27", "[]"]),
    lambda inner: st.lists(inner, max_size=3).map(lambda v: "[" + ", ".join(v) + "]"),
)
KEYS = st.sampled_from(
    [
        "name",
        "records",
        "records.roll",
        "alignment.left",
        "alignment.left.toe_deg",
        "setup",
        "setup.body",
        "x",
    ]
)
TOML = st.lists(st.tuples(KEYS, TOML_TEXT), max_size=6).map(
    lambda pairs: "\n".join(f"{k} = {v}" for k, v in pairs).encode()
)


@settings(max_examples=200, deadline=None)
@given(st.one_of(st.binary(max_size=200), damaged(GOOD_TOML), TOML))
def test_any_toml(data: bytes) -> None:
    read_any(data, "test.toml")
