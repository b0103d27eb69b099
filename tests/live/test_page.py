"""The live page in a real browser: every control, by mouse and keyboard, against the solver's own numbers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.live.first_order import first_order
from doe_kc.live.session import Session
from doe_kc.live.static_page import static_page
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests.live.cases import model
from tests.live.served import Served, serving
from tests.reports.chromium import BROWSER, Page

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(BROWSER is None, reason="Chromium is not installed, so no page can be opened"),
]


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with serving(tmp_path_factory.mktemp("live"), "--port", "18450") as process:
        yield process


@pytest.fixture(scope="module")
def page(served: Served, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    page = Page(tmp_path_factory.mktemp("profile"), width=1280)
    page.size(1280, 860)
    page.send("Page.navigate", url=served.address)
    page.wait("document.body && document.body.dataset.seq && live.influence")
    yield page
    page.close()


def slider(path: str) -> str:
    return f"live.rows.get('{path}')"


def enter(page: Page, path: str, value: float) -> None:
    """Type a value into a slider's field and wait until its answer is painted."""
    field = f"{slider(path)}.number"
    page.run(f"{field}.value = '{value!r}'; {field}.dispatchEvent(new Event('change'))")
    page.wait("live.painted >= live.sent")


def choose(page: Page, node: str, value: str) -> None:
    """Choose or type a value in a node given by its expression."""
    page.run(f"{node}.value = {value!r}; {node}.dispatchEvent(new Event('change'))")


def click(page: Page, ident: str) -> None:
    page.run(f"document.getElementById('{ident}').click()")


def gap(page: Page) -> float:
    return float(page.run("live.answers.totals(live.present.exact).gap"))


def reset(page: Page) -> None:
    click(page, "reset-all")
    page.wait(
        "live.painted >= live.sent && Math.abs(live.present.exact[0] - live.model.sliders[0].start) < 1e-9"
    )


def test_it_opens_without_errors_and_asks_this_computer_alone(page: Page, served: Served) -> None:
    assert page.errors == []
    assert all(url.startswith(f"http://127.0.0.1:{served.port}/") for url in page.requests)
    assert page.run("location.href") == f"http://127.0.0.1:{served.port}/"
    assert page.run("document.querySelectorAll('.chart canvas').length") == 8
    assert page.run("document.querySelectorAll('#sliders .slider').length") == 10
    assert page.run("document.querySelectorAll('#characteristics tr[data-id]').length") >= 28


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (1920, 1080)])
def test_everything_fits_across(page: Page, width: int, height: int) -> None:
    page.size(width, height)
    page.wait(f"innerWidth === {width}")
    assert page.run("document.documentElement.scrollWidth") <= width
    boxes = "['left', 'middle', 'right'].map((i) => document.getElementById(i))"
    assert page.run(f"{boxes}.every((b) => b.scrollWidth <= b.clientWidth + 1)")
    page.size(1280, 860)


def test_what_is_drawn_is_the_solvers_curve(page: Page) -> None:
    value = page.run(f"{slider('LLF.z')}.slider.start") + 2.0
    enter(page, "LLF.z", value)
    curves = curve_set(solve(with_values(model().axle, {"LLF.z": value})))
    for case in ("vertical", "brake"):
        for response in ("toe", "camber"):
            script = f"Array.from(live.layout.curve(live.present.drawn, '{case}', '{response}', 1))"
            wanted = curves.cases[case].mean[response][1]
            np.testing.assert_allclose(page.run(script), wanted, rtol=1e-5, atol=1e-6)
    choose(page, "live.charts[0].choice", "vertical.toe")
    page.wait("live.charts[0].place.response === 'toe'")
    drawn = page.run("Array.from(live.charts[0].presentRow(0))")
    np.testing.assert_allclose(drawn, curves.cases["vertical"].mean["toe"][0], rtol=1e-5, atol=1e-6)
    assert page.run(f"{slider('LLF.z')}.node.classList.contains('moved')")
    reset(page)


def test_a_slider_is_moved_by_keyboard_and_undone(page: Page) -> None:
    page.run("document.querySelector('#sliders input[type=range]').focus()")
    path = page.run("document.activeElement.closest('.slider').dataset.path")
    before = page.run(f"Number({slider(path)}.range.value)")
    page.key("ArrowRight")
    page.wait("live.painted >= live.sent")
    after = page.run(
        f"live.answers.values(live.present.exact)[live.model.sliders.findIndex((s) => s.path === '{path}')]"
    )
    assert after > before
    page.key("z", control=True)
    page.wait(
        f"live.painted >= live.sent && Math.abs(Number({slider(path)}.range.value) - {before!r}) < 1e-9"
    )
    page.key("Tab")
    page.wait("document.activeElement.type === 'number'")


