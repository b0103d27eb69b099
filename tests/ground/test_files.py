"""Reading user files: bytes, TOML, validation in words."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Annotated, Literal

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import BaseModel, ConfigDict, Field

from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_bytes, read_toml, validate


class Part(BaseModel):
    model_config = ConfigDict(extra="forbid")

    radius: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 1.0
    share: Annotated[float, Field(ge=0, le=1)] = 0.0


class File(BaseModel):
    model_config = ConfigDict(extra="forbid")

    schema_: Literal["a/1"] = Field(default="a/1", alias="schema")
    part: Part = Part()
    count: int


def test_bytes_or_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"x")
    assert read_bytes(tmp_path / "a", "file") == b"x"
    for path, pattern in (
        (tmp_path / "b", "there is no such axle file; check the path"),
        (tmp_path, "is a folder, expected an? axle file"),
        (tmp_path / "a" / "b", "the axle file cannot be read .Not a directory"),
        (tmp_path / ("n" * 300), "cannot be read .File name too long"),
        (tmp_path / "a\0b", "cannot be read"),
    ):
        with pytest.raises(InputError, match=pattern):
            read_bytes(path, "axle file")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_a_file_without_permission(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_text("x")
    path.chmod(0)
    with pytest.raises(InputError, match="Permission denied"):
        read_bytes(path, "file")


@pytest.mark.parametrize(
    ("content", "pattern"),
    [
        (b"a = b\n", r"not valid TOML.*line 1, column"),
        (b"a = 1\nb = [1,\n", r"not valid TOML"),
        (b"a = 1\na = 2", "not valid TOML"),
        (b"\xff", "not UTF-8"),
        (b"PK\x03\x04", "Excel workbook"),
        (b"\xd0\xcf\x11\xe0", "Excel workbook"),
        (b"a = " + b"1" * 5000, "not valid TOML"),
        (b"a = " + b"[" * 5000, "not valid TOML"),
        (b"a = \x00", "not valid TOML"),
    ],
)
def test_toml_that_is_none(tmp_path: Path, content: bytes, pattern: str) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=pattern) as caught:
        read_toml(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_toml_that_is_one(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text('name = "Größe"\r\n[a]\r\nb = 1\r\n', encoding="utf-8")
    assert read_toml(path) == {"name": "Größe", "a": {"b": 1}}


@settings(max_examples=100, deadline=None)
@given(data=st.binary(max_size=100))
def test_any_toml(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "any.toml"
    path.write_bytes(data)
    with contextlib.suppress(InputError):
        assert isinstance(read_toml(path), dict)


@pytest.mark.parametrize(
    ("document", "sentence"),
    [
        ({}, "f: key count is missing; add it."),
        ({"count": 1, "cuont": 2}, 'f: key cuont is unknown; remove or rename it. Did you mean "count"?'),
        (
            {"count": 1, "shema": "a/1"},
            'f: key shema is unknown; remove or rename it. Did you mean "schema"?',
        ),
        (
            {"count": 1, "part": {"raduis": 2}},
            'f: key part.raduis is unknown; remove or rename it. Did you mean "radius"?',
        ),
        (
            {"count": 1, "zzz": 2},
            "f: key zzz is unknown; remove or rename it. Known there: schema, part, count.",
        ),
        ({"count": 1, "schema": "a/2"}, "f: schema is 'a/2', expected 'a/1'."),
        ({"count": 1, "part": {"radius": 0}}, "f: part.radius is 0, expected a number > 0."),
        ({"count": 1, "part": {"radius": float("nan")}}, "f: part.radius is nan, expected a finite number."),
        ({"count": 1, "part": {"share": 2}}, "f: part.share is 2, expected a number <= 1."),
        ({"count": 1, "part": {"share": -2}}, "f: part.share is -2, expected a number >= 0."),
    ],
)
def test_sentences(document: dict[str, object], sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        validate(File, document, "f")
    assert str(caught.value) == sentence


def test_a_long_value_is_cut() -> None:
    with pytest.raises(InputError) as caught:
        validate(File, {"count": "x" * 1000}, "f")
    assert "f: count is 'xxx" in str(caught.value) and len(str(caught.value)) < 200
    assert validate(File, {"count": 3}, "f").count == 3
