"""BoTorch inside a trust region: Gaussian processes of all outputs with the rating composed on them
(the residual-aware peer), or of the rating alone. Same region, kernel, acquisition and opening sample.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from optimizers.composed import Composed, outputs_of
from optimizers.counting import CountingSolver
from optimizers.peer import Peer

from doe_kc.correlation.methods.ego.method import OPENING
from doe_kc.correlation.problem import Evaluated
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Targets

SAMPLES, STARTS, RAW = 64, 4, 128
NOISE = 1e-6
"""Of the standardised outputs: the solver has none."""
FIRST_FIT, LATER_FITS = 150, 30
"""Iterations of the likelihood's maximization, later ones from the last kernel."""


@dataclass(frozen=True)
class Region:
    """Half-width about the best design; grows after two gains in a row, shrinks after three failures."""

    half: float = 0.2
    wins: int = 0
    losses: int = 0

    def after(self, *, won: bool) -> Region:
        """TuRBO's rule, restarted when it has shrunk to nothing."""
        wins, losses = (self.wins + 1, 0) if won else (0, self.losses + 1)
        if wins == 2:
            return Region(min(0.5, 1.6 * self.half))
        if losses == 3:
            return Region(0.5 * self.half if self.half > 0.01 else 0.2)
        return replace(self, wins=wins, losses=losses)


def composite(solver: CountingSolver, seed: int) -> str:
    """Every active characteristic and curve score modelled, expected improvement of the rating on them."""
    return _search(solver, seed, composed=True)


def scalar(solver: CountingSolver, seed: int) -> str:
    """-log(-rating) modelled: the rating itself spans three decades."""
    return _search(solver, seed, composed=False)


def _search(solver: CountingSolver, seed: int, *, composed: bool) -> str:
    import torch

    torch.manual_seed(seed)
    torch.set_num_threads(1)
    space = solver.problem.space
    sample = OPENING.sample(space, OPENING.size(space), seed)
    known = [solver.baseline, *(solver.at(c.point) for c in sample)]
    region, state = Region(), None
    while True:
        best = max(known, key=lambda e: e.merit)
        x = np.array([e.point for e in known])
        y, objective = _modelled(solver.problem.targets, known, composed=composed)
        model, state = _fitted(x, y, state)
        low, high = np.maximum(best.point - region.half, 0.0), np.minimum(best.point + region.half, 1.0)
        point = _proposed(model, objective, best.point, np.array([low, high]), seed + len(known))
        new = solver.at(point)
        region = region.after(won=new.merit > best.merit + 1e-3 * abs(best.merit))
        if new.rating is not None and not any(np.array_equal(new.point, e.point) for e in known):
            known.append(new)


def _modelled(
    targets: Targets, known: list[Evaluated], *, composed: bool
) -> tuple[FloatArray, Composed | None]:
    if not composed:
        return -np.log([[-e.merit] for e in known]), None
    return outputs_of(targets, known)


def _fitted(x: FloatArray, y: FloatArray, state: dict[str, Any] | None) -> tuple[Any, dict[str, Any]]:
    """Independent ARD processes of all outputs, fitted in one batch; unlike a list of models, seconds."""
    import torch
    from botorch.fit import fit_gpytorch_mll
    from botorch.models import SingleTaskGP
    from botorch.models.transforms import Standardize
    from gpytorch.mlls import ExactMarginalLogLikelihood

    targets = torch.as_tensor(y)
    noise = NOISE * targets.var(dim=0, keepdim=True).clamp_min(1e-16).expand_as(targets)
    model = SingleTaskGP(
        torch.as_tensor(x), targets, train_Yvar=noise, outcome_transform=Standardize(y.shape[1])
    )
    kernel = model.covar_module
    iterations = FIRST_FIT
    if state is not None and all(state[k].shape == v.shape for k, v in kernel.state_dict().items()):
        kernel.load_state_dict(state)
        iterations = LATER_FITS
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fit_gpytorch_mll(
            ExactMarginalLogLikelihood(model.likelihood, model),
            optimizer_kwargs={"options": {"maxiter": iterations}},
            max_attempts=1,
            warning_handler=lambda _: True,
        )
    return model, kernel.state_dict()


def _proposed(
    model: Any, objective: Composed | None, best: FloatArray, box: FloatArray, seed: int
) -> FloatArray:
    import torch
    from botorch.acquisition import qLogExpectedImprovement
    from botorch.acquisition.objective import GenericMCObjective
    from botorch.optim import optimize_acqf
    from botorch.sampling import SobolQMCNormalSampler

    known = torch.as_tensor(best)[None]
    goal = None if objective is None else GenericMCObjective(lambda y, X=None: objective(y))
    with torch.no_grad():
        mean = model.posterior(known).mean
        incumbent = mean.squeeze() if goal is None else goal(mean).squeeze()
    acquisition = qLogExpectedImprovement(
        model,
        best_f=incumbent,
        sampler=SobolQMCNormalSampler(torch.Size([SAMPLES]), seed=seed),
        objective=goal,
    )
    rng = np.random.default_rng(seed)
    spread = 10.0 ** rng.uniform(-2.0, 0.0, (RAW, 1)) * rng.uniform(-1.0, 1.0, (RAW, best.size))
    raw = np.clip(best + spread * (box[1] - box[0]) / 2.0, box[0], box[1])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with torch.no_grad():
            worth = acquisition(torch.as_tensor(raw)[:, None])
        starts = torch.as_tensor(raw)[worth.topk(STARTS).indices][:, None]
        found, _ = optimize_acqf(
            acquisition,
            bounds=torch.as_tensor(box),
            q=1,
            num_restarts=STARTS,
            batch_initial_conditions=starts,
            options={"maxiter": 100},
        )
    return np.asarray(found.squeeze(0).numpy())


PEERS = (
    Peer("botorch_composite", "BoTorch composite", "outputs", composite, 50, needs="botorch"),
    Peer("botorch_scalar", "BoTorch, GP of the rating", "rating", scalar, 150, needs="botorch", seeds=3),
)
