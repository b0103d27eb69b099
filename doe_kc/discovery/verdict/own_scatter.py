"""How far one car's parameters and one rig's calibrations scatter, estimated from the car's own records.

The bounds of a study say how far a car may be off its file, not how far this one is. What the records show
of dozens of parameters says that too: the scatter of each group is a number of its own, of log-normal prior
about what the bounds leave, and the most probable one is what sizes of effects are estimated with (empirical
Bayes: D. J. C. MacKay, Neural Computation 4, 1992). Its maximum is found by expectation and maximization
(A. P. Dempster, N. M. Laird, D. B. Rubin, Journal of the Royal Statistical Society B 39, 1977): the mean
square s^2 of a group's unknowns, each in its assumed standard deviation, is that of their posterior means and
variances under s.

Sets of effects are compared under what was assumed, the same for all.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.gauss_newton import chord_fit
from doe_kc.discovery.nuisances import sided_variables
from doe_kc.discovery.thresholds import SCATTER_LOG_SD
from doe_kc.ground.typing import FloatArray

MAXIMIZATION_STEPS = 100
"""A guard: 10 to 30 are enough."""
SETTLED = 1e-3
"""Relative change of a scatter below which it is found."""
MADE = ("HARDPOINTS", "BUSHINGS")
"""Groups of parameters that scatter as parts are made; others are set or chosen."""


@dataclass(frozen=True)
class UnknownGroup:
    """Unknowns of a fit that scatter alike."""

    name: str
    """What they are."""
    places: NDArray[np.int_]
    """(n,) places in z."""


def unknown_groups(fit: Fit) -> list[UnknownGroup]:
    """Hardpoints and bushings whose bounds are a guess, calibrations of the rig's inputs, and differences
    between the sides, of hardpoints, of bushings and of the rest; those without any left out.

    A variable with a distribution of its own is one that somebody has measured. What differs between the
    sides comes of welding, of a batch of rubber, of setting: three processes.
    """
    model, known = fit.model, fit.model.nuisances
    places: dict[str, list[int]] = {}
    for i, variable in enumerate(model.space.variables):
        if variable.parameter.group in MADE and variable.is_guess:
            places.setdefault(variable.parameter.group.lower(), []).append(i)
    places["calibrations"] = list(range(*model.calibrations.indices(model.dimension)))
    sided = sided_variables(model.axle, model.space) if known is not None and known.sides else ()
    for i, variable in enumerate(sided, model.linear.start):
        group = variable.parameter.group
        kind = group.lower() if group in MADE else "settings"
        places.setdefault(f"{kind} between the sides", []).append(i)
    return [UnknownGroup(name, np.array(own)) for name, own in places.items() if own]


def most_probable_scatter(fit: Fit) -> FloatArray:
    """(d + m,) of every unknown of a fit, over what was assumed before the records; 1 of those in no group.

    From the quadratic through the fit's point; what a bound holds back stays there.
    """
    model, free = fit.model, ~fit.held
    precision = model.prior_sd**-2.0
    from_centre = fit.z - model.centre
    curvature = fit.hessian - np.diag(precision)
    pull = curvature @ from_centre - (fit.gradient - precision * from_centre)
    pull = pull[free] - curvature[np.ix_(free, ~free)] @ from_centre[~free]
    curvature = curvature[np.ix_(free, free)]
    groups, out = unknown_groups(fit), np.ones(fit.z.size)
    for _ in range(MAXIMIZATION_STEPS):
        scattered = curvature + np.diag((precision * out**-2.0)[free])
        covariance = cho_solve(cho_factor(scattered), np.eye(pull.size))
        squares = from_centre**2
        squares[free] = (covariance @ pull) ** 2 + np.diag(covariance)
        before = out.copy()
        for group in groups:
            own = float(np.sum((squares * precision)[group.places]))
            out[group.places] = _most_probable(own, group.places.size)
        if np.max(np.abs(out / before - 1.0)) < SETTLED:
            break
    return out


def _most_probable(square: float, count: int) -> float:
    """s with the largest -n ln s - S / (2 s^2) - (ln s / SCATTER_LOG_SD)^2 / 2, by Newton steps in ln s: it
    is concave."""
    log = 0.0
    for _ in range(MAXIMIZATION_STEPS):
        spent = square * np.exp(-2.0 * log)
        step = (spent - count - log / SCATTER_LOG_SD**2) / (2.0 * spent + SCATTER_LOG_SD**-2.0)
        log += step
        if abs(step) < SETTLED:
            break
    return float(np.exp(log))


def with_own_scatter(fit: Fit) -> Fit:
    """The fit with the scatter that its records show in place of what was assumed, as far as its derivatives
    lead."""
    model = replace(fit.model, own_scatter=tuple(most_probable_scatter(fit)[: fit.model.dimension].tolist()))
    return chord_fit(replace(fit, model=model, cost=cost_of(model, fit.z, fit.residual)), model)
