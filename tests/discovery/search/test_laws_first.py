"""Laws before further effects: a friction's takes its place, a compliance's keeps it out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search import convergence
from doe_kc.discovery.search.laws_first import laws_instead, needless_beside_laws
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.thresholds import NOISE_CHANCE, PROPOSAL_GAIN
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import discovery, library
from tests.discovery.search.law_answers import CLOSED, Answers, agreeing, beside_a_hub, disagreeing


@pytest.mark.parametrize(
    ("best", "prior", "members"),
    [("iwan", -3.0, 1), ("iwan", 3.0, 2), ("", 3.0, 0)],
    ids=["the law says all", "the effect says something beside the law", "no law is better"],
)
def test_where_noise_explains_what_remains_another_law_comes_before_an_effect(
    best: str, prior: float, members: int
) -> None:
    """A steering friction of two stages was answered by a mount of the rack beside it, and 978 N for 383. Of
    a mount that is there the better law does not keep it out: a friction of 240 N was answered by 185."""
    (hub,) = library("hub_compliance")
    further = HypothesisFit(hub, beside_a_hub(), 12.0, prior)
    asked, own = Answers(0.0, best), agreeing().model.likelihood
    found = laws_instead(agreeing(), further, own, asked)
    beside = [best, best] if best else []
    assert asked.laws == ["", *CLOSED, *beside], "beside the law that it came in with, and beside the better"
    assert (0 if found is None else len(found.model.members)) == members
    assert found is None or found.model.members[0].law == best


@pytest.mark.parametrize("better", [True, False])
def test_a_law_is_compared_with_the_present_one_at_its_optimum(
    better: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Known derivatives left a friction of 299 N 6 of ln evidence short: each law in turn was better than the
    one before, without end."""
    (hub,) = library("hub_compliance")
    optimum = agreeing()

    class Settled(Answers):
        def fits(self, starts: Sequence[FitStart], what: str, **more: Any) -> list[Fit | None]:
            return [optimum] if what == "settling" else super().fits(starts, what, **more)

        def _fit(self, model: EffectModel, z: FloatArray, found: Fit, cost: float) -> Fit:
            beside = z.size > optimum.z.size
            return super()._fit(model, z, found if beside else optimum, cost + 60.0 * beside)

    def short(fit: Fit, errors: Likelihood) -> Fit:
        return replace(fit, converged=False, cost=fit.cost + 200.0)

    monkeypatch.setattr(convergence, "refit_to_errors", short)
    further = HypothesisFit(hub, beside_a_hub(), 12.0, 3.0)
    asked = Settled(30.0, "iwan" if better else "")
    found = laws_instead(optimum, further, optimum.model.likelihood, asked)
    assert (found is not None) is better


def test_a_free_law_comes_first_where_one_contrast_alone_remains() -> None:
    """A steering friction of two stages, 408 N, took a mount of the rack and a strut's friction into its set:
    each explained a little of what its law lacked, as long as noise did not."""
    found, asked = agreeing(), Answers(0.0, "backbone")
    known = found.model.contrasts
    tilt = next(i for i, c in enumerate(known.names) if c.load_case == "steer" and c.shape == "loop tilt")
    row = known.rows[:, [tilt]].toarray()[:, 0]
    one = replace(found, residual=0.5 * found.residual + 9.0 * row)
    assert one.residual_map.chance < NOISE_CHANCE and one.residual_map.mean_square < 1.0
    (hub,) = library("hub_compliance")
    freed = laws_instead(one, HypothesisFit(hub, beside_a_hub(), 12.0), found.model.likelihood, asked)
    assert freed is not None and freed.model.members[0].law == "backbone"
    assert asked.laws[-1] == "backbone", "the effect that explains all was asked for no free law"
    assert asked.laws.count("") == 1


def test_a_free_law_does_not_replace_an_effect_where_more_is_missing_or_no_friction_is_there() -> None:
    (hub,) = library("hub_compliance")
    further, asked = HypothesisFit(hub, beside_a_hub(), 12.0), Answers(-100.0)
    own = agreeing().model.likelihood
    assert laws_instead(disagreeing(), further, own, asked) is None
    alone = discovery("named").search.with_law_discrepancy
    assert laws_instead(alone, further, own, asked) is None
    assert not asked.laws


@pytest.mark.parametrize(
    ("law", "effect", "needless"),
    [(-20.0, 0.0, True), (-20.0, -20.0, False), (10.0, 0.0, False)],
    ids=["the law says all", "the effect says something beside it", "the law says less"],
)
def test_a_weak_effect_that_a_compliance_s_law_makes_needless(
    law: float, effect: float, needless: bool
) -> None:
    """A clamp that softened by a law of its own was answered by a mount of the rack beside it."""
    found = discovery("named").search.with_effects
    own = found.model.likelihood
    (mount,) = library("rack_mount_compliance")
    none = np.zeros(len(mount.sizes))
    model, z = found.model.extended(mount), np.append(found.z, none)
    known = np.hstack([found.jacobian.own, np.zeros((found.residual.size, none.size))])
    beside = replace(found, model=model, z=z, jacobian=model.jacobian(known))

    class Bent(Answers):
        def _fit(self, model: EffectModel, z: FloatArray, near: Fit, cost: float) -> Fit:
            return super()._fit(model, z, near, cost + (effect if len(model.members) > 1 else 0.0))

    weak, asked = HypothesisFit(mount, beside, 7.0), Bent(law)
    assert needless_beside_laws(found, weak, own, asked) is needless
    assert asked.laws == ["stiffening"] * 2
    asked.laws.clear()
    assert not needless_beside_laws(found, replace(weak, gain=PROPOSAL_GAIN), own, asked)
    many = replace(found, residual=3.0 * found.residual)
    assert not needless_beside_laws(many, weak, own, asked), "more than single contrasts remain"
    assert not asked.laws
