"""Frames: the layout that the page reads, and what views put into it."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import RESPONSE_UNITS
from doe_kc.live import frames, views
from doe_kc.live.frames import PageFrame
from doe_kc.live.session import Session
from tests.live.cases import say, session


@pytest.fixture(scope="module")
def live() -> Session:
    return session("double_wishbone_front")


def test_layout_is_header_doubles_floats_text() -> None:
    frame = PageFrame(1, 7, np.array([1.5, np.nan]), np.array([0.25]), {"failure": ""})
    data = frame.encode()
    assert struct.unpack_from("<6I", data) == (1, 7, 2, 1, 15, 0)
    assert struct.unpack_from("<d", data, 24)[0] == 1.5 and struct.unpack_from("<f", data, 40)[0] == 0.25
    assert data[44:] == b'{"failure": ""}'
    again = PageFrame.decode(data)
    np.testing.assert_array_equal(again.exact, frame.exact)
    with pytest.raises(ValueError, match="length"):
        PageFrame.decode(data[:-1])
    with pytest.raises(ValueError, match="header"):
        PageFrame.decode(data[:10])


def test_an_answer_has_the_announced_length(live: Session) -> None:
    said = views.announcement(live)
    frame = PageFrame.decode(views.present_frame(live, 3).encode())
    points = sum(len(case["input"]) for case in said["cases"])
    assert frame.drawn.size == 2 * points * len(RESPONSE_UNITS) * 2
    assert frame.exact.size == len(said["sliders"]) + 2 * len(CHARACTERISTICS) + 3
    first = live.present.curves.cases[said["cases"][0]["id"]].mean["toe"][0]
    np.testing.assert_allclose(frame.drawn[: first.size], first, rtol=1e-6)
    assert frame.exact[-3] == live.present.gap


def test_an_effect_with_loops_is_drawn_at_the_announced_inputs() -> None:
    live = session()
    before = PageFrame.decode(views.present_frame(live, 1).encode()).drawn
    say(live, kind="effect", name="strut_friction", sizes={"force_N": 80.0})
    live.solve_now()
    live.compilation.wait()
    case = live.present.curves.cases["vertical"]
    assert case.input.size > live.nominal.curves.cases["vertical"].input.size
    frame = PageFrame.decode(views.present_frame(live, 2).encode())
    assert frame.drawn.size == before.size
    half = frame.drawn[before.size // 2 :]
    places = np.cumsum(
        [0] + [2 * c.input.size for c in live.nominal.curves.cases.values() for _ in RESPONSE_UNITS]
    )
    load = list(RESPONSE_UNITS).index("tyre_load")
    np.testing.assert_allclose(
        half[places[load] : places[load + 1]].reshape(2, -1)[0],
        np.interp(live.nominal.curves.cases["vertical"].input, case.input, case.half_width["tyre_load"][0]),
        rtol=1e-5,
        atol=1e-4,
    )
    last = len(live.nominal.curves.cases["vertical"].input) - 1
    seen = views.shape_frame(live.present, live.nominal.curves, "vertical", last, 0)
    assert seen.text["input"] == pytest.approx(live.nominal.curves.cases["vertical"].input[-1])


def test_the_axle_at_rest_is_level_and_moves_with_the_input(live: Session) -> None:
    said = views.announcement(live)
    n = len(said["shape"]["points"])
    case = said["cases"][0]
    last = len(case["input"]) - 1
    frame = views.shape_frame(live.present, live.nominal.curves, "vertical", last, 0)
    assert frame.text["input"] == case["input"][-1] > 0
    points = frame.drawn[: 3 * 2 * n * 3].reshape(3, 2, n, 3)
    design, rest, moved = points
    assert np.abs(rest[0, :, 1] + rest[1, :, 1]).max() < 1e-6  # mirror images
    centre = said["shape"]["wheel_centre"]
    rise = live.present.curves.cases["vertical"].mean["wc_z"][0][-1]
    assert moved[0, centre, 2] - rest[0, centre, 2] == pytest.approx(rise, abs=1e-6)
    assert (
        np.abs(design[0, centre] - np.array(said["nominal_points"]).reshape(2, n, 3)[0, centre]).max() < 1e-3
    )
    assert frame.kind == frames.SHAPE


@pytest.mark.parametrize("row", [0, 10, 32, 33, 64])
def test_a_row_is_its_place_on_the_rising_input(live: Session, row: int) -> None:
    branch, place = views._branch_row(live.present.solution.cases["vertical"], row)
    assert branch.input[place] == pytest.approx(live.present.curves.cases["vertical"].input[row])
