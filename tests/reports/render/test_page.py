"""What a page is made of: escaped text, data that cannot break out, nothing fetched."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from markupsafe import Markup

from doe_kc.ground.errors import RunError
from doe_kc.reports.page.correlation import write_correlation_page
from doe_kc.reports.render.page import Section, embedded, page_html, significant
from tests.correlation.cases import measured
from tests.reports.correlations import CAR, EVIL, real, typed


def test_titles_are_escaped_and_lead_to_their_section() -> None:
    html = page_html(f"T {EVIL}", [Section("Missing effects & more", Markup("<p>x</p>"), lead=EVIL)])
    assert "<script>alert" not in html
    assert 'href="#missing-effects-more"' in html and 'id="missing-effects-more"' in html
    assert "<p>x</p>" in html


def test_control_characters_do_not_spoil_the_file() -> None:
    assert "\x00" not in page_html("a\x00b\ud800", [])
    page_html("a\x00b\ud800", []).encode("utf-8")


def test_embedded_data_reads_back() -> None:
    data = {"text": EVIL + "\u2028", "x": np.array([1.0, np.nan, math.pi]), "yes": np.bool_(True), "n": None}
    text = embedded(data)
    assert not set("<>&") & set(text)
    assert json.loads(text) == {"text": EVIL + "\u2028", "x": [1.0, None, 3.141593], "yes": True, "n": None}


def test_the_file_names_no_address_and_is_small(tmp_path: Path) -> None:
    path = write_correlation_page(tmp_path / "p.html", real(), measured(CAR), study="S", date="2026-01-31")
    html = path.read_text(encoding="utf-8")
    links = re.findall(r"""(?:src|href|action)\s*=\s*["']([^"']*)""", html)
    assert links and all(link.startswith(("#", "data:")) for link in links)
    assert set(re.findall(r"https?://[^\s\"'<)]+", html)) <= {"http://www.w3.org/2000/svg"}
    assert "url(" not in html.replace("url(#", "") and "@import" not in html
    assert path.stat().st_size < 1_000_000


def test_an_unwritable_place_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    with pytest.raises(RunError, match="out"):
        write_correlation_page(tmp_path / "out" / "p.html", typed(), None, study="S", date="d")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-14.1728, "-14.17"),
        (0.000123456, "0.0001235"),
        (6287.1, "6287"),
        (12345.6, "12350"),
        (1.23456e9, "1.235e+09"),
        (math.nan, "–"),
    ],
)
def test_numbers_read_well(value: float, text: str) -> None:
    assert significant(value) == text
