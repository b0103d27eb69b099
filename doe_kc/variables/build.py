"""Builds the space of variables that a study asks for on an axle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

from doe_kc.axle.design_parameters import Parameter, design_parameters
from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import kind_of
from doe_kc.axle.parameters import parameter_value, with_values
from doe_kc.ground.errors import InputError, nearest
from doe_kc.variables.options import Change, VariableOptions
from doe_kc.variables.space import Space, Tie
from doe_kc.variables.variable import Variable


@dataclass(frozen=True)
class Advice:
    """Variables and bounds that an influence study advises: path -> (lower, upper), absolute."""

    bounds: Mapping[str, tuple[float, float]]


def build_space(axle: Axle, options: VariableOptions, source: str, *, advice: Advice | None = None) -> Space:
    """The variables of a study; InputError naming `source`, key and remedy for anything wrong.

    Default are all parameters that the axle's model contains; `strut.flexibility` counts as contained once
    it is above zero. advice: needed for `use = "selection"`.
    """
    known = {p.path: p for p in design_parameters(axle)}
    for change in options.change:
        _check_match(axle, change, known, source)
    chosen = _chosen(axle, options, known, source, advice)
    fixed: dict[str, float] = {}
    ties: list[Tie] = []
    variables: list[Variable] = []
    for path in chosen:
        changes = [c for c in options.change if fnmatchcase(path, c.match)]
        value, leader = _last(changes, "fixed"), _last(changes, "tie")
        parameter = known.get(path) or plain_parameter(axle, path)
        if value is not None:
            fixed[path] = value
        elif leader is not None:
            ties.append(_tie(axle, path, leader, source))
        else:
            advised = advice.bounds.get(path) if advice is not None else None
            variables.append(_variable(parameter, changes, options, advised, source))
    space = Space(tuple(variables), tuple(ties), fixed)
    _check(axle, space, source)
    return space


def _check_match(axle: Axle, change: Change, known: Mapping[str, Parameter], source: str) -> None:
    if any(fnmatchcase(path, change.match) for path in known):
        return
    if any(c in change.match for c in "*?["):
        raise InputError(
            f"{source}: variables.change: match = {change.match!r} fits no parameter; expected a path or "
            f"glob such as LLF.* or llr.F?.{nearest(change.match, known)}"
        )
    parameter_value(axle, change.match, source=f"{source}: variables.change")


def _chosen(
    axle: Axle,
    options: VariableOptions,
    known: Mapping[str, Parameter],
    source: str,
    advice: Advice | None,
) -> list[str]:
    """Paths in the order of the parameters; those that a change fixes, ties or frees by name are in."""
    if options.use == "selection":
        wanted = [p for p in known if advice is None or p in advice.bounds]
    else:
        for glob in [*options.use, *options.leave_out]:
            if not any(fnmatchcase(path, glob) for path in known) and not _settable(axle, glob):
                raise InputError(
                    f"{source}: variables: {glob!r} matches no parameter; expected a path or glob such as "
                    f"LLF.* or llr.F?.{nearest(glob, known)}"
                )
        wanted = [p for p in known if _named(p, options.use) and (p in options.use or in_model(known[p]))]
        wanted += [p for p in options.use if p not in known and _settable(axle, p)]
    wanted = [p for p in wanted if not _named(p, options.leave_out)]
    special = [c.match for c in options.change if c.match not in wanted and _says_more(c)]
    return wanted + [p for p in special if p in known or _settable(axle, p)]


def in_model(parameter: Parameter) -> bool:
    """Whether a parameter is a variable by default."""
    return parameter.in_model


def _says_more(change: Change) -> bool:
    return change.fixed is not None or change.tie is not None


def _named(path: str, globs: Sequence[str]) -> bool:
    return any(fnmatchcase(path, g) for g in globs)


def _settable(axle: Axle, path: str) -> bool:
    try:
        parameter_value(axle, path)
    except InputError:
        return False
    return True


def plain_parameter(axle: Axle, path: str) -> Parameter:
    """A settable value that is no design parameter: it has no bounds until a change gives some."""
    value = parameter_value(axle, path)
    kind = kind_of(path)
    return Parameter(
        path=path,
        label=kind.label if kind else path,
        group=kind.group if kind else "OTHER",
        unit=kind.unit if kind else "",
        nominal=value,
        lower=value,
        upper=value,
        step=kind.step * (abs(value) if kind.relative else 1.0) if kind else 0.1 * abs(value),
        active=True,
    )


def _tie(axle: Axle, path: str, leader: str, source: str) -> Tie:
    own = parameter_value(axle, path, source=f"{source}: variables.change")
    other = parameter_value(axle, leader, source=f"{source}: variables.change: tie")
    ratio = is_ratio(path) and is_ratio(leader)
    return Tie(path, leader, ratio, own, other)


def is_ratio(path: str) -> bool:
    """Whether a parameter is one of size (stiffness, rate, radius), not of place."""
    kind = kind_of(path)
    return kind.relative if kind is not None else False


def _variable(
    parameter: Parameter,
    changes: Sequence[Change],
    options: VariableOptions,
    advised: tuple[float, float] | None,
    source: str,
) -> Variable:
    lower, upper = _bounds(parameter, changes, advised)
    start = _last(changes, "start")
    first = parameter.nominal if start is None else start
    where = f"{source}: variable {parameter.path}"
    if not lower < upper:
        raise InputError(
            f"{where}: has no bounds (lower {lower:g}, upper {upper:g} {parameter.unit}); add a "
            f'[[variables.change]] with match = "{parameter.path}" and range = [low, high].'
        )
    if not lower <= first <= upper:
        raise InputError(
            f"{where}: start {first:g} is outside the bounds [{lower:g}, {upper:g}] {parameter.unit}; "
            "move the start or widen the bounds."
        )
    levels = _last(changes, "levels") or options.levels
    return Variable(
        parameter=parameter,
        lower=lower,
        upper=upper,
        start=first,
        levels=None if levels == "continuous" else levels,
        distribution=_last(changes, "distribution") or options.distribution,
        logarithmic=is_ratio(parameter.path) and lower > 0,
    )


def _bounds(
    parameter: Parameter, changes: Sequence[Change], advised: tuple[float, float] | None
) -> tuple[float, float]:
    bounds = advised or (parameter.lower, parameter.upper)
    for change in changes:
        if change.range is not None:
            bounds = (change.range[0], change.range[1])
        elif change.offset is not None:
            bounds = (parameter.nominal + change.offset[0], parameter.nominal + change.offset[1])
        elif change.factor is not None:
            bounds = (parameter.nominal * change.factor[0], parameter.nominal * change.factor[1])
    return bounds


def _last(changes: Sequence[Change], key: str) -> Any:
    values = [getattr(c, key) for c in changes if getattr(c, key) is not None]
    return values[-1] if values else None


def _check(axle: Axle, space: Space, source: str) -> None:
    if not space.variables:
        raise InputError(f'{source}: variables: none is left to vary; widen `use`, e.g. use = ["*"].')
    leaders = set(space.paths)
    for tie in space.ties:
        if tie.leader not in leaders:
            raise InputError(
                f"{source}: variables.change: {tie.follower} is tied to {tie.leader}, which is not a "
                "variable; tie it to one that is, or give it a fixed value."
            )
    for corner in (0.0, 1.0):
        with_values(axle, space.values(space.start * 0 + corner), source=f"{source}: variables: bounds")
