"""Peers that see the rating alone, or objectives summed by load case (NSGA-II)."""

from __future__ import annotations

import warnings

import numpy as np
from optimizers.counting import FAILED, CountingSolver
from optimizers.peer import Peer
from scipy import optimize
from scipy.stats import qmc

from doe_kc.correlation.front import objectives
from doe_kc.ground.typing import FloatArray

BUDGET = 300
LONG = 1000
"""Of the cheapest method that may get there in the end."""
RADIUS = 0.1
POPULATION = 30


def population(solver: CountingSolver, seed: int) -> FloatArray:
    """(30, d) Latin hypercube over the whole bounds with the start as its first member."""
    d = solver.problem.space.dimension
    points = qmc.LatinHypercube(d, rng=np.random.default_rng(seed)).random(POPULATION)
    points[0] = solver.problem.space.start
    return np.asarray(points)


def cma_es(solver: CountingSolver, seed: int) -> str:
    """CMA-ES about the start."""
    import cma

    options = {"bounds": [0.0, 1.0], "seed": seed + 1, "verbose": -9, "maxfevals": 10 * solver.budget}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = cma.fmin2(solver.loss, solver.problem.space.start, RADIUS, options)
    return str(found[1].stop())


def differential_evolution(solver: CountingSolver, seed: int) -> str:
    """scipy's, best1bin, 30 members."""
    found = optimize.differential_evolution(
        solver.loss,
        [(0.0, 1.0)] * solver.problem.space.dimension,
        init=population(solver, seed),
        rng=seed,
        polish=False,
        maxiter=10000,
        tol=0.0,
    )
    return str(found.message)


def cobyqa(solver: CountingSolver, seed: int) -> str:
    """Quadratic models of the rating; the seed has no say."""
    del seed
    found = optimize.minimize(
        solver.loss,
        solver.problem.space.start,
        method="COBYQA",
        bounds=[(0.0, 1.0)] * solver.problem.space.dimension,
        options={"maxfev": 10 * solver.budget, "initial_tr_radius": RADIUS, "final_tr_radius": 1e-6},
    )
    return str(found.message)


def nsga2(solver: CountingSolver, seed: int) -> str:
    """pymoo's, 30 members, an objective a load case, violations as a constraint."""
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.core.problem import ElementwiseProblem
    from pymoo.optimize import minimize

    by_case = objectives(solver.problem.targets)
    names = len(by_case.names)

    class ByLoadCase(ElementwiseProblem):  # type: ignore[misc]
        def __init__(self) -> None:
            super().__init__(
                n_var=solver.problem.space.dimension, n_obj=names, n_ieq_constr=1, xl=0.0, xu=1.0
            )

        def _evaluate(self, x: FloatArray, out: dict[str, object], *_: object, **__: object) -> None:
            found = solver.at(x)
            if found.rating is None:
                out["F"], out["G"] = np.full(names, -FAILED * solver.baseline.merit), 1e6
                return
            out["F"], out["G"] = by_case.values(found.rating), -found.rating.constraints.sum()

    algorithm = NSGA2(pop_size=POPULATION, sampling=population(solver, seed))
    minimize(ByLoadCase(), algorithm, ("n_eval", 10 * solver.budget), seed=seed)
    return ""


def tpe(solver: CountingSolver, seed: int) -> str:
    """Optuna's tree-structured Parzen estimator, multivariate."""
    import optuna

    return _optuna(solver, optuna.samplers.TPESampler(seed=seed, multivariate=True))


def gp_sampler(solver: CountingSolver, seed: int) -> str:
    """Optuna's Gaussian process of the rating."""
    import optuna

    return _optuna(solver, optuna.samplers.GPSampler(seed=seed))


def _optuna(solver: CountingSolver, sampler: object) -> str:
    import optuna

    optuna.logging.set_verbosity(optuna.logging.ERROR)
    names = solver.problem.space.paths
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        study = optuna.create_study(sampler=sampler)  # type: ignore[arg-type]
        study.enqueue_trial(dict(zip(names, solver.problem.space.start, strict=True)))

        def objective(trial: optuna.Trial) -> float:
            return solver.loss(np.array([trial.suggest_float(name, 0.0, 1.0) for name in names]))

        study.optimize(objective, n_trials=10 * solver.budget)
    return ""


def uniform(solver: CountingSolver, seed: int) -> str:
    """Uniform over the bounds."""
    rng = np.random.default_rng(seed)
    while True:
        solver.loss(rng.random(solver.problem.space.dimension))


def hypercube(solver: CountingSolver, seed: int) -> str:
    """One Latin hypercube of the whole budget."""
    sampler = qmc.LatinHypercube(solver.problem.space.dimension, rng=np.random.default_rng(seed))
    for point in sampler.random(solver.budget):
        solver.loss(point)
    return ""


PEERS = (
    Peer("cma", "CMA-ES", "rating", cma_es, LONG, needs="cma"),
    Peer("cobyqa", "COBYQA", "rating", cobyqa, BUDGET, needs="cobyqa", package="cobyqa", seeds=1),
    Peer("de", "differential evolution", "rating", differential_evolution, BUDGET, needs="scipy"),
    Peer("nsga2", "NSGA-II (pymoo)", "rating", nsga2, BUDGET, needs="pymoo"),
    Peer("tpe", "Optuna TPE", "rating", tpe, BUDGET, needs="optuna"),
    Peer(
        "optuna_gp", "Optuna GPSampler", "rating", gp_sampler, BUDGET, needs="optuna", seeds=1, seconds=240.0
    ),
    Peer("random", "random", "rating", uniform, BUDGET),
    Peer("lhs", "Latin hypercube", "rating", hypercube, BUDGET),
)
