"""What a correlation says of its variables beside effects that were found in the same records."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from doe_kc.correlation.posterior import posterior
from doe_kc.correlation.problem import Candidate
from doe_kc.effects import EFFECTS
from doe_kc.solver.curve_gradient import gradients_of
from doe_kc.solver.sensitivity import sensitivities
from doe_kc.solver.suite import solve
from doe_kc.true_solver.own import AxleSolver
from doe_kc.workflow.adopt import adopt
from doe_kc.workflow.correlate import expansion_at, posterior_at
from doe_kc.workflow.correlation_problem import correlation_space, study_problem
from tests.discovery.cases import discovery
from tests.workflow.chain_cases import reduced, study


def test_the_sizes_of_effects_that_were_found_are_as_open_as_the_variables(tmp_path: Path) -> None:
    """Their derivatives against the exact sensitivities to the two stiffnesses of a hub."""
    plain, records = study(tmp_path), reduced("named")
    adoption = adopt(plain, discovery("named"))
    space = correlation_space(plain, records, adoption)
    problem = study_problem(plain, records, space=space, adoption=adoption)
    solver = AxleSolver(problem.axle, problem.windows)
    design = problem.judged(0, Candidate(space.start, "baseline"), solver.evaluate({}))
    expansion = expansion_at(problem, design)
    assert expansion is not None and design.outcome.curves is not None
    seen = posterior_at(problem, expansion, design, adoption.size_steps)
    held = posterior_at(problem, expansion, design)

    axle, likelihood = problem.axle, problem.likelihood
    solution = solve(axle)
    paths = ["hub.camber", "hub.toe"]
    exact = gradients_of(solution, sensitivities(axle, solution, paths))
    per_value = likelihood.jacobian(exact, np.zeros((design.outcome.characteristics.size, 2)))
    (hypothesis,) = EFFECTS["hub_compliance"].hypotheses()
    stiffness = np.array([axle.values[f"{path}@L"] for path in paths])
    found = np.array([axle.effects["hub_compliance"][s.key] for s in hypothesis.sizes])
    typical = np.array([s.typical for s in hypothesis.sizes])
    slopes = per_value * -stiffness * found / typical  # the amplitude is typical / value
    expected = posterior(
        likelihood.jacobian(expansion.curves, expansion.characteristics),
        space.prior_sd,
        residual=likelihood.residual(design.outcome.curves, design.outcome.characteristics),
        point=space.start,
        start=space.start,
        nuisance=slopes,
    )
    assert seen is not None and held is not None
    np.testing.assert_allclose(seen.sd, expected.sd, rtol=1e-3)
    np.testing.assert_allclose(seen.offset, expected.offset, atol=1e-3 * float(seen.sd.max()))
    assert (seen.sd >= held.sd * (1 - 1e-9)).all() and (seen.sd / held.sd).max() > 1.05
