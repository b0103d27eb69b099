"""The state of a live page, on the server: what was set, what the true model answers, what is advised.

One object for all tabs, driven by messages, without a browser or a socket: `Session.handle` changes the state
and says what has to be told; `Session.solve` is called in another thread with what `Session.request` gave.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, replace

from doe_kc.axle.parameters import check_value
from doe_kc.ground.errors import InputError, RunError, nearest
from doe_kc.live import messages as says
from doe_kc.live.advice import Advised, best_step, most_helpful, not_visible
from doe_kc.live.answer import Compilation, LiveAnswer, LiveSlopes, slopes_of, solve_live
from doe_kc.live.model import LiveModel, effective_axle
from doe_kc.live.state import LiveState, Snapshot, StateHistory
from doe_kc.variables import Space


@dataclass(frozen=True)
class SolveRequest:
    """What to solve. seq: of the message that asked, told back with the answer."""

    seq: int
    model: LiveModel
    values: Mapping[str, float]


@dataclass(frozen=True)
class Update:
    """What a message did. solve: the answer is no longer that of the state. sliders: they are others now.
    state: locks, bounds, snapshots or the like. advice: to be asked for. keep: to be written or read.
    """

    solve: bool = False
    sliders: bool = False
    state: bool = True
    advice: str = ""
    keep: str = ""


class Session:
    """seq: of the last message that moved something. present: the last good answer. failure: why the state
    that is set has none; empty when `present` is its answer.
    """

    def __init__(self, model: LiveModel) -> None:
        """Solves the study's axle; RunError when it has no equilibrium."""
        self.compilation = Compilation()
        self.compilation.compile(model.axle.topology)
        answer = solve_live(model, {}, self.compilation)
        if isinstance(answer, str):
            raise RunError(f"{model.study.axle_path}: the axle cannot be solved: {answer}")
        self.base, self.model = model, model
        self.nominal = self.present = answer
        self.failure = ""
        self.seq = 0
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
        return self.space_of(self.state)

    def space_of(self, state: LiveState) -> Space:
        """The sliders with the bounds of a state."""
        variables = tuple(
            replace(v, lower=state.bounds[v.path][0], upper=state.bounds[v.path][1])
            if v.path in state.bounds
            else v
            for v in self.model.space.variables
        )
        return replace(self.model.space, variables=variables)

    def values(self) -> dict[str, float]:
        """Path -> absolute value of every slider."""
        set_now = self.state.values
        return {v.path: set_now.get(v.path, v.start) for v in self.model.space.variables}

    def handle(self, message: says.Message) -> Update:
        """Do what a message asks; InputError, and nothing done, for what cannot be."""
        match message:
            case says.Move():
                return self._move(message)
            case says.Reset(path=path):
                if path is not None:
                    self._known(path)
                state = self.state.without(path) if path else replace(self.state, values={})
                return self._changed(state, message.seq)
            case says.Lock():
                return self._locked(message)
            case says.Hold():
                self._known_characteristic(message.characteristic)
                return self._set(self.state.with_held(message.characteristic, held=message.on))
            case says.BoundsChange():
                return self._bounds(message)
            case says.SwitchEffect():
                return self._switch(message)
            case says.TakeSnapshot(name=name):
                return self._snapshot(name)
            case says.PlacedSnapshot():
                return self._placed(message)
            case says.UndoStep(kind=kind):
                return self._step(message.seq, back=kind == "undo")
            case says.Ask(kind=kind):
                return Update(state=False, advice=kind)
            case says.Keep(kind=kind):
                return Update(state=False, keep=kind)
            case says.Look():
                return Update(state=False)

    def _known(self, path: str) -> None:
        paths = self.model.space.paths
        if path not in paths:
            raise InputError(f"{path}: is no slider of this axle.{nearest(path, paths)}")

    def _known_characteristic(self, ident: str) -> None:
        known = () if self.model.targets is None else self.model.targets.characteristics
        names = [t.entry.id for t in known]
        if ident not in names:
            raise InputError(f"{ident}: has no target here, so it cannot be held.{nearest(ident, names)}")

    def _move(self, message: says.Move) -> Update:
        self._known(message.path)
        variable = next(v for v in self.space.variables if v.path == message.path)
        if not variable.lower <= message.value <= variable.upper:
            raise InputError(
                f"{message.path} = {message.value:g}: outside its bounds {variable.lower:g} to "
                f"{variable.upper:g} {variable.unit}; widen them first."
            )
        state = self.state.moved({message.path: message.value})
        self._history.change(state, gesture=f"move {message.path}")
        if message.last:
            self._history.finish_gesture()
        self.seq = max(self.seq, message.seq)
        return Update(solve=True, state=message.last)

    def _changed(self, state: LiveState, seq: int) -> Update:
        """A step of its own that has to be solved."""
        sliders = state.effects != self.state.effects
        self._history.change(state)
        self.seq = max(self.seq, seq)
        if sliders:
            self._remodel()
        return Update(solve=True, sliders=sliders)

    def _set(self, state: LiveState) -> Update:
        self._history.change(state)
        return Update()

    def _remodel(self) -> None:
        with self._lock:
            self.model = self.base.with_effects(self.state.effects)

    def _locked(self, message: says.Lock) -> Update:
        for path in message.paths:
            self._known(path)
        paths = frozenset(message.paths or self.model.space.paths)
        locked = self.state.locked | paths if message.on else self.state.locked - paths
        return self._set(replace(self.state, locked=locked))

    def _bounds(self, message: says.BoundsChange) -> Update:
        self._known(message.path)
        variable = next(v for v in self.model.space.variables if v.path == message.path)
        where = f"bounds of {message.path}"
        if not message.lower < message.upper:
            raise InputError(f"{where}: {message.lower:g} to {message.upper:g}; the lower one comes first.")
        value = self.values()[message.path]
        if not message.lower <= min(value, variable.start) <= max(value, variable.start) <= message.upper:
            raise InputError(f"{where}: must hold its start {variable.start:g} and its value {value:g}.")
        if variable.logarithmic and message.lower <= 0.0:
            raise InputError(f"{where}: equal steps are equal ratios, so the lower one must be above zero.")
        for edge in (message.lower, message.upper):
            check_value(message.path, edge, where)
        bounds = {**self.state.bounds, message.path: (message.lower, message.upper)}
        return self._set(replace(self.state, bounds=bounds))

    def _switch(self, message: says.SwitchEffect) -> Update:
        effects = {k: v for k, v in self.state.effects.items() if k != message.name}
        if message.sizes is not None:
            effects[message.name] = dict(message.sizes)
        effective_axle(self.base.axle, effects)
        return self._changed(replace(self.state, effects=effects), message.seq)

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
        return Update(solve=True, sliders=sliders, state=moved)

    def adopt(self, values: Mapping[str, float], seq: int = 0) -> Update:
        """Go to values that were advised, as one step."""
        return self._changed(self.state.moved(values), seq)

    def replaced(self, state: LiveState, seq: int = 0) -> Update:
        """Go to a state that was saved, as one step; InputError when it is none of this axle."""
        effective_axle(self.base.axle, state.effects)
        return self._changed(state, seq)

    @property
    def settled(self) -> bool:
        """Whether `present` is the answer to the state as it is."""
        present = self.present
        if self.failure or present.model is not self.model:
            return False
        return all(present.values.get(path) == value for path, value in self.values().items())

    def request(self) -> SolveRequest:
        """What has to be solved for the state as it is."""
        known = set(self.model.space.paths)
        values = {p: v for p, v in self.state.values.items() if p in known}
        return SolveRequest(self.seq, self.model, values)

    def solve(self, request: SolveRequest) -> LiveAnswer | str:
        """Ask the true model, from any one thread; keeps the answer, or beside the last good one why not."""
        answer = solve_live(request.model, request.values, self.compilation)
        with self._lock:
            if request.model is not self.model:
                return answer
            if isinstance(answer, str):
                self.failure = answer
            else:
                self.present, self.failure = answer, ""
        return answer

    def solve_now(self) -> LiveAnswer | str:
        """Solve the state as it is."""
        return self.solve(self.request())

    def slopes(self) -> LiveSlopes:
        """Exact sensitivities of the present answer, kept until there is another."""
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