def test_a_drag_paints_its_last_value(page: Page) -> None:
    """Input events without waiting, as from a hand; the page ends at the last of them."""
    page.run(f"""(() => {{
        const r = {slider("RIB.z")}, s = r.slider;
        for (let k = 1; k <= 40; k += 1) {{
            r.range.value = s.start + 0.05 * k;
            r.range.dispatchEvent(new Event('input'));
        }}
        r.range.dispatchEvent(new Event('change'));
    }})()""")
    page.wait("live.painted >= live.sent")
    place = page.run("live.model.sliders.findIndex((s) => s.path === 'RIB.z')")
    start = page.run(f"{slider('RIB.z')}.slider.start")
    assert page.run(f"live.present.exact[{place}]") == pytest.approx(start + 2.0)
    click(page, "undo")
    page.wait(f"live.painted >= live.sent && Math.abs(live.present.exact[{place}] - {start!r}) < 1e-9")


def test_search_groups_and_order(page: Page) -> None:
    search = "document.getElementById('search')"
    page.run(f"{search}.value = 'tie rod'; {search}.dispatchEvent(new Event('input'))")
    shown = page.run("Array.from(document.querySelectorAll('#sliders .slider'), (n) => n.dataset.path)")
    assert shown and {p.split(".")[0] for p in shown} <= {"RIB", "ROB"}
    page.run(f"{search}.value = ''; {search}.dispatchEvent(new Event('input'))")
    page.run("document.querySelector('tr[data-id=\"vertical.bump_steer\"]').click()")
    numbers = "Array.from(document.querySelectorAll('#sliders .slider'), (n) => Number(n.dataset.influence))"
    effects = [abs(v) for v in page.run(numbers)]
    assert effects == sorted(effects, reverse=True) and effects[0] > 0
    assert page.run("document.querySelector('#sliders .slider').dataset.path").split(".")[0] in {
        "RIB",
        "ROB",
        "LLF",
        "LLR",
        "LWB",
    }


def test_bounds_refusals_and_a_design_without_answer(page: Page) -> None:
    start = page.run(f"{slider('LLF.z')}.slider.start")
    enter_far = f"{slider('LLF.z')}.number"
    page.run(f"{enter_far}.value = '{start + 800}'; {enter_far}.dispatchEvent(new Event('change'))")
    assert "outside its bounds" in page.wait("document.body.dataset.refused")
    page.wait(f"Math.abs(Number({slider('LLF.z')}.number.value) - {start!r}) < 1e-6")
    choose(page, f"{slider('LLF.z')}.upper", str(start + 900))
    page.wait(f"Number({slider('LLF.z')}.range.max) === {start + 900}")
    good = page.run("Array.from(live.present.drawn.subarray(0, 50))")
    enter(page, "LLF.z", start + 800)
    page.wait("!document.getElementById('failure').hidden")
    assert "no equilibrium" in page.run("document.getElementById('failure').textContent")
    assert page.run("Array.from(live.present.drawn.subarray(0, 50))") == good
    click(page, "undo")
    page.wait("document.getElementById('failure').hidden && live.painted >= live.sent")
    click(page, "undo")
    page.wait(f"Number({slider('LLF.z')}.range.max) < {start + 900}")


def test_snapshots_advice_locks_and_holds(page: Page) -> None:
    before = gap(page)
    click(page, "snapshot")
    page.wait("document.querySelectorAll('#snapshot-keys .key').length === 1 && live.references[1]")
    click(page, "helpers")
    page.wait("document.body.dataset.advice === 'helpers'")
    assert page.run("document.querySelectorAll('#advice tbody tr').length") == 3
    page.run("document.querySelector('#advice > button').click()")
    page.wait("live.state.locked.length === live.model.sliders.length - 3")
    hold = "document.querySelector('tr[data-id=\"roll.roll_rate\"] input')"
    page.run(f"{hold}.click()")
    page.wait("live.state.held.length === 1")
    click(page, "best_step")
    page.wait("document.body.dataset.advice === 'best_step'")
    page.wait(f"live.answers.totals(live.present.exact).gap < {before!r} - 0.01")
    moved = page.run(
        "live.model.sliders.filter((s, i) => Math.abs(live.present.exact[i] - s.start) > 1e-9).length"
    )
    assert 1 <= moved <= 3
    shown = "live.rows.get(s.path).range.value"
    page.wait("live.painted >= live.sent")
    page.wait(f"live.model.sliders.every((s, i) => Math.abs({shown} - live.present.exact[i]) < 1e-9)")
    page.run("document.querySelector('#snapshot-keys button').click()")
    page.wait(f"Math.abs(live.answers.totals(live.present.exact).gap - {before!r}) < 1e-9")
    page.run(f"{hold}.click()")
    click(page, "invisible")
    page.wait("document.body.dataset.advice === 'invisible'")
    page.run("send({ kind: 'lock', on: false })")
    page.wait("live.state.locked.length === 0")


