"""How far a hidden effect stands out of what nobody knows of the car, and whether a rival looks the same.

Computed from the opened key with the true change of the curves: no analyser has a part in it. What nobody
knows are the variables within their priors, the differences between the sides, and the sizes of the small
effects that every car has, to first order about the car, without the effect but for the sides. A mount of the
rack changed the curves by 290 standard deviations; a column that is softer by a third and a steering friction
of 7 N in place of 12 do the same but for 3, by curves that were solved.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import qr
from scipy.special import ndtr

from benchmarks.discovery.car import Car
from benchmarks.discovery.clutter import unlike
from benchmarks.discovery.scatter import unequal_in_one
from doe_kc.axle import Axle
from doe_kc.axle.parameters import parameter_value
from doe_kc.axle.places import places_of
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.effects import EFFECTS, apply_effect, observed
from doe_kc.effects._base import reading_gains
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import curve_gradients, scaled_gradients
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.result import NotConverged
from doe_kc.solver.suite import solve
from doe_kc.variables import VariableOptions, build_space

NO_CHARACTERISTICS = np.zeros(0)
MUCH = 0.05
"""Of the sum of squares."""


@dataclass(frozen=True)
class Detectability:
    """strength: standard deviations of the change beyond what nobody knows. rival: the most similar other
    effect; wrong: chance that noise makes it the better one. shows: (load case, response) with much of it."""

    strength: float
    rival: str
    wrong: float
    shows: tuple[tuple[str, str], ...]


def detectability(nominal: Axle, car: Car, likelihood: Likelihood) -> dict[str, Detectability]:
    """Hidden effect -> its standing. likelihood: of the records, for their noise."""
    axle = _as_read(car)
    full = _residual(axle, likelihood)
    sides = [_residual(unequal, likelihood) - full for unequal in unequal_in_one(axle)]
    rivals, out = _rivals(nominal, likelihood), {}
    for hidden in car.hidden:
        without = replace(car, hidden=tuple(h for h in car.hidden if h is not hidden))
        basis = _unknown(nominal, without, likelihood, sides)
        change = full - _residual(_as_read(without), likelihood)
        left = _beyond(change, basis)
        others = {ident: changes for ident, changes in rivals.items() if ident != hidden.id}
        out[hidden.id] = _against_rivals(left, others, likelihood, basis)
    return out


def _as_read(car: Car) -> Axle:
    """The true axle, with those of its effects that are the rig's."""
    axle = car.true_axle()
    for hidden in car.hidden:
        if EFFECTS[hidden.id].on_rig:
            axle = apply_effect(axle, hidden.id, hidden.options, source="hidden")
    return axle


def _residual(axle: Axle, likelihood: Likelihood) -> FloatArray:
    return likelihood.residual(observed(axle, curve_set(solve(axle))), NO_CHARACTERISTICS)


def _unknown(nominal: Axle, car: Car, likelihood: Likelihood, sides: Sequence[FloatArray]) -> FloatArray:
    """(M + d, d) orthonormal basis of what is not known of a car: what the variables can do within their
    priors, sides that are unequal, and small effects of other sizes. sides: change by each difference."""
    space = build_space(nominal, VariableOptions(), "detectability")
    held = {path for e in EFFECTS.values() for path in e.replaces}
    free = [v for v in space.variables if v.path not in held]
    slopes = [v.slope(v.place(parameter_value(car.axle, v.path))) * v.prior_sd for v in free]
    axle = _as_read(car)
    solution = solve(axle)
    gradients = curve_gradients(axle, solution, [v.path for v in free])
    gradients = scaled_gradients(gradients, reading_gains(axle))
    rows = likelihood.jacobian(gradients, np.zeros((0, len(free)))) * np.array(slopes)
    blank = likelihood.residual(observed(axle, curve_set(solution)), NO_CHARACTERISTICS)
    small = [_residual(_as_read(other), likelihood) - blank for other in _of_other_sizes(car)]
    columns = np.column_stack([rows, *sides, *small])
    basis, _ = qr(np.vstack([columns, np.eye(columns.shape[1])]), mode="economic")
    return np.asarray(basis)


def _of_other_sizes(car: Car) -> list[Car]:
    """The car with each small effect by itself of another size or travel."""
    return [
        replace(car, clutter=tuple(other if c is small else c for c in car.clutter))
        for small in car.clutter
        for other in unlike(small)
    ]


def _beyond(change: FloatArray, basis: FloatArray) -> FloatArray:
    padded = np.concatenate([change, np.zeros(basis.shape[1])])
    return np.asarray(padded - basis @ (basis.T @ padded))


def _rivals(nominal: Axle, likelihood: Likelihood) -> dict[str, list[list[FloatArray]]]:
    """Effect -> for each of its places the changes by its sizes."""
    blank = _residual(nominal, likelihood)
    places = places_of(nominal)
    out: dict[str, list[list[FloatArray]]] = {}
    for effect in EFFECTS.values():
        for hypothesis in effect.hypotheses(places) if effect.possible(places) else ():
            sizes = [s for s in hypothesis.sizes if not s.shape]
            changes = []
            for chosen in [s.name for s in sizes] or [""]:
                at = {s.name: float(s.name == chosen) for s in hypothesis.sizes}
                try:
                    axle = apply_effect(nominal, effect.id, hypothesis.options(at), source=effect.id)
                    changes.append(_residual(axle, likelihood) - blank)
                except NotConverged:
                    continue
            out.setdefault(effect.id, []).append(changes)
    return out


def _against_rivals(
    left: FloatArray,
    rivals: Mapping[str, Sequence[Sequence[FloatArray]]],
    likelihood: Likelihood,
    basis: FloatArray,
) -> Detectability:
    strength = float(np.linalg.norm(left))
    rival, closest = "", 0.0
    for ident, of_places in rivals.items():
        for changes in of_places:
            alike = _explained(left, [_beyond(change, basis) for change in changes])
            if alike > closest:
                rival, closest = ident, alike
    return Detectability(strength, rival, wrong_name(strength, closest), _shows(left, likelihood))


def _shows(left: FloatArray, likelihood: Likelihood) -> tuple[tuple[str, str], ...]:
    """Load cases and responses that hold MUCH of the change, the largest first; both wheels and branches."""
    parts: dict[tuple[str, str], float] = {}
    for curve, rows in likelihood.slices():
        place = (curve.load_case, curve.response)
        parts[place] = parts.get(place, 0.0) + float(np.sum(left[rows] ** 2))
    enough = MUCH * sum(parts.values())
    return tuple(sorted((p for p, v in parts.items() if v > enough), key=lambda p: -parts[p]))


def _explained(left: FloatArray, columns: Sequence[FloatArray]) -> float:
    """|cosine| between a change and the nearest one of a rival's sizes."""
    length = float(np.linalg.norm(left))
    stacked = [c for c in columns if np.linalg.norm(c) > 1e-6]
    if not stacked or not length:
        return 0.0
    orthonormal, _ = qr(np.array(stacked).T, mode="economic")
    return float(np.linalg.norm(orthonormal.T @ left)) / length


def wrong_name(strength: float, correlation: float) -> float:
    """Chance that a rival of given |correlation| fits better than the true effect, both of one size."""
    apart = strength * math.sqrt(max(0.0, (1.0 - correlation) / 2.0))
    along = strength * math.sqrt((1.0 + correlation) / 2.0)
    return float(ndtr(-apart) * ndtr(along) + ndtr(apart) * ndtr(-along))
