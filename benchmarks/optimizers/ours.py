"""The product's own methods and SMT's, through the loop that every study uses."""

from __future__ import annotations

from dataclasses import replace

from optimizers.counting import CountingSolver
from optimizers.peer import Peer, Search
from optimizers.smt_ego import SmtEgo

from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import METHODS, Method, MethodSettings
from doe_kc.correlation.options import Gradients
from doe_kc.correlation.problem import Problem

BUDGET = 100


def own(name: str, *, gradients: Gradients = "auto", continuous: bool = False) -> Search:
    """A registered method with its default settings; continuous: without the variables' levels."""

    def search(solver: CountingSolver, seed: int) -> str:
        settings = MethodSettings(seed=seed, budget=solver.budget, gradients=gradients)
        problem = _without_levels(solver.problem) if continuous else solver.problem
        return _run(METHODS[name](problem, settings), solver, problem)

    return search


def smt(solver: CountingSolver, seed: int) -> str:
    """The scalar peer, through the same loop."""
    return _run(
        SmtEgo(solver.problem, MethodSettings(seed=seed, budget=solver.budget)), solver, solver.problem
    )


def _run(method: Method, solver: CountingSolver, problem: Problem) -> str:
    return run_method(problem, method, solver.evaluate, budget=solver.budget).stopped


def _without_levels(problem: Problem) -> Problem:
    free = tuple(replace(v, levels=None) for v in problem.space.variables)
    return replace(problem, space=replace(problem.space, variables=free))


PEERS = (
    Peer("ego", "ego", "outputs and slopes", own("ego"), BUDGET, ours=True, levels=True),
    Peer(
        "ego_values",
        "ego, gradients=false",
        "outputs",
        own("ego", gradients=False),
        BUDGET,
        ours=True,
        levels=True,
    ),
    Peer(
        "gauss_newton",
        "gauss_newton",
        "outputs and slopes",
        own("gauss_newton"),
        BUDGET,
        ours=True,
        seeds=1,
    ),
    Peer(
        "ego_continuous",
        "ego, gradients=false, continuous variables",
        "outputs",
        own("ego", gradients=False, continuous=True),
        50,
        ours=True,
    ),
    Peer("pareto", "pareto", "outputs", own("pareto"), BUDGET, ours=True, needs="pymoo"),
    Peer("hybrid", "hybrid", "outputs", own("hybrid"), BUDGET, ours=True),
    Peer("smt_ego", "SMT EGO (KPLS)", "rating", smt, 45, needs="smt", seeds=1),
)
