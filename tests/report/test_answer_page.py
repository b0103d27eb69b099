"""The first page of a study: status first, characteristics, links to what is there."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from doe_kc.correlation.assessment import Assessment
from doe_kc.report.page.answer import write_answer_page
from tests.report.chromium import BROWSER, Page
from tests.report.correlations import EVIL, real

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(BROWSER is None, reason="Chromium is not installed, so no page can be opened"),
]


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    folder = tmp_path_factory.mktemp("answer")
    (folder / "correlate").mkdir()
    (folder / "correlate" / "report.html").write_text("there")
    path = write_answer_page(
        folder / "index.html",
        real(),
        Assessment("doubtful", (f"Something is open {EVIL}.",)),
        study=f"Study {EVIL}",
        date="2026-01-31",
        lines=["Added: hub compliance"],
        notes={"Axle": "axle.toml"},
        folder=folder,
    )
    browser = Page(Path(tmp_path_factory.mktemp("profile")))
    browser.open(path)
    yield browser
    browser.close()


def test_it_opens_without_errors_and_asks_for_nothing_else(page: Page) -> None:
    assert not page.errors and len(page.requests) == 1


def test_the_status_is_the_first_thing_said(page: Page) -> None:
    first = page.run("document.querySelector('#answer .tile b').textContent")
    assert first == "Doubtful"
    assert EVIL in page.run("document.querySelector('#answer ul').textContent")


def test_only_files_that_are_there_are_linked(page: Page) -> None:
    links = page.run("Array.from(document.querySelectorAll('#everything-else a')).map(a => a.textContent)")
    assert list(links) == ["correlate/report.html"]


def test_every_characteristic_is_listed(page: Page) -> None:
    rows = page.run("document.querySelectorAll('#characteristics-table tbody tr').length")
    assert rows == len(real().improvements)
