"""Any content of any file of a database ends in an axle's tables or an InputError, nothing else."""

from __future__ import annotations

import shutil
import tempfile
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from doe_kc.adams.import_axle import convert
from doe_kc.ground.errors import InputError
from tests.adams.cases import MCPHERSON_DATABASE, WISHBONE_DATABASE, mcpherson_source, wishbone_source

FEW = settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))
FILES = [
    (MCPHERSON_DATABASE, "assemblies.tbl/front_axle.asy"),
    (MCPHERSON_DATABASE, "subsystems.tbl/front.sub"),
    (MCPHERSON_DATABASE, "subsystems.tbl/rack.sub"),
    (MCPHERSON_DATABASE, "subsystems.tbl/bar.sub"),
    (MCPHERSON_DATABASE, "bushings.tbl/arm_rear.bus"),
    (MCPHERSON_DATABASE, "springs.tbl/spring.spr"),
    (MCPHERSON_DATABASE, "dampers.tbl/damper.dpr"),
    (MCPHERSON_DATABASE, "bumpstops.tbl/bump.bum"),
    (WISHBONE_DATABASE, "reboundstops.tbl/rebound.reb"),
    (WISHBONE_DATABASE, "springs.tbl/spring.xml"),
]
VALUES = [
    *(
        "1e300",
        "-1e300",
        "nan",
        "inf",
        "1e-320",
        "0",
        "-0.0",
        "1D3",
        "'x'",
        "''",
        "",
        "'",
        "1 2 3",
        "9" * 400,
    ),
    *(
        "'left'",
        "'right'",
        "'single'",
        "'left/right'",
        "\x00",
        "\u2028",
        "ä",
        "$",
        "{",
        "}",
        "[",
        "(",
        "=",
        "<OWN>/",
    ),
    *(
        "'mdids://'",
        "'<OWN>/../x'",
        "'..'",
        "'/'",
        "'" + "a/" * 2000 + "'",
        "'preload'",
        "'installed_length'",
    ),
]


@lru_cache
def copy_of(database: Path) -> tuple[tempfile.TemporaryDirectory[str], Path]:
    """A copy for all tests, whose changed files are put back: 900 copies take longer than the tests."""
    folder = tempfile.TemporaryDirectory()
    return folder, shutil.copytree(database, Path(folder.name) / database.name)


def convert_changed(database: Path, file: str, content: bytes) -> None:
    _, copy = copy_of(database)
    (copy / file).write_bytes(content)
    source = mcpherson_source if database is MCPHERSON_DATABASE else wishbone_source
    kind = "mcpherson_front" if database is MCPHERSON_DATABASE else "double_wishbone_front"
    try:
        c = convert(source(copy, type=kind))
    except InputError as error:
        assert len(str(error)) < 3000
        assert "\n" not in str(error)
        return
    finally:
        shutil.copyfile(database / file, copy / file)
    for name, place in c.document["hardpoints"].items():
        assert np.isfinite(place).all(), name


@pytest.mark.parametrize(("database", "file"), FILES, ids=lambda v: Path(v).name)
def test_a_few_bytes_replaced_or_the_end_missing(database: Path, file: str) -> None:
    raw = (database / file).read_bytes()

    @FEW
    @given(st.integers(0, len(raw)), st.binary(max_size=6), st.integers(0, 12), st.booleans())
    def run(at: int, new: bytes, drop: int, cut: bool) -> None:
        convert_changed(database, file, raw[:at] + new + (b"" if cut else raw[at + drop :]))

    run()


@pytest.mark.parametrize(("database", "file"), FILES, ids=lambda v: Path(v).name)
def test_a_word_of_another_kind(database: Path, file: str) -> None:
    lines = (database / file).read_text(encoding="utf-8").split("\n")
    filled = [i for i, line in enumerate(lines) if line.strip()]

    @FEW
    @given(st.sampled_from(filled), st.integers(0, 8), st.sampled_from(VALUES))
    def run(at: int, word: int, value: str) -> None:
        words = lines[at].split(" ")
        places = [i for i, w in enumerate(words) if w]
        words[places[word % len(places)]] = value
        text = "\n".join([*lines[:at], " ".join(words), *lines[at + 1 :]])
        convert_changed(database, file, text.encode("utf-8"))

    run()


@pytest.mark.parametrize(("database", "file"), FILES, ids=lambda v: Path(v).name)
def test_lines_lost_doubled_or_moved(database: Path, file: str) -> None:
    lines = (database / file).read_text(encoding="utf-8").split("\n")

    @FEW
    @given(
        st.lists(st.integers(0, len(lines) - 1), max_size=4),
        st.lists(st.integers(0, len(lines) - 1), max_size=2),
    )
    def run(lost: list[int], doubled: list[int]) -> None:
        out = [x for i, line in enumerate(lines) if i not in lost for x in [line] * (1 + doubled.count(i))]
        convert_changed(database, file, "\n".join(out).encode("utf-8"))

    run()


@FEW
@given(st.sampled_from(FILES), st.binary(max_size=300))
def test_arbitrary_bytes(place: tuple[Path, str], content: bytes) -> None:
    convert_changed(*place, content)
