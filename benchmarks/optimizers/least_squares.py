"""Peers that see the residual vector and minimize its sum of squares."""

from __future__ import annotations

import warnings

import numpy as np
from optimizers.counting import CountingSolver
from optimizers.peer import Peer
from scipy import optimize

BUDGET = 300
STEP = 1e-4
"""Of finite differences: well above the solver's tolerance, well below the curvature."""
RADIUS = 0.1
"""First trust-region radius, the half-width of the opening sample of `ego`."""


def dfols(solver: CountingSolver, seed: int, *, directions: int | None = None) -> str:
    """DFO-LS (GPL: a benchmark only), one linear model a residual; directions: it starts with."""
    import dfols as package

    np.random.seed(seed)  # noqa: NPY002  # DFO-LS draws its directions from the global generator
    space = solver.problem.space
    options = {} if directions is None else {"growing.ndirs_initial": directions}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = package.solve(
            solver.residuals,
            space.start,
            bounds=(np.zeros(space.dimension), np.ones(space.dimension)),
            maxfun=10 * solver.budget,
            rhobeg=RADIUS,
            rhoend=1e-6,
            user_params={"init.random_initial_directions": True, **options},
        )
    return str(found.msg)


def growing(solver: CountingSolver, seed: int) -> str:
    """DFO-LS that begins with five directions and adds one an iteration."""
    return dfols(solver, seed, directions=5)


def finite_differences(solver: CountingSolver, seed: int) -> str:
    """scipy's trust-region least squares; the seed has no say."""
    del seed
    found = optimize.least_squares(
        solver.residuals,
        solver.problem.space.start,
        bounds=(0.0, 1.0),
        diff_step=STEP,
        method="trf",
        ftol=1e-12,
        xtol=1e-12,
        gtol=1e-12,
    )
    return str(found.message)


PEERS = (
    Peer("dfols", "DFO-LS", "outputs", dfols, BUDGET, needs="dfols", package="DFO-LS"),
    Peer(
        "dfols_growing",
        "DFO-LS, 5 first directions",
        "outputs",
        growing,
        BUDGET,
        needs="dfols",
        package="DFO-LS",
    ),
    Peer(
        "least_squares",
        "scipy least_squares, finite differences",
        "outputs",
        finite_differences,
        BUDGET,
        needs="scipy",
        seeds=1,
    ),
)
