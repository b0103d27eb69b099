"""The first page of a study: status first, what was lacking, agreement, numbers, links; one sheet printed."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from doe_kc.correlation.answer_record import AnswerRecord, CaseGap, EffectWords, GapRecord
from doe_kc.correlation.assessment import Assessment
from doe_kc.reports.answer.overview import CHANGES_SHOWN, Overview, agreement_words, sure_changes
from doe_kc.reports.answer.overview_sheet import overview_sheet, write_overview
from doe_kc.reports.correlation.parameters import parameter_rows
from doe_kc.reports.page.answer import files_there, write_answer_page
from tests.reports.chromium import BROWSER, Page
from tests.reports.correlations import EVIL, all_three, real

browsed = pytest.mark.skipif(BROWSER is None, reason="Chromium is not installed, so no page can be opened")
LONG = (
    "A sentence of some length on what was found to be open in the records of this car and why that is so. "
)
CASES = (
    "vertical",
    "roll",
    "lateral",
    "lateral_opposite",
    "lateral_offset",
    "drive",
    "brake",
    "steer",
    "static",
)


def words(count: int) -> list[EffectWords]:
    one = EffectWords(
        label="Hub and wheel-bearing compliance",
        kind="found",
        sizes=["stiffness in camber 3165.3 ± 21.5 Nm/deg", "stiffness in toe 5550 ± 1120 Nm/deg"],
        sure="sure (98 %)",
        physics="Wheel bearing and knuckle yield, so that the wheel tilts against the strut under load.",
        rivals="",
        confirm="camber at the hub against a target on the knuckle under lateral force",
        adopted=True,
    )
    return [one.model_copy(update={"adopted": k % 2 == 0}) for k in range(count)]


def overview(effects: int = 1, reasons: int = 1) -> Overview:
    gap = GapRecord(
        nominal=5.2, tuned=4.2, final=1.05, noise_floor=1.0,
        cases={name: CaseGap(nominal=k + 0.9, final=1.0) for k, name in enumerate(CASES)},
    )  # fmt: skip
    record = AnswerRecord(
        verdict="named", effects=[], added=[], gap=gap, seconds=61.0,
        sentence="The model lacks hub compliance.", words=words(effects),
    )  # fmt: skip
    assessment = Assessment("doubtful", tuple(f"{LONG}{EVIL}." for _ in range(reasons)))
    return Overview(f"Study {EVIL}", "2026-01-31", real(), assessment, record)


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("answer")
    (folder / "correlate").mkdir()
    (folder / "correlate" / "report.html").write_text("there")
    return write_answer_page(
        folder / "index.html", overview(6, 5), notes={"Axle": "axle.toml"}, files=files_there(folder)
    )


@pytest.fixture(scope="module")
def page(path: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    browser = Page(Path(tmp_path_factory.mktemp("profile")), width=1400)
    browser.open(path)
    yield browser
    browser.close()


@pytest.mark.browser
@browsed
def test_it_opens_without_errors_and_asks_for_nothing_else(page: Page) -> None:
    assert not page.errors and len(page.requests) == 1


@pytest.mark.browser
@browsed
def test_the_status_is_the_first_thing_said(page: Page) -> None:
    assert page.run("document.querySelector('#answer .status').textContent") == "Doubtful"
    assert EVIL.partition("=")[0] in page.run("document.querySelector('#answer ul').textContent")


@pytest.mark.browser
@browsed
def test_only_files_that_are_there_are_linked(page: Page) -> None:
    links = page.run("Array.from(document.querySelectorAll('#files-table a')).map(a => a.textContent)")
    assert list(links) == ["correlate/report.html"]


@pytest.mark.browser
@browsed
@pytest.mark.parametrize("width", [1400, 1200])
def test_no_table_is_cut_off(page: Page, width: int) -> None:
    page.size(width, 900)
    wide = "Array.from(document.querySelectorAll('.scroll')).filter(e => e.scrollWidth > e.clientWidth + 1)"
    assert page.run(f"{wide}.map(e => e.getAttribute('aria-label'))") == []


@pytest.mark.browser
@browsed
def test_it_prints_on_one_upright_sheet_even_with_six_effects(page: Page) -> None:
    print_out = page.send("Page.printToPDF", preferCSSPageSize=True, printBackground=True)["data"]
    pdf = base64.b64decode(print_out)
    assert re.findall(rb"/Count (\d+)", pdf) == [b"1"]
    (box,) = set(re.findall(rb"/MediaBox \[([^\]]*)\]", pdf))
    width, height = [float(v) for v in box.split()][2:]
    assert (round(width), round(height)) == (595, 842)


@pytest.mark.parametrize(("effects", "reasons"), [(0, 1), (1, 1), (6, 9)])
def test_the_sheet_without_a_browser_holds_all_texts(effects: int, reasons: int) -> None:
    page = overview_sheet(overview(effects, reasons), {"axle.toml": "the axle to use"})
    assert page.outside == []
    said = [w.text for w in page.words]
    assert "Doubtful" in said and "Lateral force" in said
    places = [w.y for w in page.words if w.text.startswith("doe_kc")]
    assert places == [min(w.y for w in page.words)], "nothing reaches into the foot"


@pytest.mark.parametrize("name", ["real", "odd", "typed"])
def test_every_correlation_has_a_sheet(name: str) -> None:
    one = replace(overview(), correlation=all_three()[name])
    assert overview_sheet(one, {}).outside == []


def test_the_print_is_one_page_and_the_same_every_time(tmp_path: Path) -> None:
    first, second = (write_overview(tmp_path / n, overview(), {}).read_bytes() for n in ("a.pdf", "b.pdf"))
    assert first == second
    assert len(re.findall(rb"/Type /Page\b", first)) == 1


def test_numbers_to_act_on_are_surely_changed() -> None:
    rows = sure_changes(parameter_rows(real()))
    assert rows and all(abs(r.change) >= 2.0 * (r.inward if r.at_bound else r.sd) for r in rows)
    assert not [r for r in rows if r.visible is False]
    shares = [abs(r.place - r.start) for r in rows]
    assert shares == sorted(shares, reverse=True)
    assert f"{CHANGES_SHOWN} of {len(rows)}" in overview().changes_lead or len(rows) <= CHANGES_SHOWN


def test_a_parameter_at_a_bound_that_may_not_have_moved_is_no_sure_change() -> None:
    (row, *_) = sure_changes(parameter_rows(real()))
    held = replace(row, at_bound="lower", sd=float("nan"), inward=abs(row.change))
    assert sure_changes([held]) == []
    assert sure_changes([replace(held, inward=0.4 * abs(row.change))]) != []


@pytest.mark.parametrize(
    ("times", "said"),
    [(1.24, "within the noise"), (1.26, "slightly off"), (2.3, "off"), (8.0, "far off"), (float("nan"), "–")],
)
def test_agreement_is_said_as_it_is_written(times: float, said: str) -> None:
    assert agreement_words(times).endswith(said)
