"""Fits brought to their own optimum, before anything is read off them or compared with them."""

from __future__ import annotations

from collections.abc import Sequence

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, refit_to_errors
from doe_kc.discovery.workers import DiscoveryWorkers


def fit_to_errors(current: Fit, likelihood: Likelihood, workers: DiscoveryWorkers) -> Fit:
    """The fit to the same records with other errors, at its optimum.

    A linear hub that softens by 14 % under load was left 1190 of cost above it, and a steering friction
    beside it 1 standard deviation off. Laws compared with such a fit are better than it is, each in turn.
    """
    return fits_to_errors(current, [likelihood], workers)[0]


def fits_to_errors(current: Fit, likelihoods: Sequence[Likelihood], workers: DiscoveryWorkers) -> list[Fit]:
    """`fit_to_errors` of several errors, the same fit where those are the same object."""
    return at_optima(fits_near(current, likelihoods), workers)


def fits_near(current: Fit, likelihoods: Sequence[Likelihood]) -> list[Fit]:
    """The fit to several other errors by the derivatives that it has, the same fit where those are the same
    object."""
    unlike = {id(likelihood): likelihood for likelihood in likelihoods}
    near = {key: refit_to_errors(current, likelihood) for key, likelihood in unlike.items()}
    return [near[id(likelihood)] for likelihood in likelihoods]


def at_optima(fits: Sequence[Fit], workers: DiscoveryWorkers) -> list[Fit]:
    """Fits, those gone on with new derivatives which known ones led to no end; each object once."""
    open_ends = {id(fit): fit for fit in fits if not fit.converged}
    starts = [FitStart(fit.model, fit.z, fit) for fit in open_ends.values()]
    refits = zip(open_ends, workers.fits(starts, "settling"), strict=True)
    ends = {key: refit for key, refit in refits if refit is not None}
    return [ends.get(id(fit), fit) for fit in fits]


def at_optimum(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit, gone on with new derivatives where known ones led to no end."""
    return at_optima([current], workers)[0]


def converged_fit(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit at its own optimum, on derivatives taken there.

    What parameters hide almost wholly shows by what is left between two large columns, which derivatives of
    a model nearby do not give.
    """
    (refit,) = workers.fits([FitStart(current.model, current.z, current)], "settling")
    return refit or current


def both_optima(current: Fit, own: Likelihood, workers: DiscoveryWorkers) -> tuple[Fit, Fit]:
    """A fit to wider errors than the records' own, and the fit to those, each at its optimum.

    Wider errors make the cost of every point less. A fit to them that costs more than the other one is at a
    local optimum: a free play's contact makes the cost rough, and 354 above it a trace of friction cost 143
    of ln evidence and a load case held out was missed.
    """
    exact = fit_to_errors(current, own, workers)
    if current.cost > exact.cost:
        current = fit_to_errors(exact, current.model.likelihood, workers)
    return current, exact
