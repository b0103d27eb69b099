"""The state of a live page, on the server: what was set, what the model answers, what is advised.

One object for all tabs, driven by messages, without a browser or a socket: `Session.handle` changes the state
and says what has to be told; `Session.solve` is called in another thread with what `Session.request` gave.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, replace

from doe_kc.ground.errors import InputError, RunError
from doe_kc.live import messages as says
from doe_kc.live import state_changes as changes
from doe_kc.live.advice import Advised, best_step, most_helpful, not_visible
from doe_kc.live.answer import Compilation, LiveAnswer, LiveSlopes, slopes_of, solve_live
from doe_kc.live.confirmation import design_values, stored_answer
from doe_kc.live.model import LiveModel
from doe_kc.live.state import LiveState, Snapshot, StateHistory
from doe_kc.live.tasks import TaskRequest, TaskResult, task_request
from doe_kc.variables import Space


@dataclass(frozen=True)
class SolveRequest:
    """What to solve. seq: of the message that asked, told back with the answer. at_rest: no slider is being
    dragged, so that an outside solver is worth its time."""

    seq: int
    model: LiveModel
    values: Mapping[str, float]
    at_rest: bool = True


@dataclass(frozen=True)
class Update:
    """What a message did. solve: the answer is no longer that of the state. sliders: they are others now.
    state: locks, bounds, snapshots or the like. at_rest: no slider is being dragged. advice: to be asked for.
    task: to be cancelled or forgotten. keep: to be written or read.
    """

    solve: bool = False
    sliders: bool = False
    state: bool = True
    at_rest: bool = False
    advice: str = ""
    task: str = ""
    keep: str = ""


class Session:
    """seq: of the last message that moved something. present: the last good answer. failure: why the state
    that is set has none; empty when `present` is its answer. result: of the last background task.
    """

    def __init__(self, model: LiveModel) -> None:
        """Solves the study's axle; RunError when it has no equilibrium."""
        self.compilation = Compilation()
        self.compilation.prepare(model.axle.topology)
        answer = stored_answer(model, {}, self.compilation)
        if not isinstance(answer, LiveAnswer):
            answer = solve_live(model, {}, self.compilation)
        if isinstance(answer, str):
            raise RunError(f"{model.study.axle_path}: the axle cannot be solved: {answer}")
        self.base, self.model = model, model
        self.nominal = self.present = self._sure = answer
        self.failure = ""
        self.seq = 0
        self.result: TaskResult | None = None
        self._history = StateHistory(LiveState())
        self._lock = threading.Lock()
        self._slopes: LiveSlopes | None = None

    @property
    def state(self) -> LiveState:
        """What is set now."""
        return self._history.state

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to go back."""
        return self._history.can_undo

    @property
    def can_redo(self) -> bool:
        """Whether a step was gone back."""
        return self._history.can_redo

    @property
    def space(self) -> Space:
        """The sliders with the bounds that hold now."""
        return changes.bounded_space(self.model, self.state)

    def values(self) -> dict[str, float]:
        """Path -> absolute value of every slider."""
        return changes.values_of(self.model, self.state)

    def handle(self, message: says.Message) -> Update:
        """Do what a message asks; InputError, and nothing done, for what cannot be."""
        state, model, base = self.state, self.model, self.base
        match message:
            case says.Move():
                return self._move(message)
            case says.Reset(path=path):
                if path is not None:
                    changes.slider(model.space, path)
                return self._changed(state.without(path) if path else replace(state, values={}), message.seq)
            case says.Lock():
                return self._set(changes.with_locks(model, state, message))
            case says.Hold():
                return self._set(changes.with_hold(model, state, message))
            case says.BoundsChange():
                return self._set(changes.with_bounds(model, state, message))
            case says.SwitchEffect():
                return self._changed(changes.with_effect(base, state, message), message.seq)
            case says.ResetEffect(name=name):
                return self._changed(changes.without_effect(base, state, name), message.seq)
            case says.LockEffect(name=name):
                return self._set(changes.with_effect_lock(base, state, name, on=message.on))
            case says.TakeSnapshot(name=name):
                return self._snapshot(name)
            case says.PlacedSnapshot():
                return self._placed(message)
            case says.UndoStep(kind=kind):
                return self._step(message.seq, back=kind == "undo")
            case says.Ask(kind=kind):
                return Update(state=False, advice=kind)
            case says.RunTask():
                return Update(state=False)
            case says.EndTask(kind="adopt"):
                return self._adopt_result(message.seq)
            case says.EndTask(kind=kind):
                return Update(state=False, task=kind)
            case says.Keep(kind=kind):
                return Update(state=False, keep=kind)
            case says.Look():
                return Update(state=False)

    def _move(self, message: says.Move) -> Update:
        state = changes.with_move(self.model, self.state, message)
        self._history.change(state, gesture=f"move {message.path}")
        if message.last:
            self._history.finish_gesture()
        self.seq = max(self.seq, message.seq)
        return Update(solve=True, state=message.last, at_rest=message.last)

    def _changed(self, state: LiveState, seq: int) -> Update:
        """A step of its own that has to be solved."""
        sliders = state.effects != self.state.effects
        self._history.change(state)
        self.seq = max(self.seq, seq)
        if sliders:
            self._remodel()
        return Update(solve=True, sliders=sliders, at_rest=True)

    def _set(self, state: LiveState) -> Update:
        self._history.change(state)
        return Update()

    def _remodel(self) -> None:
        with self._lock:
            self.model = self.base.with_effects(self.state.effects)

    def _snapshot(self, name: str) -> Update:
        if self.failure:
            raise InputError(f"the present design has no answer to keep: {self.failure}")
        if not self.settled:
            raise InputError("the present design is still being solved; take the snapshot again.")
        words = name.strip() or f"Snapshot {len(self.state.snapshots) + 1}"
        kept = Snapshot(words, self.state.values, self.state.effects, self.present)
        return self._set(self.state.with_snapshot(kept))

    def _placed(self, message: says.PlacedSnapshot) -> Update:
        snapshots = self.state.snapshots
        if message.place >= len(snapshots):
            raise InputError(f"snapshot {message.place + 1}: there are {len(snapshots)}.")
        chosen = snapshots[message.place]
        if message.kind == "drop":
            left = tuple(s for i, s in enumerate(snapshots) if i != message.place)
            return self._set(replace(self.state, snapshots=left))
        state = replace(self.state, values=chosen.values, effects=chosen.effects)
        return self._changed(state, message.seq)

    def _step(self, seq: int, *, back: bool) -> Update:
        before = self.state
        moved = self._history.undo() if back else self._history.redo()
        self.seq = max(self.seq, seq)
        sliders = before.effects != self.state.effects
        if sliders:
            self._remodel()
        # solved in any case: the page waits for an answer to its number
        return Update(solve=True, sliders=sliders, state=moved, at_rest=True)

    def adopt(self, values: Mapping[str, float], seq: int = 0) -> Update:
        """Go to values that were advised, as one step."""
        return self._changed(self.state.moved(values), seq)

    def _adopt_result(self, seq: int) -> Update:
        """Go to the result of the background task, as one step; InputError without one."""
        result = self.result
        if result is None or not result.adoptable:
            raise InputError("there is no result to adopt; run correlate or discover first.")
        return self._changed(changes.with_result(self.base, self.state, result.values, result.effects), seq)

    def replaced(self, state: LiveState, seq: int = 0) -> Update:
        """Go to a state that was saved, as one step; InputError when it is none of this axle."""
        self.base.with_effects(state.effects)
        return self._changed(state, seq)

    @property
    def settled(self) -> bool:
        """Whether `present` is the answer to the state as it is."""
        present = self.present
        if self.failure or present.model is not self.model:
            return False
        return all(present.values.get(path) == value for path, value in self.values().items())

    def request(self, *, at_rest: bool = True) -> SolveRequest:
        """What has to be solved for the state as it is."""
        known = set(self.model.space.paths)
        values = {p: v for p, v in self.state.values.items() if p in known}
        return SolveRequest(self.seq, self.model, values, at_rest)

    def confirm_request(self, values: Mapping[str, float]) -> TaskRequest:
        """For the outside solver to answer slider values (those that moved)."""
        return task_request(self.model.study, "confirm", values=design_values(self.model, values))

    def solve(self, request: SolveRequest) -> LiveAnswer | str:
        """Ask the model, from any one thread; keeps the answer, or beside the last good one why not.

        Of an outside solver its own answer where its store has it and no slider is being dragged.
        """
        known = stored_answer(request.model, request.values, self.compilation) if request.at_rest else None
        answer = known or solve_live(request.model, request.values, self.compilation)
        self.keep(answer, request)
        return answer

    def keep(self, answer: LiveAnswer | str, request: SolveRequest) -> None:
        """An answer to a request; nothing where the sliders or effects are others by now."""
        with self._lock:
            if request.model is not self.model:
                return
            if isinstance(answer, str):
                self.failure = answer
                self.present = self.present if request.model.outside is None else self._sure
                return
            self.present, self.failure = answer, ""
            if answer.true:
                self._sure = answer
                if not self.nominal.true and not request.values:
                    self.nominal = answer

    def refuse(self, reason: str) -> None:
        """The outside solver has no answer to what is set: back to its last good one."""
        with self._lock:
            self.failure, self.present = reason, self._sure

    def remodelled(self, model: LiveModel) -> None:
        """Go on with a model of the same sliders that has learnt more."""
        with self._lock:
            self.base = self.model = model

    def solve_now(self) -> LiveAnswer | str:
        """Solve the state as it is."""
        return self.solve(self.request())

    def slopes(self) -> LiveSlopes:
        """Sensitivities of the present answer, kept until there is another."""
        with self._lock:
            present, kept = self.present, self._slopes
        if kept is None or kept.answer is not present:
            kept = slopes_of(present)
            with self._lock:
                self._slopes = kept
        return kept

    def advise(self, what: str) -> Advised:
        """best_step, helpers or invisible on the present answer; InputError without data to work on."""
        if not self.present.residual.size:
            raise InputError("there are no records to compare with, so there is nothing to advise.")
        if self.failure:
            raise InputError(f"the present design has no answer to start from: {self.failure}")
        state, space = self.state, self.space
        free = tuple(p not in state.locked for p in space.paths)
        if not any(free):
            raise InputError("all sliders are locked; unlock those that may move.")
        if what == "best_step":
            return best_step(self.slopes(), space, free, state.held, self.compilation)
        if what == "helpers":
            return most_helpful(self.slopes(), space, free)
        return not_visible(self.slopes(), space, free)