def test_the_axle_moves_turns_and_picks(page: Page) -> None:
    choose(page, "document.getElementById('axle-case')", "roll")
    page.wait("document.getElementById('axle-input').textContent.includes('deg')")
    page.run("window.before = Array.from(live.axle.places), 0")
    page.run(
        "const b = document.getElementById('axle-row'); b.value = 0; b.dispatchEvent(new Event('input'))"
    )
    page.wait("document.getElementById('axle-input').textContent.includes('−')")
    page.wait("live.axle.places.some((place, i) => place !== window.before[i])")
    page.run("document.getElementById('axle').focus()")
    azimuth = page.run("live.axle.azimuth")
    page.key("ArrowLeft")
    page.wait(f"live.axle.azimuth !== {azimuth!r}")
    page.run("document.querySelector('.view[data-view=rear]').click()")
    left, top = page.run(
        "(({left, top}) => [left, top])(document.getElementById('axle').getBoundingClientRect())"
    )
    x, y = page.run(
        "live.axle.project(live.axle.point(live.axle.places, live.axle.lines.points.indexOf('ROB')))"
    )
    page.mouse("mousePressed", left + x, top + y)
    page.mouse("mouseReleased", left + x, top + y)
    picked = page.wait("live.point")
    assert (
        page.run("Array.from(document.querySelectorAll('#sliders b'), (b) => b.textContent.split('.')[0])")
        == [picked] * 3
    )


def test_an_effect_is_switched_on_and_off(page: Page) -> None:
    box = "document.querySelector('#effects .effect[data-name=strut_friction] input[type=checkbox]')"
    page.run(f"{box}.click()")
    page.wait("live.state && live.state.effects.strut_friction && live.painted >= live.sent")
    half = (
        "Math.max(...live.layout.curve(live.present.drawn, 'vertical', 'tyre_load', 0, true).map(Math.abs))"
    )
    page.wait(f"{half} > 10")
    page.run(f"{box}.click()")
    page.wait(f"!live.state.effects.strut_friction && {half} < 1e-6")


def test_it_prints_without_its_controls(page: Page) -> None:
    page.send("Emulation.setEmulatedMedia", media="print")
    hidden = "['left', 'advice-box'].every((i) => document.getElementById(i).offsetParent === null)"
    assert page.run(hidden) and page.run("document.querySelectorAll('.chart canvas').length") == 8
    pdf = page.send("Page.printToPDF", printBackground=True)
    assert len(pdf["data"]) > 20_000
    page.send("Emulation.setEmulatedMedia", media="")
    assert page.errors == []


def test_a_killed_server_is_said_and_the_page_stays(page: Page, served: Served) -> None:
    """Last: it ends the server."""
    served.process.kill()
    page.wait("document.body.dataset.connected === 'no'")
    assert "ended" in page.run("document.getElementById('status').textContent")
    assert page.run("document.querySelectorAll('.chart canvas').length") == 8


def test_the_written_page_moves_without_server_or_request(page: Page, tmp_path: Path) -> None:
    """Its curves are the first-order model's, dashed, and it says how far they hold."""
    live = Session(model())
    path = tmp_path / "page.html"
    path.write_text(static_page(live), encoding="utf-8")
    page.send("Page.navigate", url="about:blank")  # the page before looks for its server again and again
    page.wait("location.href === 'about:blank'")
    page.events.clear()
    page.open(path)
    page.wait("document.body.dataset.seq")
    assert page.errors == [] and page.requests == [path.as_uri()]
    notice = page.run("document.getElementById('approximation').textContent")
    assert "first-order" in notice and "largest error" in notice
    assert page.run("live.charts[0].plot.series.at(-1).dash.length") == 2
    known = first_order(live.slopes(), live.space)
    slider_path, start = known.paths[0], live.values()[known.paths[0]]
    variable = live.space.variables[known.columns[0]]
    value = start + 0.4 * (variable.upper - start)
    enter(page, slider_path, value)
    curves, characteristics, gap_there = known.predict({slider_path: value})
    drawn = page.run("Array.from(live.present.drawn)")
    np.testing.assert_allclose(drawn, curves, rtol=1e-4, atol=1e-4)
    told = page.run("Array.from(live.answers.characteristics(live.present.exact))")
    np.testing.assert_allclose(told, np.nan_to_num(characteristics), rtol=1e-4, atol=1e-5)
    assert gap(page) == pytest.approx(gap_there, rel=1e-4)
    page.run("window.before = Array.from(live.axle.places), 0")
    choose(page, "document.getElementById('axle-case')", "brake")
    page.wait("live.axle.places.some((place, i) => place !== window.before[i])")
    click(page, "snapshot")
    page.wait("document.querySelectorAll('#snapshot-keys .key').length === 1")
    click(page, "undo")
    click(page, "undo")
    page.wait(f"Math.abs(live.present.exact[0] - {start!r}) < 1e-9")
