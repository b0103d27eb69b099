"""The session object, driven by messages: what is set, solved, undone and advised."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.characteristics import CHARACTERISTICS, reduce_all
from doe_kc.ground.errors import InputError
from doe_kc.live.answer import COMPILE_SHARE
from doe_kc.live.messages import LONGEST_MESSAGE, read_message
from doe_kc.live.session import Session, Update
from doe_kc.solver.compiled import AdaptiveKernel
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.library import find_compiler
from doe_kc.solver.suite import library_for, solve
from tests.live.cases import EXAMPLES, say, session


def move(live: Session, path: str, value: float, *, last: bool = True) -> Update:
    return say(live, kind="move", seq=live.seq + 1, path=path, value=value, last=last)


@pytest.fixture(scope="module")
def shared() -> Session:
    return session()


def test_the_answer_is_the_solvers_own() -> None:
    live = session()
    value = live.values()["LLF.z"] + 1.5
    assert move(live, "LLF.z", value).solve
    live.solve_now()
    axle = with_values(live.base.axle, {"LLF.z": value})
    curves = curve_set(solve(axle))
    wanted = np.array(list(reduce_all(curves, live.model.windows).values()))
    np.testing.assert_allclose(live.present.characteristics, wanted, rtol=1e-9)
    for case, of_case in curves.cases.items():
        np.testing.assert_allclose(
            live.present.curves.cases[case].mean["toe"], of_case.mean["toe"], atol=1e-10
        )
    assert live.present.gap != live.nominal.gap and live.present.rating is not None


def test_slopes_are_those_of_finite_differences() -> None:
    live = session()
    row = list(CHARACTERISTICS).index("vertical.bump_steer")
    for path, step in (("RIB.z", 0.01), ("llr.Fx", 0.001)):
        live.handle(read_message('{"kind": "reset"}'))
        live.solve_now()
        slopes = live.slopes()
        place = live.model.space.paths.index(path)
        exact = (slopes.expansion.characteristics * slopes.per_unit)[row, place]
        start, ends = live.values()[path], []
        for sign in (1.0, -1.0):
            move(live, path, start + sign * step)
            live.solve_now()
            ends.append(live.present.characteristics[row])
        assert exact == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=2e-3, abs=1e-6)


def test_a_drag_is_one_step_of_undo() -> None:
    live = session()
    start = live.values()["ROB.z"]
    for k in range(1, 6):
        move(live, "ROB.z", start + 0.1 * k, last=k == 5)
    move(live, "RIB.z", live.values()["RIB.z"] + 1.0)
    say(live, kind="undo")
    assert live.values()["ROB.z"] == start + 0.5
    assert say(live, kind="undo").solve and live.values()["ROB.z"] == start and not live.can_undo
    say(live, kind="redo")
    assert live.values()["ROB.z"] == start + 0.5 and live.can_redo
    move(live, "ROB.z", start + 0.2)
    assert not live.can_redo
    before = live.state
    assert not say(live, kind="redo").state and live.state is before


def test_a_design_without_equilibrium_keeps_the_last_good_one() -> None:
    live = session()
    lower, upper = live.values()["LLF.z"] - 500.0, live.values()["LLF.z"] + 900.0
    say(live, kind="bounds", path="LLF.z", lower=lower, upper=upper)
    move(live, "LLF.z", upper)
    good = live.present
    answer = live.solve_now()
    assert isinstance(answer, str) and "no equilibrium" in answer and live.failure == answer
    assert live.present is good
    say(live, kind="undo")
    live.solve_now()
    assert live.failure == ""


def test_an_effect_switches_sliders_and_is_undone() -> None:
    live = session()
    changes = say(live, kind="effect", name="strut_friction", sizes={"force_N": 80.0})
    assert changes.sliders and changes.solve
    assert live.model.axle.effects["strut_friction"]["force_N"] == 80.0
    live.solve_now()
    assert live.present.curves.cases["vertical"].half_width["wc_z"].max() > 0 or any(
        case.half_width["tyre_load"].max() > 1.0 for case in live.present.curves.cases.values()
    )
    say(live, kind="undo")
    assert not live.model.axle.effects
    live.compilation.wait()


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
def test_what_is_asked_for_often_is_compiled_by_a_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[AdaptiveKernel] = []
    monkeypatch.setattr(AdaptiveKernel, "compile", lambda kernel: begun.append(kernel))
    monkeypatch.setattr(AdaptiveKernel, "share_before_compiling", 0.1)
    live = session()
    topology = live.model.axle.topology
    assert live.compilation.use_now(topology) is None and not begun
    monkeypatch.setattr(AdaptiveKernel, "share_before_compiling", COMPILE_SHARE)
    for _ in range(3):
        assert live.compilation.use_now(topology) is None
    live.compilation.wait()
    assert begun == [library_for(topology, None)]


def test_snapshots_are_kept_restored_and_dropped() -> None:
    live = session()
    start = live.values()["RIB.z"]
    for k in range(4):
        move(live, "RIB.z", start + 0.5 * k)
        live.solve_now()
        say(live, kind="snapshot", name=f"S{k}")
    assert [s.name for s in live.state.snapshots] == ["S1", "S2", "S3"]
    say(live, kind="restore", place=0)
    assert live.values()["RIB.z"] == start + 0.5
    say(live, kind="drop", place=1)
    assert [s.name for s in live.state.snapshots] == ["S1", "S3"]


@pytest.mark.parametrize(
    "message",
    [
        {"kind": "move", "seq": 1, "path": "LFF.z", "value": 1.0},
        {"kind": "move", "seq": 1, "path": "LLF.z", "value": 1e6},
        {"kind": "move", "seq": 1, "path": "LLF.z", "value": float("nan")},
        {"kind": "move", "seq": 1, "path": "LLF.z", "value": "1"},
        {"kind": "move", "seq": -1, "path": "LLF.z", "value": 1.0},
        {"kind": "move", "path": "LLF.z"},
        {"kind": "bounds", "path": "llr.Fx", "lower": -1.0, "upper": 2.0},
        {"kind": "bounds", "path": "LLF.z", "lower": 0.0, "upper": 1.0},
        {"kind": "effect", "name": "warp", "sizes": {}},
        {"kind": "effect", "name": "strut_friction", "sizes": {"force": 1.0}},
        {"kind": "effect", "name": "strut_friction", "sizes": {"force_N": -5.0}},
        {"kind": "hold", "characteristic": "nothing", "on": True},
        {"kind": "restore", "place": 0},
        {"kind": "write", "path": "/etc/passwd"},
        {"kind": "save", "path": "/etc/passwd"},
        [],
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(shared: Session, message: Any) -> None:
    before = shared.state
    with pytest.raises(InputError):
        shared.handle(read_message(json.dumps(message)))
    assert shared.state is before and shared.seq == 0


def test_huge_and_broken_messages_are_refused() -> None:
    for text in ("{", "", "\0", '{"kind": "undo"}' + " " * LONGEST_MESSAGE, "[" * 5000):
        with pytest.raises(InputError):
            read_message(text)


def test_the_program_of_the_page_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    root = EXAMPLES.parent
    (block,) = re.findall(r"```python\n(.*?)```", (root / "docs" / "live.md").read_text("utf-8"), re.DOTALL)
    monkeypatch.chdir(root)
    exec(compile(block, "live.md", "exec"), {})
    gaps, sentence = capsys.readouterr().out.strip().splitlines()
    assert len({*gaps.split()}) == 2 and "these 3" in sentence


def test_a_snapshot_is_of_the_answer_to_what_is_set() -> None:
    live = session()
    move(live, "RIB.z", live.values()["RIB.z"] + 1.0)
    assert not live.settled
    with pytest.raises(InputError, match="still being solved"):
        say(live, kind="snapshot")
    live.solve_now()
    assert live.settled and say(live, kind="snapshot").state


def test_an_effect_that_brings_a_slider_is_asked_for_advice() -> None:
    """The present answer is of another number of sliders until the new axle is solved."""
    live = session()
    before = len(live.space.paths)
    say(live, kind="effect", name="steer_arm_compliance", sizes={})
    assert len(live.space.paths) > before and not live.settled
    live.solve_now()
    assert live.settled and live.advise("helpers").rows
    live.compilation.wait()
