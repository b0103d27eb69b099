"""Pages of records, comparison, influence and the axle handed in, in a real browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from doe_kc.characteristics import reduce_all
from doe_kc.reports.page.comparison import write_comparison_page
from doe_kc.reports.page.measurement import write_measurement_page
from doe_kc.reports.page.simulation import write_simulation_page
from doe_kc.targets.comparison import compare
from tests.correlation.cases import measured
from tests.reports.chromium import BROWSER, Page
from tests.reports.correlations import CAR, real

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(BROWSER is None, reason="Chromium is not installed, so no page can be opened"),
]


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder, curves, rig = tmp_path_factory.mktemp("steps"), real().best.outcome.curves, measured(CAR)
    assert curves is not None
    return {
        "simulate": write_simulation_page(
            folder / "s.html", curves, reduce_all(curves), study="S", date="2026-01-31"
        ),
        "reduce": write_measurement_page(folder / "r.html", rig),
        "compare": write_comparison_page(folder / "c.html", compare(curves, rig.curves)),
    }


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    page = Page(tmp_path_factory.mktemp("profile"), width=1400)
    yield page
    page.close()


@pytest.mark.parametrize(("name", "layers"), [("simulate", 2), ("reduce", 0), ("compare", 2)])
def test_tables_and_curves_are_there(browser: Page, pages: dict[str, Path], name: str, layers: int) -> None:
    browser.events.clear()
    browser.open(pages[name])
    assert browser.errors == [] and browser.run("document.documentElement.scrollWidth") <= 1400
    assert browser.run("document.querySelectorAll('table.data')[0].tBodies[0].rows.length") > 20
    assert browser.run("document.querySelectorAll('#curves-chart path.layer').length") == layers
    assert (browser.run("document.querySelectorAll('#curves-chart circle').length") > 0) is (
        name != "simulate"
    )
    at_rest = browser.run("document.querySelectorAll('#curves-readout td').length")
    assert (at_rest > 0) is (name == "compare"), "a readout without a model or a record says nothing"
    browser.run("document.querySelector('#curves-chart svg').focus()")
    browser.key("ArrowRight")
    heads = browser.run("Array.from(document.querySelectorAll('#curves-readout th'), h => h.textContent)")
    assert not [h for h in heads if "undefined" in h]
    browser.run("dispatchEvent(new Event('beforeprint'))")
    assert browser.run("document.querySelectorAll('#curves-printed svg').length") == 8 * 7
