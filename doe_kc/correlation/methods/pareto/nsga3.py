"""NSGA-III of pymoo, silenced and typed: asked and told here, seeded, nothing printed.

Reference: K. Deb, H. Jain, An evolutionary many-objective optimization algorithm using reference-point-based
nondominated sorting, IEEE Trans. Evol. Comput. 18(4), 2014; J. Blank, K. Deb, pymoo, IEEE Access 8, 2020.
"""

from __future__ import annotations

from collections.abc import Callable
from math import comb

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

Judge = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Objectives (p, g), to be minimized, and violation (p,), 0 when feasible, of points (p, d)."""
OUTER_DIRECTIONS = 130
"""Reference directions of the outer layer, and so about the size of the population."""
INNER_FROM = 6
"""Objectives from which a second, inner layer is needed (Deb & Jain, section IV)."""


def reference_directions(count: int) -> FloatArray:
    """(r, count) evenly spread directions: Das & Dennis's lattice, from six objectives on in two layers."""
    from pymoo.util.ref_dirs import get_reference_directions

    parts = 2
    while comb(count + parts, parts + 1) <= OUTER_DIRECTIONS:
        parts += 1
    outer = get_reference_directions("das-dennis", count, n_partitions=parts)
    if count < INNER_FROM:
        return np.asarray(outer)
    inner = get_reference_directions("das-dennis", count, n_partitions=parts - 1)
    return np.vstack([outer, 0.5 * inner + 0.5 / count])


def check_installed() -> None:
    """InputError with the remedy when pymoo is missing."""
    try:
        import pymoo  # noqa: F401
    except ImportError:
        raise InputError(
            'method pareto needs pymoo, which is not installed; run: pip install "doe-kc[pareto]".'
        ) from None


def nsga3(
    judge: Judge,
    first: FloatArray,
    directions: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    *,
    generations: int,
    seed: int,
) -> FloatArray:
    """(p, d) last population of a run inside the box; first: (r, d) population, a row a direction."""
    from pymoo.algorithms.moo.nsga3 import NSGA3
    from pymoo.core.evaluator import Evaluator
    from pymoo.core.problem import Problem
    from pymoo.problems.static import StaticProblem

    problem = Problem(n_var=first.shape[1], n_obj=directions.shape[1], n_ieq_constr=1, xl=lower, xu=upper)
    search = NSGA3(ref_dirs=directions, pop_size=len(directions), sampling=first)
    search.setup(problem, termination=("n_gen", generations), seed=seed, verbose=False)
    while search.has_next():
        population = search.ask()
        if population is None or not len(population):
            break
        objectives, violation = judge(np.asarray(population.get("X"), dtype=float))
        answers = StaticProblem(problem, F=objectives, G=violation[:, None])
        Evaluator().eval(answers, population)
        search.tell(infills=population)
    return np.asarray(search.pop.get("X"), dtype=float)
