"""The product's own methods, through the loop that every study uses."""

from __future__ import annotations

from optimizers.counting import CountingSolver
from optimizers.peer import Peer, Search

from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import METHODS, Settings

BUDGET = 100


def own(name: str, *, gradients: bool = False) -> Search:
    """A registered method with its default settings."""

    def search(solver: CountingSolver, seed: int) -> str:
        settings = Settings(seed=seed, budget=solver.budget, gradients=gradients)
        method = METHODS[name](solver.problem, settings)
        return run_method(solver.problem, method, solver.evaluate, budget=solver.budget).stopped

    return search


PEERS = (
    Peer("ego", "ego", "outputs", own("ego"), BUDGET, ours=True),
    Peer(
        "ego_gradients",
        "ego, gradients=True",
        "outputs and slopes",
        own("ego", gradients=True),
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
    Peer("smt_ego", "SMT EGO (KPLS)", "rating", own("smt_ego"), 300, needs="smt", seeds=1, seconds=600.0),
)
