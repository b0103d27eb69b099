"""What a message changes of a page's state: a new state, or InputError and nothing done."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from doe_kc.axle.parameter_kinds import check_value
from doe_kc.ground.errors import InputError, nearest
from doe_kc.live import messages as says
from doe_kc.live.effect_switches import EffectSizes, effect_switches, effective_axle
from doe_kc.live.model import LiveModel
from doe_kc.live.state import LiveState
from doe_kc.variables import Space
from doe_kc.variables.variable import Variable

EDGE = 1e-9
"""Relative: rounding of a bound that was shown and sent back."""


def bounded_space(model: LiveModel, state: LiveState) -> Space:
    """The sliders with the bounds of a state."""
    variables = tuple(
        replace(v, lower=state.bounds[v.path][0], upper=state.bounds[v.path][1])
        if v.path in state.bounds
        else v
        for v in model.space.variables
    )
    return replace(model.space, variables=variables)


def values_of(model: LiveModel, state: LiveState) -> dict[str, float]:
    """Path -> absolute value of every slider."""
    return {v.path: state.values.get(v.path, v.start) for v in model.space.variables}


def slider(space: Space, path: str) -> Variable:
    """The slider of a path; InputError where there is none."""
    for variable in space.variables:
        if variable.path == path:
            return variable
    raise InputError(f"{path}: is no slider of this axle.{nearest(path, space.paths)}")


def with_move(model: LiveModel, state: LiveState, message: says.Move) -> LiveState:
    """A slider at another value within its bounds."""
    variable = slider(bounded_space(model, state), message.path)
    if not variable.lower <= message.value <= variable.upper:
        raise InputError(
            f"{message.path} = {message.value:g}: outside its bounds {variable.lower:g} to "
            f"{variable.upper:g} {variable.unit}; widen them first."
        )
    return state.moved({message.path: message.value})


def with_locks(model: LiveModel, state: LiveState, message: says.Lock) -> LiveState:
    """Sliders locked or free."""
    for path in message.paths:
        slider(model.space, path)
    paths = frozenset(message.paths or model.space.paths)
    return replace(state, locked=state.locked | paths if message.on else state.locked - paths)


def with_hold(model: LiveModel, state: LiveState, message: says.Hold) -> LiveState:
    """A characteristic held or free."""
    ident = message.characteristic
    known = () if model.targets is None else model.targets.characteristics
    names = [t.entry.id for t in known]
    if ident not in names:
        raise InputError(f"{ident}: has no target here, so it cannot be held.{nearest(ident, names)}")
    return state.with_held(ident, held=message.on)


def with_bounds(model: LiveModel, state: LiveState, message: says.BoundsChange) -> LiveState:
    """A slider with other bounds, which hold its start and its value."""
    variable = slider(model.space, message.path)
    where = f"bounds of {message.path}"
    if not message.lower < message.upper:
        raise InputError(f"{where}: {message.lower:g} to {message.upper:g}; the lower one comes first.")
    value = values_of(model, state)[message.path]
    if not message.lower <= min(value, variable.start) <= max(value, variable.start) <= message.upper:
        raise InputError(f"{where}: must hold its start {variable.start:g} and its value {value:g}.")
    if variable.logarithmic and message.lower <= 0.0:
        raise InputError(f"{where}: equal steps are equal ratios, so the lower one must be above zero.")
    _check_learnt(model, variable, message, where)
    for edge in (message.lower, message.upper):
        check_value(message.path, edge, where)
    return replace(state, bounds={**state.bounds, message.path: (message.lower, message.upper)})


def _check_learnt(model: LiveModel, variable: Variable, message: says.BoundsChange, where: str) -> None:
    """InputError for bounds of an outside solver's slider beyond its stored designs."""
    room = EDGE * (variable.upper - variable.lower)
    inside = variable.lower - room <= message.lower and message.upper <= variable.upper + room
    if model.outside is not None and not inside:
        raise InputError(
            f"{where}: the stored designs end at {variable.lower:g} and {variable.upper:g}; widen the "
            "study's bounds and run doe-kc sample to go further."
        )


def with_effect(base: LiveModel, state: LiveState, message: says.SwitchEffect) -> LiveState:
    """An effect on with sizes, or off."""
    known = effect_switches(base.study)
    of_file = message.name in known and known[message.name].of_file
    if message.sizes is None and not of_file:
        return without_effect(base, state, message.name)
    return _effective(base, state, {**state.effects, message.name: message.sizes})


def without_effect(base: LiveModel, state: LiveState, name: str) -> LiveState:
    """An effect as it was at first: of the file as it is there, else off."""
    if name not in effect_switches(base.study):
        raise InputError(f"effect {name!r}: is none that this axle can be given; choose one of the list.")
    return _effective(base, state, {k: v for k, v in state.effects.items() if k != name})


def _effective(base: LiveModel, state: LiveState, effects: EffectSizes) -> LiveState:
    effective_axle(base.study, effects)
    return replace(state, effects=effects)


def with_effect_lock(base: LiveModel, state: LiveState, name: str, *, on: bool) -> LiveState:
    """An effect that background tasks neither look for nor change, or free again."""
    if name not in effect_switches(base.study):
        raise InputError(f"effect {name!r}: is none that this axle can be given; choose one of the list.")
    locked = state.locked_effects | {name} if on else state.locked_effects - {name}
    return replace(state, locked_effects=locked)


def with_result(
    base: LiveModel, state: LiveState, values: Mapping[str, float], effects: EffectSizes
) -> LiveState:
    """The design and the effects of a background task: all that it does not name is at its start.

    InputError where it sets what is no slider here.
    """
    together = {**state.effects, **effects}
    model = base.with_effects(together)
    starts = {v.path: v.start for v in model.space.variables}
    for path in values:
        if path not in starts:
            raise InputError(f"{path}: is set by the result and no slider here; take the axle file instead.")
    moved = {path: value for path, value in values.items() if value != starts[path]}
    return replace(state, values=moved, effects=together)
