"""Everything that an engineer has set on a live page: one frozen value, so that undo is going back to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from doe_kc.live.answer import LiveAnswer
from doe_kc.live.effect_switches import EffectSizes

MOST_SNAPSHOTS = 3
"""More curves in one chart are not told apart."""


@dataclass(frozen=True)
class Snapshot:
    """A design that was kept to compare with. values: of the sliders that had moved."""

    name: str
    values: Mapping[str, float]
    effects: EffectSizes
    answer: LiveAnswer


@dataclass(frozen=True)
class LiveState:
    """values: absolute, of the sliders that were moved. bounds: (lower, upper) of those whose bounds were
    changed. locked: paths that advice leaves alone. held: characteristics that it must not move.
    locked_effects: names of switches that background tasks leave alone.
    """

    values: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=lambda: MappingProxyType({}))
    locked: frozenset[str] = frozenset()
    held: frozenset[str] = frozenset()
    effects: EffectSizes = field(default_factory=lambda: MappingProxyType({}))
    locked_effects: frozenset[str] = frozenset()
    snapshots: tuple[Snapshot, ...] = ()

    def moved(self, values: Mapping[str, float]) -> LiveState:
        """With sliders at other values; those at None's place are kept."""
        return replace(self, values={**self.values, **values})

    def without(self, path: str) -> LiveState:
        """With one slider at its start."""
        return replace(self, values={p: v for p, v in self.values.items() if p != path})

    def with_held(self, characteristic: str, *, held: bool) -> LiveState:
        """With one characteristic held or free."""
        return replace(self, held=self.held | {characteristic} if held else self.held - {characteristic})

    def with_snapshot(self, snapshot: Snapshot) -> LiveState:
        """With one more snapshot; the oldest goes when there are too many."""
        return replace(self, snapshots=(*self.snapshots, snapshot)[-MOST_SNAPSHOTS:])


class StateHistory:
    """The states gone through: undo, redo. A drag is one step, however many values it passes."""

    def __init__(self, state: LiveState) -> None:
        self.state = state
        self._past: list[LiveState] = []
        self._future: list[LiveState] = []
        self._gesture = ""

    def change(self, state: LiveState, *, gesture: str = "") -> None:
        """Go to another state. gesture: name of the drag that it is part of, empty for a step of its own."""
        if not gesture or gesture != self._gesture:
            self._past.append(self.state)
            del self._past[:-STEPS_KEPT]
        self._gesture = gesture
        self._future.clear()
        self.state = state

    def finish_gesture(self) -> None:
        """The next change is a step of its own."""
        self._gesture = ""

    def undo(self) -> bool:
        """Back one step; False at the first."""
        return self._move(self._past, self._future)

    def redo(self) -> bool:
        """Forward again; False at the last."""
        return self._move(self._future, self._past)

    def _move(self, source: list[LiveState], into: list[LiveState]) -> bool:
        self.finish_gesture()
        if not source:
            return False
        into.append(self.state)
        self.state = source.pop()
        return True

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to go back."""
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        """Whether a step was gone back."""
        return bool(self._future)


STEPS_KEPT = 200
"""Steps of undo; a state is some kB, each snapshot that was taken in them about a MB."""
