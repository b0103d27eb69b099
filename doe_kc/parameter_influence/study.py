"""Runs the influence study: one parameter at a time by the true solver, and exact sensitivities beside."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import Parameter, design_parameters
from doe_kc.campaign.runner import Campaign
from doe_kc.characteristics import CHARACTERISTICS, Characteristic, appendix_c
from doe_kc.ground.errors import RunError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.result import Influence
from doe_kc.sampling.one_at_a_time import one_at_a_time
from doe_kc.solver.characteristic_gradient import characteristic_gradients
from doe_kc.solver.suite import solve
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.own import AxleSolver


@one_thread()
def influence_study(
    axle: Axle,
    parameters: Sequence[Parameter] | None = None,
    characteristics: Sequence[Characteristic] | None = None,
    *,
    workers: int | None = None,
    windows: Mapping[str, float] | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> Influence:
    """Central one-at-a-time runs of +-1 mm and +-10 % and exact sensitivities of the nominal axle.

    parameters: all design parameters by default; characteristics: the 21 columns of Appendix C. An axle
    without equilibrium leaves nan and its reason in `failures`. RunError when the nominal axle has none.
    """
    started = time.perf_counter()
    rows = list(parameters) if parameters is not None else design_parameters(axle)
    columns = list(characteristics) if characteristics is not None else appendix_c()
    with Campaign(AxleSolver(axle, dict(windows or {}), curves=False), workers=workers) as campaign:
        designs = list(one_at_a_time(rows).rows())
        outcomes = campaign.evaluate(designs, "influence", progress, curves=False)
    if outcomes[0].failed:
        raise RunError(f"the nominal axle cannot be solved: {outcomes[0].reason}")
    index = [list(CHARACTERISTICS).index(c.id) for c in columns]
    values = np.array([o.characteristics[index] for o in outcomes])
    plus, minus = values[1::2], values[2::2].copy()
    for i, parameter in enumerate(rows):
        if parameter.one_sided:  # so that (plus - minus) / 2 is the whole one-sided change
            minus[i] = 2.0 * values[0] - plus[i]
    return Influence(
        parameters=tuple(rows),
        characteristics=tuple(columns),
        baseline=values[0],
        plus=plus,
        minus=minus,
        exact=exact_changes(axle, rows, columns, windows),
        seconds=time.perf_counter() - started,
        failures=_failures(rows, outcomes),
    )


def exact_changes(
    axle: Axle,
    rows: Sequence[Parameter],
    columns: Sequence[Characteristic],
    windows: Mapping[str, float] | None = None,
) -> FloatArray:
    """(parameters, characteristics) exact derivative times the parameter's step."""
    paths = [p.path for p in rows]
    gradients = characteristic_gradients(axle, solve(axle), paths, columns, windows=windows).T
    return np.asarray(gradients * np.array([p.step for p in rows])[:, None])


def _failures(rows: Sequence[Parameter], outcomes: Sequence[Outcome]) -> dict[str, str]:
    out = {}
    for i, parameter in enumerate(rows):
        reasons = [o.reason for o in outcomes[1 + 2 * i : 3 + 2 * i] if o.failed]
        if reasons:
            out[parameter.path] = reasons[0]
    return out
