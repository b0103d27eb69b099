"""The report page of a discovery in a real browser, offline."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from doe_kc.discovery.verdict.other_sizes import OTHER_SIZE
from doe_kc.reports.discovery.effect_words import effect_words
from doe_kc.reports.page.correlation import correlation_sections
from doe_kc.reports.page.discovery import discovery_sections, write_discovery_page
from doe_kc.reports.render.page import page_html, write_page
from tests.correlation.cases import measured
from tests.discovery.cases import LOAD_CASES, discovery, records
from tests.reports.chromium import BROWSER, Page
from tests.reports.correlations import CAR, EVIL, real

CARS = ["none", "named", "class", "unexplained", "lead", "two"]
ALWAYS = [
    "Verdict", "What to test next", "Where they disagree", "Curves with and without the effect",
    "Deviation of every curve", "Parameters with and without the effect", "Library of effects", "Candidates",
    "Words",
]  # fmt: skip
OPTIONAL = {"Load cases held out", "Without the library"}
STATISTICS = ("odds", "evidence", "whitened", "adequacy", "decoy", "RMS", "prior")
LEGIBLE = 9.0
without_browser = pytest.mark.skipif(
    BROWSER is None, reason="Chromium is not installed, so no page can be opened"
)


def browsed(test: Callable[..., None]) -> Callable[..., None]:
    """Mark of a test that opens a page."""
    return pytest.mark.browser(without_browser(test))


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("pages")
    return {
        car: write_discovery_page(
            folder / f"{car}.html", discovery(car), records(car), study=f"Study {EVIL}", date="2026-01-31",
            notes={"Axle": EVIL},
        )
        for car in CARS
    }  # fmt: skip


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    page = Page(tmp_path_factory.mktemp("profile"))
    yield page
    page.close()


def opened(browser: Page, path: Path, width: int = 1300) -> Page:
    browser.size(width, 900)
    browser.events.clear()
    browser.open(path)
    return browser


def column(page: Page, table: str, index: int) -> list[str]:
    rows = f"Array.from(document.querySelectorAll('#{table} tbody tr')).filter(r => !r.hidden)"
    return list(page.run(f"{rows}.map(r => r.cells[{index}].textContent.trim())"))


def set_input(page: Page, selector: str, value: str) -> None:
    page.run(
        f"(() => {{ const i = document.querySelector({selector!r}); "
        f"if (i.type === 'checkbox') i.checked = {value}; else i.value = {value}; "
        "i.dispatchEvent(new Event('input', {bubbles: true})); })()"
    )


@pytest.mark.parametrize("car", CARS)
def test_sections_follow_an_engineers_questions(car: str) -> None:
    found = discovery(car)
    titles = [s.title for s in discovery_sections(found, records(car))]
    assert [t for t in titles if t not in OPTIONAL] == ALWAYS
    assert ("Load cases held out" in titles) is bool(found.held_out)
    assert ("Without the library" in titles) is (found.scan is not None)
    assert len({s.ident for s in discovery_sections(found, None)}) == len(titles)


def test_the_verdict_is_said_first(pages: dict[str, Path]) -> None:
    for car, path in pages.items():
        html = path.read_text(encoding="utf-8")
        assert discovery(car).sentences[0] in html
        assert "<script>alert" not in html
        assert path.stat().st_size < 1_000_000


@browsed
@pytest.mark.parametrize("car", CARS)
@pytest.mark.parametrize("width", [1300, 390])
def test_opens_without_errors_or_network(browser: Page, pages: dict[str, Path], car: str, width: int) -> None:
    page = opened(browser, pages[car], width)
    assert page.errors == []
    assert set(page.requests) == {pages[car].as_uri()}
    assert page.run("document.documentElement.scrollWidth") <= width
    small = "document.querySelectorAll('td, th, td span, svg text, label')"
    sizes = page.run(f"Array.from({small}, e => parseFloat(getComputedStyle(e).fontSize))")
    assert min(sizes) >= LEGIBLE
    assert page.run("document.querySelectorAll('svg[role=img]:not([aria-label])').length") == 0


@pytest.mark.parametrize("car", CARS)
def test_the_first_screen_has_no_words_of_statistics(car: str) -> None:
    section = discovery_sections(discovery(car), records(car))[0]
    open_text = re.sub(r"<details>.*?</details>|<[^>]*>", " ", str(section.html), flags=re.DOTALL)
    assert not [w for w in STATISTICS if w.lower() in open_text.lower()]
    for finding in discovery(car).findings:
        words = effect_words(discovery(car), finding)
        assert all(part in open_text for part in (words.label, words.sure, words.confirm))


@browsed
def test_every_curve_is_printed_with_title_and_legend(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages["two"])
    page.run("dispatchEvent(new Event('beforeprint'))")
    blocks = "document.querySelectorAll('#effect-curves-printed .printed-case')"
    assert page.run(f"{blocks}.length") == len(LOAD_CASES)
    legends = page.run(f"Array.from({blocks}, b => b.querySelector('.controls').textContent)")
    assert all("measured" in text and "with the effect" in text for text in legends)
    charts = "document.querySelectorAll('#effect-curves-printed svg')"
    assert page.run(f"{charts}.length") == 14 * len(LOAD_CASES)
    titles = page.run(f"Array.from({charts}, c => c.querySelectorAll('text.title').length)")
    assert set(titles) == {2}
    assert page.run(f"Array.from({charts}).every(c => c.querySelector('path.layer'))")
    assert page.run("new Set(Array.from(document.querySelectorAll('[id]'), e => e.id)).size") == page.run(
        "document.querySelectorAll('[id]').length"
    )
    page.run("dispatchEvent(new Event('afterprint'))")
    assert page.run(f"{charts}.length") == 0 and page.errors == []


@browsed
@pytest.mark.parametrize("car", ["two", "unexplained"])
def test_nothing_is_cut_off_on_a_desk(browser: Page, pages: dict[str, Path], car: str) -> None:
    page = opened(browser, pages[car], 1400)
    page.run("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    wide = "Array.from(document.querySelectorAll('.scroll')).filter(e => e.scrollWidth > e.clientWidth + 1)"
    assert page.run(f"{wide}.map(e => e.getAttribute('aria-label'))") == []


@browsed
def test_maps_and_tables_are_filled(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages["named"])
    found = discovery("named")
    assert page.run("document.querySelectorAll('table.heat').length") == 3
    assert page.run("document.querySelectorAll('table.heat')[0].tBodies[0].rows.length") == 5
    assert len(column(page, "library-table", 0)) == len(found.statuses)
    assert len(column(page, "held-out-table", 0)) == len(LOAD_CASES)
    assert column(page, "effects-table", 0) == ["Hub and wheel-bearing compliance"]
    set_input(page, "[data-table=library-table] [data-only=excluded]", "true")
    assert set(column(page, "library-table", 1)) == {"would have shown"}


@browsed
def test_curves_start_with_the_worst_and_are_drawn_for_every_choice(
    browser: Page, pages: dict[str, Path]
) -> None:
    page = opened(browser, pages["two"])
    first = page.run("document.getElementById('effect-curves-response').value")
    assert first == "tyre_load:loop"
    cases = page.run("Array.from(document.getElementById('effect-curves-case').options).map(o => o.value)")
    answers = page.run(
        "Array.from(document.getElementById('effect-curves-response').options).map(o => o.value)"
    )
    assert (sorted(cases), len(answers)) == (sorted(LOAD_CASES), 14)
    layers = "document.querySelectorAll('#effect-curves-chart path.layer')"
    for case in cases:
        set_input(page, "#effect-curves-case", repr(case))
        for answer in answers:
            set_input(page, "#effect-curves-response", repr(answer))
            paths = page.run(f"Array.from({layers}, p => p.getAttribute('d'))")
            assert len(paths) == 4
            assert all(p.startswith("M") and "NaN" not in p and p.count("L") > 10 for p in paths)
    page.run("document.querySelector('#effect-curves-chart svg').focus()")
    page.key("ArrowRight")
    heads = page.run("document.querySelectorAll('#effect-curves-readout th').length")
    assert heads == 1 + 1 + 4 + 1 + 4
    assert page.errors == []


@browsed
def test_both_charts_work_on_one_page(browser: Page, tmp_path: Path) -> None:
    sections = correlation_sections(real(), measured(CAR))
    sections += discovery_sections(discovery("named"), records("named"))
    page = opened(browser, write_page(tmp_path / "both.html", "Both", sections))
    assert page.errors == []
    for prefix in ("curves", "effect-curves"):
        assert page.run(f"document.querySelectorAll('#{prefix}-chart path.layer').length") == 4
    assert page.run("new Set(Array.from(document.querySelectorAll('[id]'), e => e.id)).size") == page.run(
        "document.querySelectorAll('[id]').length"
    )


def test_a_page_of_sections_alone_is_whole() -> None:
    html = page_html("T", discovery_sections(discovery("none"), None))
    assert "No effect is missing" in html


def test_an_unexplained_set_does_not_leave_nothing(tmp_path: Path) -> None:
    """Where no contrast stands out, what keeps it from a name is said."""
    one = discovery("unexplained")
    against = "Against a name: load cases held out are not predicted better."
    quiet = replace(one, unexplained=(), classes=(), beyond=(), sentences=(*one.sentences, against))
    html = write_discovery_page(
        tmp_path / "r.html", quiet, records("unexplained"), study="S", date="D", notes={}
    ).read_text()
    assert "which is noise." not in html and f"<li>{against}</li>" in html


@pytest.mark.parametrize("verdict", ["named", "unexplained"])
def test_another_size_that_fits_as_well_remains(tmp_path: Path, verdict: str) -> None:
    """Beside what else remains, or that nothing does."""
    one = discovery(verdict)
    other = f"{OTHER_SIZE}steering friction would be 240 N with rack-mount compliance of 3070 N/mm."
    told = replace(one, sentences=(*one.sentences, other))
    html = write_discovery_page(
        tmp_path / "r.html", told, records(verdict), study="S", date="D", notes={}
    ).read_text()
    assert "<li>Steering friction would be 240 N with rack-mount compliance of 3070 N/mm.</li>" in html
    assert ("which is noise." in html) is (verdict == "named")
