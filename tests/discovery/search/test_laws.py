"""The law of a friction: opened where noise does not explain what remains, left alone where it does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit, FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.laws import open_laws, other_laws, with_free_laws, with_law, with_open_laws
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import discovery, library


class Answers(DiscoveryWorkers):
    """Gives the fit of the start itself, better or worse by some cost, and notes the laws asked for."""

    def __init__(self, cost: float) -> None:
        super().__init__()
        self.cost, self.laws = cost, [""] * 0

    def fits(self, starts: Sequence[FitStart], what: str) -> list[Fit | None]:
        self.laws += [s.model.members[0].law for s in starts]
        return [self._fit(s.model, s.z) for s in starts]

    def _fit(self, model: EffectModel, z: FloatArray) -> Fit:
        found = disagreeing()
        more = z.size - found.z.size
        jacobian = model.jacobian(np.hstack([found.jacobian.own, np.zeros((found.residual.size, more))]))
        return replace(found, model=model, z=z, jacobian=jacobian, cost=found.cost + self.cost)


def agreeing() -> Fit:
    return discovery("friction").search.with_law_discrepancy


def disagreeing() -> Fit:
    residual = agreeing().residual.copy()
    residual[:60] += 5.0
    return replace(agreeing(), residual=residual)


def test_a_law_has_its_default_numbers_and_its_own_at_typical() -> None:
    found = agreeing()
    (friction,) = found.model.members
    first, *_ = open_laws(friction)
    assert first.law and len(first.sizes) > len(friction.sizes)
    assert first.name == friction.name
    model, z = with_law(found, friction, first)
    assert model.members == (first,)
    np.testing.assert_array_equal(z[: found.z.size], found.z)
    assert not z[found.z.size :].any()
    assert not open_laws(library("hub_compliance")[0])


def test_other_laws_are_those_of_one_number_more_at_most() -> None:
    (friction,) = agreeing().model.members
    assert [law.law for law in other_laws(friction)] == ["iwan", "duhem", "lognormal"]
    assert [law.law for law in other_laws(open_laws(friction)[0])] == ["", "iwan", "lognormal"]
    assert not other_laws(library("hub_compliance")[0])


def test_where_noise_explains_what_remains_no_law_is_asked_for() -> None:
    asked = Answers(-100.0)
    assert with_open_laws(agreeing(), asked) is not None
    assert asked.laws == []


@pytest.mark.parametrize(("cost", "opened"), [(-50.0, True), (10.0, True), (60.0, False)])
def test_the_open_law_goes_on_unless_its_evidence_is_clearly_less(cost: float, opened: bool) -> None:
    found = with_open_laws(disagreeing(), Answers(cost))
    assert bool(found.model.members[0].law) is opened


@pytest.mark.parametrize(("cost", "opened"), [(-50.0, True), (10.0, False)])
def test_a_free_law_is_taken_only_where_it_gains(cost: float, opened: bool) -> None:
    asked = Answers(cost)
    found = with_free_laws(disagreeing(), asked)
    (friction,) = agreeing().model.members
    assert asked.laws == [open_laws(friction)[-1].law]
    assert bool(found.model.members[0].law) is opened
