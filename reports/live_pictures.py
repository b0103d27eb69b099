"""Takes the pictures of docs/live.md from the page itself, in headless Chromium.

python reports/live_pictures.py
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from tests.live.outside import outside_study  # noqa: E402
from tests.live.served import serving  # noqa: E402
from tests.reports.chromium import Page  # noqa: E402

DOCS = ROOT / "docs"
SIZE = (1280, 820)
AT_REST = "live.painted >= live.sent && live.influence"
SEARCH = "document.getElementById('search')"
WALK = {
    "live_open": [],
    "live_drag": [
        "send({kind: 'snapshot', name: 'as delivered'})",
        f"{SEARCH}.value = 'rib.z'; {SEARCH}.dispatchEvent(new Event('input'))",
        "(() => { const f = live.rows.get('RIB.z').number; f.value = Number(f.value) + 2.5; "
        "f.dispatchEvent(new Event('change')); })()",
        "live.charts[0].choice.value = 'vertical.toe'; "
        "live.charts[0].choice.dispatchEvent(new Event('change')); live.axle.view('rear')",
    ],
    "live_advice": [
        f"ask({{kind: 'undo'}}); {SEARCH}.value = ''; {SEARCH}.dispatchEvent(new Event('input'))",
        "document.getElementById('best_step').click()",
    ],
}
"""Picture -> what is done before it, one after the other."""
DRAGGED = (
    "(() => { const r = live.rows.get('RIB.z'); r.range.value = r.slider.start + 1.2; "
    "r.range.dispatchEvent(new Event('input')); })()"
)
"""A slider that a hand still holds."""
OTHERS = {"live_double_wishbone": "double_wishbone_front", "live_five_link": "five_link_rear"}


def take(page: Page, name: str) -> None:
    """Picture of the window once everything is painted."""
    page.wait(AT_REST)
    time.sleep(1.5)
    print(page.picture(DOCS / f"{name}.png"))


def main() -> None:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        page = Page(folder / "profile", width=SIZE[0])
        page.size(*SIZE)
        with serving(folder, "--port", "18650", study=ROOT / "examples" / "front_axle") as served:
            page.send("Page.navigate", url=served.address)
            page.wait("document.body && document.body.dataset.seq && live.influence")
            for name, steps in WALK.items():
                for step in steps:
                    page.run(step)
                    time.sleep(1.0)
                    page.wait(AT_REST)
                if name == "live_advice":
                    page.wait("document.body.dataset.advice === 'best_step'")
                take(page, name)
        for name, example in OTHERS.items():
            with serving(folder, "--port", "18670", study=ROOT / "examples" / example) as served:
                page.send("Page.navigate", url=served.address)
                page.wait("document.body && document.body.dataset.seq && live.influence")
                take(page, name)
        outside = outside_study(folder / "outside", designs=14)
        with serving(outside.out, "--port", "18690", study=outside.folder) as served:
            page.send("Page.navigate", url=served.address)
            page.wait("document.body && document.body.dataset.seq && live.influence")
            page.run(DRAGGED)
            page.wait("live.painted >= live.sent && document.body.classList.contains('approximate')")
            take(page, "live_outside")
        page.close()


if __name__ == "__main__":
    main()
