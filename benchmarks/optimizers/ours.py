"""The product's own methods and SMT's, through the loop that every study uses."""

from __future__ import annotations

from optimizers.counting import CountingSolver
from optimizers.peer import Peer, Search
from optimizers.smt_ego import SmtEgo

from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import METHODS, Method, MethodSettings
from doe_kc.correlation.options import Gradients

BUDGET = 100


def own(name: str, *, gradients: Gradients = "auto") -> Search:
    """A registered method with its default settings."""

    def search(solver: CountingSolver, seed: int) -> str:
        settings = MethodSettings(seed=seed, budget=solver.budget, gradients=gradients)
        return _run(METHODS[name](solver.problem, settings), solver)

    return search


def smt(solver: CountingSolver, seed: int) -> str:
    """The scalar peer, through the same loop."""
    return _run(SmtEgo(solver.problem, MethodSettings(seed=seed, budget=solver.budget)), solver)


def _run(method: Method, solver: CountingSolver) -> str:
    return run_method(solver.problem, method, solver.evaluate, budget=solver.budget).stopped


PEERS = (
    Peer("ego", "ego", "outputs and slopes", own("ego"), BUDGET, ours=True),
    Peer(
        "ego_values",
        "ego, gradients=false",
        "outputs",
        own("ego", gradients=False),
        BUDGET,
        ours=True,
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
    Peer("pareto", "pareto", "outputs", own("pareto"), BUDGET, ours=True, needs="pymoo"),
    Peer("hybrid", "hybrid", "outputs", own("hybrid"), BUDGET, ours=True),
    Peer("smt_ego", "SMT EGO (KPLS)", "rating", smt, 45, needs="smt", seeds=1),
)
