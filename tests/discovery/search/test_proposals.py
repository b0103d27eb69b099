"""Proposals of sets: the evidence of the closed form, and the true pair among many columns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.proposals import LinearSets
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.effects.hypothesis import Hypothesis, Size
from tests.discovery.cases import model

ROWS = 60
SIGNED = (Size("a", 1.0, "-", signed=True),)


def hypotheses(count: int) -> list[Hypothesis]:
    return [Hypothesis("left_right_asymmetry", f"P{i}_L", SIGNED) for i in range(count)]


def tuned(data: np.ndarray, rng: np.random.Generator) -> Fit:
    """A linear fit of the small model's parameters to records of white noise."""
    nominal = model("named")
    jacobian = rng.standard_normal((ROWS, nominal.dimension))
    hessian = jacobian.T @ jacobian + np.diag(nominal.prior_sd**-2.0)
    z = nominal.centre - np.linalg.solve(hessian, jacobian.T @ data)
    residual = data + jacobian @ (z - nominal.centre)

    class Small(EffectModel):
        used = np.ones(ROWS, dtype=bool)

    small = Small(nominal.axle, nominal.space, nominal.likelihood)
    return Fit(small, z, residual, Jacobian(jacobian), cost_of(small, z, residual), 1, True)


def screened(hypothesis: Hypothesis, column: np.ndarray) -> Screened:
    one, none = np.ones(1), np.zeros(ROWS)
    return Screened(hypothesis, one, one, 0.0, column[:, None], column, none, 1.0, 0.0, one)


@pytest.fixture(scope="module")
def case() -> tuple[Fit, np.ndarray, LinearSets]:
    rng = np.random.default_rng(4)
    columns = 3.0 * rng.standard_normal((ROWS, 8))
    data = rng.standard_normal(ROWS) - columns[:, 2] + 1.5 * columns[:, 5]
    fit = tuned(data, rng)
    known = hypotheses(8)
    sets = LinearSets.of(fit, [screened(h, c) for h, c in zip(known, columns.T, strict=True)], SetPrior({}))
    return fit, columns, sets


def test_differences_of_evidence_are_those_of_the_linear_gaussian_model(
    case: tuple[Fit, np.ndarray, LinearSets],
) -> None:
    fit, columns, sets = case
    jacobian = fit.jacobian.dense
    data = fit.residual - jacobian @ (fit.z - fit.model.centre)
    base = np.eye(ROWS) + (jacobian * fit.model.prior_sd**2) @ jacobian.T

    def exact(*members: int) -> float:
        own = columns[:, members]
        return float(multivariate_normal(np.zeros(ROWS), base + own @ own.T).logpdf(data))

    def stated(*members: int) -> float:
        prior = sets.prior.log([sets.hypotheses[i] for i in members])
        return sets.evidence(frozenset(members))[0] - prior

    for members in ((2,), (2, 5), (0, 2, 5)):
        assert stated(*members) - stated() == pytest.approx(exact(*members) - exact(), abs=1e-6)


def test_the_true_pair_is_proposed_first(case: tuple[Fit, np.ndarray, LinearSets]) -> None:
    fit, _, sets = case
    first, *rest = sets.proposals()
    assert {h.location for h in first.members} == {"P2_L", "P5_L"}
    assert first.amplitudes == pytest.approx([1.0, -1.5], abs=0.3)
    assert first.gain > max(p.gain for p in rest)
    assert fit.model.members == ()


def test_an_amplitude_that_cannot_be_negative_is_held_at_nothing() -> None:
    rng = np.random.default_rng(6)
    column = 3.0 * rng.standard_normal(ROWS)
    fit = tuned(rng.standard_normal(ROWS) + column, rng)
    positive = Hypothesis("hub_compliance", None, (Size("k", 1.0, "-"),))
    sets = LinearSets.of(fit, [screened(positive, column)], SetPrior({}))
    _, amplitudes = sets.evidence(frozenset({0}))
    assert amplitudes == pytest.approx([0.0])


def test_an_effect_without_sizes_is_not_proposed_to_go(case: tuple[Fit, np.ndarray, LinearSets]) -> None:
    """Its removal changes no column, and was every step's best proposal beside a roll technique."""
    fit, columns, _ = case
    member, known = Hypothesis("roll_technique", "", ()), hypotheses(8)
    with_member = replace(fit, model=replace(fit.model, members=(member,)))
    there = [screened(h, c) for h, c in zip(known, columns.T, strict=True)]
    proposals = LinearSets.of(with_member, there, SetPrior({})).proposals()
    assert proposals
    assert all(member in p.members for p in proposals)
