"""Every page of a study links each other that is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from doe_kc.ground.errors import RunError
from doe_kc.reports.page.links import STUDY_PAGES, link_pages
from doe_kc.reports.render.page import write_page


def links(path: Path) -> dict[str, str]:
    (nav,) = re.findall(r'<nav class="pages".*?</nav>', path.read_text("utf-8"), re.DOTALL)
    return {words: way for way, words in re.findall(r'<a href="([^"]*)"[^>]*>([^<]*)</a>', nav)}


def test_pages_find_each_other_from_any_folder(tmp_path: Path) -> None:
    for name in ("discover/report.html", "index.html"):
        write_page(tmp_path / name, "T <!--pages--> <!--/pages-->", [])
    link_pages(tmp_path)
    write_page(tmp_path / "correlate/report.html", "T", [])
    link_pages(tmp_path)
    for name in ("index.html", "discover/report.html", "correlate/report.html"):
        page = tmp_path / name
        found = links(page)
        assert list(found) == ["Answer", "What the model lacks", "Correlation"]
        assert all((page.parent / way).resolve().is_file() for way in found.values())
        assert f'aria-current="page">{STUDY_PAGES[name]}<' in page.read_text("utf-8")


def test_linking_again_changes_nothing(tmp_path: Path) -> None:
    page = write_page(tmp_path / "index.html", "T", [])
    link_pages(tmp_path)
    first = page.read_bytes()
    link_pages(tmp_path)
    assert page.read_bytes() == first


def test_a_file_that_is_no_page_of_ours_is_left(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("mine", encoding="utf-8")
    link_pages(tmp_path)
    assert (tmp_path / "index.html").read_text("utf-8") == "mine"


def test_what_is_no_text_is_said_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(RunError, match="cannot be read"):
        link_pages(tmp_path)
