"""The report page in a real browser, offline."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from markupsafe import Markup

from doe_kc.reports.page.correlation import correlation_sections, write_correlation_page
from doe_kc.reports.render.page import Section, write_page
from tests.correlation.cases import measured
from tests.reports.chromium import BROWSER, Page
from tests.reports.correlations import CAR, EVIL, all_three, odd, real

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(BROWSER is None, reason="Chromium is not installed, so no page can be opened"),
]

TITLES = ["Summary", "Characteristics", "Curves", "Convergence", "Parameters", "Axle"]
LEGIBLE = 9.0
LAYERS = "document.querySelectorAll('#curves-chart path.layer')"


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("pages")
    out = {
        name: write_correlation_page(
            folder / f"{name}.html", found, measured(CAR) if name != "typed" else None, study=f"Study {EVIL}",
            date="2026-01-31", notes={"Axle": EVIL},
        )
        for name, found in all_three().items()
    }  # fmt: skip
    more = Section("Missing effects", Markup("<p id='more'>{}</p>").format(EVIL))
    sections = [*correlation_sections(all_three()["odd"], measured(CAR), notes={"Axle": EVIL}), more]
    return out | {
        "odd": write_page(folder / "odd.html", f"Correlation: Study {EVIL}", sections, subtitle="d")
    }


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    page = Page(tmp_path_factory.mktemp("profile"))
    yield page
    page.close()


def opened(browser: Page, pages: dict[str, Path], name: str, width: int = 1300) -> Page:
    browser.size(width, 900)
    browser.events.clear()
    browser.open(pages[name])
    return browser


def column(page: Page, table: str, index: int) -> list[str]:
    rows = f"Array.from(document.querySelectorAll('#{table} tbody tr')).filter(r => !r.hidden)"
    return list(page.run(f"{rows}.map(r => r.cells[{index}].textContent.trim().replace('\u2212', '-'))"))


def set_input(page: Page, selector: str, value: str) -> None:
    page.run(
        f"(() => {{ const i = document.querySelector({selector!r}); "
        f"if (i.type === 'checkbox') i.checked = {value}; else i.value = {value}; "
        "i.dispatchEvent(new Event('input', {bubbles: true})); })()"
    )


@pytest.mark.parametrize("name", ["real", "odd", "typed"])
@pytest.mark.parametrize("width", [1300, 390])
def test_opens_without_errors_or_network(
    browser: Page, pages: dict[str, Path], name: str, width: int
) -> None:
    page = opened(browser, pages, name, width)
    titles = page.run("Array.from(document.querySelectorAll('h2')).map(h => h.textContent)")
    wanted = [t for t in TITLES if name != "typed" or t != "Curves"]
    assert titles == [*wanted, "Missing effects" if name == "odd" else "Words"]
    assert page.errors == []
    assert set(page.requests) == {pages[name].as_uri()}
    assert page.run("performance.getEntriesByType('resource').length") == 0
    assert page.run("document.documentElement.scrollWidth") <= width


def test_user_text_stays_text(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "odd")
    assert page.run("document.querySelector('h1').textContent") == f"Correlation: Study {EVIL}"
    assert page.run("document.getElementById('more').textContent") == EVIL
    assert EVIL in page.run("document.querySelector('dl').textContent")
    assert page.run("document.scripts.length") == 3
    page.run("document.querySelector('#convergence-chart svg').focus()")
    for _ in range(3):
        page.key("ArrowRight")
    assert EVIL in page.run("document.getElementById('convergence-readout').textContent")


def test_tables_are_filled(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "real")
    assert len(column(page, "characteristics-table", 0)) == len(real().improvements) == 28
    assert column(page, "parameters-table", 0) == list(real().values)
    assert page.run("document.querySelectorAll('#characteristics-table tbody td svg').length") == 28


@pytest.mark.parametrize("head", ["Final", "Improvement, %", "Characteristic"])
def test_a_click_on_a_head_sorts_both_ways(browser: Page, pages: dict[str, Path], head: str) -> None:
    page = opened(browser, pages, "real")
    heads = "Array.from(document.querySelectorAll('#characteristics-table th'))"
    names = page.run(heads + ".map(h => h.textContent.replace(/\\u00ad/g, '').trim())")
    at = names.index(head)
    before = column(page, "characteristics-table", at)
    found = []
    for _ in range(2):
        page.run(f"{heads}[{at}].querySelector('button').click()")
        found.append(column(page, "characteristics-table", at))
    numeric = head != "Characteristic"
    values = [[float(v) if numeric else v.lower() for v in x] for x in found]
    assert values[0] == sorted(values[0]) and values[1] == sorted(values[0], reverse=True)
    assert sorted(before) == sorted(found[0])
    assert page.run(f"{heads}[{at}].getAttribute('aria-sort')") == "descending"


def test_sorting_leaves_unknown_values_last(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "odd")
    heads = "Array.from(document.querySelectorAll('#parameters-table th button'))"
    click = f"{heads}.find(b => b.textContent == 'Lower').click()"
    for _ in range(2):
        page.run(click)
        assert set(column(page, "parameters-table", 0)[-3:]) == {"UPB.y", "sfr.Fy", "ride_height"}


def test_filters_by_text_and_by_mark(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "odd")
    set_input(page, "[data-table=parameters-table] input[type=search]", "'bush stiff'")
    bushes = column(page, "parameters-table", 0)
    assert bushes == ["llf.Fx", "llf.Fy", "llf.Fz", "llr.Fx", "llr.Fy", "llr.Fz", "sff.Fy", "sfr.Fy"]
    set_input(page, "[data-table=parameters-table] [data-only=bound]", "true")
    assert column(page, "parameters-table", 0) == ["llf.Fy", "llr.Fy"]
    count = page.run("document.querySelector('[data-table=parameters-table] .count').textContent")
    assert count == f"2 of {len(odd().values)} rows"


def test_curves_are_drawn_for_every_choice(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "real")
    cases = page.run("Array.from(document.getElementById('curves-case').options).map(o => o.value)")
    answers = page.run("Array.from(document.getElementById('curves-response').options).map(o => o.value)")
    assert (len(cases), len(answers)) == (8, 7)
    for case in cases:
        set_input(page, "#curves-case", repr(case))
        for answer in answers:
            set_input(page, "#curves-response", repr(answer))
            paths = page.run(f"Array.from({LAYERS}, p => p.getAttribute('d'))")
            assert len(paths) == 4
            assert all(p.startswith("M") and "NaN" not in p and p.count("L") > 20 for p in paths)
    assert page.errors == []


def test_the_keyboard_reads_values_off_and_zooms(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "real")
    set_input(page, "#curves-case", "'lateral'")
    page.run("document.querySelector('#curves-chart svg').focus()")
    for _ in range(2):
        page.key("ArrowRight")
    lines = "document.querySelectorAll('#curves-readout tbody tr')"
    cells = page.run(
        f"Array.from({lines}, r => Array.from(r.cells, c => c.textContent.replace('\u2212', '-')))"
    )
    model, rig = real().best.outcome.curves, measured(CAR).curves.cases["lateral"]
    assert model is not None
    assert page.run(
        "document.querySelector('#curves-readout th').textContent"
    ) == f"{rig.input[1]:g} N".replace("-", "\u2212")
    for side in (0, 1):
        assert float(cells[side][1]) == pytest.approx(rig.mean["toe"][side][1], rel=1e-4)
        assert float(cells[side][3]) == pytest.approx(model.cases["lateral"].mean["toe"][side][1], rel=1e-4)
    wide = page.run("document.querySelector('#curves-chart path.layer').getAttribute('d')")
    page.key("+")
    assert page.run("document.querySelector('#curves-chart path.layer').getAttribute('d')") != wide
    page.key("0")
    assert page.run("document.querySelector('#curves-chart path.layer').getAttribute('d')") == wide


def test_dragging_zooms_and_double_click_shows_all(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "real")
    page.run("document.getElementById('curves').scrollIntoView()")
    rectangle = "document.getElementById('curves-chart').getBoundingClientRect()"
    box = page.run(f"(b => [b.x, b.y, b.width, b.height])({rectangle})")
    d = "document.querySelector('#curves-chart path.layer').getAttribute('d')"
    wide = page.run(d)
    x, y = box[0] + 0.4 * box[2], box[1] + 0.4 * box[3]
    page.mouse("mousePressed", x, y)
    page.mouse("mouseMoved", x + 100, y + 60)
    page.mouse("mouseReleased", x + 200, y + 120)
    assert page.run(d) != wide
    page.run("document.querySelector('#curves-chart svg').dispatchEvent(new Event('dblclick'))")
    assert page.run(d) == wide


def test_layers_can_be_switched_off(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "real")
    for name in ("baseline", "right", "measured"):
        set_input(page, f"[data-show={name}]", "false")
    shown = page.run("document.querySelectorAll('#curves-chart path.layer, #curves-chart circle').length")
    assert shown == 1


@pytest.mark.parametrize("name", ["real", "odd"])
def test_nothing_is_cut_off_on_a_desk(browser: Page, pages: dict[str, Path], name: str) -> None:
    page = opened(browser, pages, name, 1400)
    wide = "Array.from(document.querySelectorAll('.scroll')).filter(e => e.scrollWidth > e.clientWidth + 1)"
    assert page.run(f"{wide}.map(e => e.getAttribute('aria-label'))") == []


def test_codes_say_what_they_are(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "real")
    title = page.run("document.querySelector('#parameters-table abbr').title")
    assert title == "Lower link front, x, mm"


def test_small_text_is_legible_and_charts_have_names(browser: Page, pages: dict[str, Path]) -> None:
    page = opened(browser, pages, "odd", width=390)
    small = "document.querySelectorAll('td, th, svg text, label')"
    sizes = page.run(f"Array.from({small}, e => parseFloat(getComputedStyle(e).fontSize))")
    assert min(sizes) >= LEGIBLE
    assert page.run("document.querySelectorAll('svg[role=img]:not([aria-label])').length") == 0
