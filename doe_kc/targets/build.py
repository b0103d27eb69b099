"""Targets of a study: from the reduced records, typed in, or both."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from typing import Any

import numpy as np
from numpy.typing import NDArray

from doe_kc.axle.model import Axle
from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.curves import RIG_RESPONSES, CaseCurves
from doe_kc.ground.errors import InputError
from doe_kc.load_cases import LOAD_CASES
from doe_kc.measurement import Measurement
from doe_kc.targets.comparison import constraint_interval
from doe_kc.targets.options import CharacteristicOptions, CurveOptions, check_names
from doe_kc.targets.target import Constraint, CurveTarget, Objective, Target, Targets

STATIC = "static"
NOISE_FLOOR = 10.0
"""A curve's Norm is its range, at least this many noise RMS: a flat curve's noise is not divided by ~0."""


def build_targets(
    axle: Axle,
    measurement: Measurement | None,
    characteristics: Sequence[CharacteristicOptions],
    curves: Sequence[CurveOptions],
    *,
    source: str,
    without: Collection[tuple[str, str]] = (),
) -> Targets:
    """Targets from the records, changed by the study's tables.

    Objective and constraint flags default to Appendix B, intervals to equations 5.1 and 5.2, weights to
    LinWt 1 and QuadWt 10000, Norm to sqrt(target^2 + 0.005) (the measure of the interval) and, for a
    curve, to its range; curves are objectives where a characteristic is read off them that is one.
    without: (load case, response) that are taken out as if the study said so, because the model cannot
    explain them. InputError for unknown names, an empty interval, a constraint without a target, or no
    objective at all.
    """
    check_names(characteristics, curves, source)
    swept = {STATIC, *axle.load_cases}
    targets = [
        _taken_out(t, without)
        for t in _targets(measurement, characteristics, source)
        if t.entry.load_case in swept
    ]
    _check_constraints(targets, characteristics, source)
    dropped = frozenset((*_dropped(targets, characteristics, curves), *without))
    rated = {(t.entry.load_case, t.entry.response) for t in targets if t.objective is not None}
    measured = list(_curves(axle, measurement, curves, dropped)) if measurement is not None else []
    chosen = [c.id for c in measured if _rated(c, curves, rated, without)]
    if not any(t.active for t in targets) and not chosen:
        raise InputError(
            f"{source}: no characteristic has a target and an objective or constraint; give measurement = "
            '"FOLDER" or a [[characteristics]] with match and target.'
        )
    return Targets(
        tuple(targets),
        tuple(c for c in measured if c.id in chosen),
        measurement.manifest.name if measurement else source,
        dropped,
        tuple(c for c in measured if c.id not in chosen),
    )


def _taken_out(target: Target, without: Collection[tuple[str, str]]) -> Target:
    if (target.entry.load_case, target.entry.response) not in without:
        return target
    return replace(target, objective=None, constraint=None, excluded=True)


def _rated(
    curve: CurveTarget,
    options: Sequence[CurveOptions],
    rated: Collection[tuple[str, str]],
    without: Collection[tuple[str, str]],
) -> bool:
    """Whether the rating counts the curve."""
    place = (curve.load_case, curve.response)
    own = [o for o in options if fnmatchcase(curve.id, o.match)]
    return place not in without and bool(first(last(own, "objective"), place in rated))


def _check_constraints(
    targets: Sequence[Target], characteristics: Sequence[CharacteristicOptions], source: str
) -> None:
    """InputError for a constraint that the study states where nothing it matches has a target."""
    known = [t.entry.id for t in targets]
    for option in characteristics:
        stated = option.constraint or option.low is not None or option.high is not None
        if stated and not any(fnmatchcase(name, option.match) for name in known):
            raise InputError(
                f"{source}: characteristics: match = {option.match!r} states a constraint, but the records "
                "hold no such characteristic and no target is given; add target = VALUE, or the load case to "
                "the records, or drop the entry."
            )


def _dropped(
    targets: Sequence[Target],
    characteristics: Sequence[CharacteristicOptions],
    curves: Sequence[CurveOptions],
) -> Iterator[tuple[str, str]]:
    """Curves whose objective the study says is false, or whose characteristics are neither objective nor
    constraint by its own words."""
    active = {(t.entry.load_case, t.entry.response) for t in targets if t.active}
    off = {
        (t.entry.load_case, t.entry.response)
        for t in targets
        if not t.active
        and (own := [o for o in characteristics if fnmatchcase(t.entry.id, o.match)])
        and (last(own, "objective"), last(own, "constraint")) == (False, False)
    }
    for case in (STATIC, *LOAD_CASES):
        for response in RIG_RESPONSES:
            said = last([o for o in curves if fnmatchcase(f"{case}.{response}", o.match)], "objective")
            if said is False or (said is None and (case, response) in off - active):
                yield case, response


def _targets(
    measurement: Measurement | None, options: Sequence[CharacteristicOptions], source: str
) -> Iterator[Target]:
    for ident, entry in CHARACTERISTICS.items():
        own = [o for o in options if fnmatchcase(ident, o.match)]
        value, sd = _value(ident, own, measurement)
        if math.isfinite(value):
            yield _target(entry, value, sd, own, source)


def _value(
    ident: str, own: Sequence[CharacteristicOptions], measurement: Measurement | None
) -> tuple[float, float]:
    """Typed value and sd before measured ones; a typed value without sd is exact."""
    typed, sd = last(own, "target"), last(own, "sd")
    if typed is not None:
        return typed, sd or 0.0
    if measurement is None:
        return math.nan, math.nan
    estimate = measurement.characteristics[ident]
    measured_sd = estimate.sd if math.isfinite(estimate.sd) else 0.0
    return estimate.value, measured_sd if sd is None else sd


def _target(
    entry: Characteristic, value: float, sd: float, own: Sequence[CharacteristicOptions], source: str
) -> Target:
    scale = Target(entry=entry, value=value, sd=sd).scale
    objective = Objective(
        goal=first(last(own, "goal"), "target"),
        linear=first(last(own, "linear"), 1.0),
        quadratic=first(last(own, "quadratic"), 0.0),
        norm=first(last(own, "norm"), scale),
    )
    low, high = constraint_interval(value)
    low, high = first(last(own, "low"), low), first(last(own, "high"), high)
    if not low < high:
        raise InputError(
            f"{source}: characteristics {entry.id}: the interval [{low:g}, {high:g}] {entry.unit} is empty; "
            "low must be below high."
        )
    constraint = Constraint(
        low=low,
        high=high,
        linear=first(last(own, "constraint_linear"), 0.0),
        quadratic=first(last(own, "constraint_quadratic"), 10000.0),
        norm=first(last(own, "constraint_norm"), scale),
    )
    typed = any(last(own, k) is not None for k in ("low", "high"))
    return Target(
        entry=entry,
        value=value,
        sd=sd,
        objective=objective if first(last(own, "objective"), entry.objective) else None,
        constraint=constraint if first(last(own, "constraint"), entry.constraint or typed) else None,
        excluded=last(own, "objective") is False,
        hold=first(last(own, "hold"), objective.goal == "target"),
        relax=first(last(own, "relax"), True),
    )


def _curves(
    axle: Axle,
    measurement: Measurement,
    options: Sequence[CurveOptions],
    dropped: Collection[tuple[str, str]],
) -> Iterator[CurveTarget]:
    """Every measured curve within the model's sweep."""
    for case in measurement.curves.cases.values():
        inside = reached(axle, case)
        if not inside.any():
            continue
        for response in case.mean:
            own = [o for o in options if fnmatchcase(f"{case.load_case}.{response}", o.match)]
            curve = np.asarray(case.mean[response])[:, inside]
            variance = [
                measurement.curve_variance(case.load_case, response, side)[inside].mean() for side in (0, 1)
            ]
            rms = math.sqrt(max(float(np.mean(variance)), 0.0))
            scale = max(float(np.ptp(curve, axis=1).max()), NOISE_FLOOR * rms)
            yield CurveTarget(
                load_case=case.load_case,
                response=response,
                input_unit=case.input_unit,
                input=case.input[inside],
                curve=curve,
                noise=rms,
                objective=Objective(
                    linear=first(last(own, "linear"), 1.0),
                    quadratic=first(last(own, "quadratic"), 0.0),
                    norm=first(last(own, "norm"), scale),
                ),
                excluded=(case.load_case, response) in dropped,
                hold=first(last(own, "hold"), True),
            )


def reached(axle: Axle, case: CaseCurves) -> NDArray[np.bool_]:
    """(n,) measured inputs that the model's sweep reaches; none where it sweeps another quantity."""
    ours = axle.load_cases.get(case.load_case)
    if ours is None or ours.unit != case.input_unit:
        return np.zeros(case.input.size, dtype=bool)
    inputs = ours.inputs()
    slack = 1e-9 * np.abs(inputs).max()
    return np.asarray((case.input >= inputs.min() - slack) & (case.input <= inputs.max() + slack))


def last(options: Sequence[CharacteristicOptions] | Sequence[CurveOptions], key: str) -> Any:
    """The last given value of a key, None when no entry gives it."""
    values = [getattr(o, key) for o in options if getattr(o, key) is not None]
    return values[-1] if values else None


def first(value: Any, default: Any) -> Any:
    """The value, or the default in place of None."""
    return default if value is None else value
