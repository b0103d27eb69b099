"""A mount of the rack that the law of a steering friction has taken up."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, fit
from doe_kc.discovery.search import series_compliance
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.law_variants import open_laws, other_laws
from doe_kc.discovery.search.series_compliance import with_series_compliances
from doe_kc.discovery.thresholds import NOISE_CHANCE, SERIES_RATIOS
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import discovery, library, model

(FRICTION,) = library("steering_friction")
(MOUNT,) = library("rack_mount_compliance")
EVERY = [FRICTION, MOUNT, *library("hub_compliance", "tie_rod_compliance", "strut_bending")]


@cache
def alone(car: str, law: str = "") -> EffectSearch:
    """A search that ended with a steering friction by some law and nothing else."""
    friction = next(h for h in (FRICTION, *other_laws(FRICTION), *open_laws(FRICTION)) if h.law == law)
    without = model(car).extended(friction)
    begun = [0.0 if size.shape else 1.0 for size in friction.sizes]
    last = fit(without, np.append(np.zeros(without.dimension), begun))
    return replace(discovery("friction").search, with_law_discrepancy=last, with_effects=last, shape_loss=0.0)


@pytest.fixture
def explained(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if noise explained what any set leaves."""
    monkeypatch.setattr(series_compliance, "NOISE_CHANCE", 0.0)


class Counted(DiscoveryWorkers):
    """Counts the fits that are asked for."""

    count = 0

    def fits(self, starts: list[FitStart], *args: object, **kwargs: object) -> list[Fit | None]:  # type: ignore[override]
        self.count += len(starts)
        return super().fits(starts, *args, **kwargs)  # type: ignore[arg-type]


@pytest.fixture
def taken(monkeypatch: pytest.MonkeyPatch) -> list[FitStart]:
    """Sets that the search goes on from, each to one more probable than the last one."""
    starts: list[FitStart] = []

    def gone_on(before: EffectSearch, start: FitStart, changed: Hypothesis, *_: object) -> EffectSearch:
        assert changed == MOUNT and start.model.members[-1] == MOUNT
        starts.append(start)
        last = before.with_law_discrepancy
        return replace(before, with_law_discrepancy=replace(last, cost=last.cost - 1.0))

    monkeypatch.setattr(series_compliance, "search_from", gone_on)
    return starts


@pytest.mark.usefixtures("explained")
def test_a_friction_on_a_mount_is_told_with_the_mount(taken: list[FitStart]) -> None:
    """200 N on 4000 N/mm, which alone are 162 N."""
    before = alone("mounted")
    assert with_series_compliances(before, EVERY, DiscoveryWorkers()) is not before
    (found,) = taken
    sizes = {h.name: found.model.sizes_at(found.z, h) for h in found.model.members}
    force = next(s for s in FRICTION.sizes if s.key == "force_N").value(sizes[FRICTION.name]["force_N"])
    stiffness = MOUNT.sizes[0].value(sizes[MOUNT.name]["k_N_mm"])
    assert force == pytest.approx(200.0, rel=0.1) and stiffness == pytest.approx(4000.0, rel=0.1)


def test_a_mount_that_is_not_there_is_asked_for_by_every_closed_law_and_not_taken(
    taken: list[FitStart],
) -> None:
    """332 N on a mount of 4250 N/mm were 201.0 +- 2.3 N by Prandtl-Iwan's law, by which a mount brings
    nothing."""
    before, asked = alone("friction"), Counted()
    assert with_series_compliances(before, EVERY, asked).with_effects is before.with_effects
    assert asked.count == 1 + 4 * len(SERIES_RATIOS) and not taken


@pytest.mark.usefixtures("explained")
@pytest.mark.parametrize("other", ["duhem", ""], ids=["by another law", "by the same one"])
def test_a_better_set_without_the_mount_is_asked_again_by_another_law(
    other: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """201 N by a law of wide spread ended at 133.0 +- 1.6 N without its mount, by way of a set with one."""
    better = alone("mounted", other)
    asked: list[Fit] = []

    def gone_on(before: EffectSearch, *_: object) -> EffectSearch:
        asked.append(before.with_effects)
        found = better.with_law_discrepancy
        ahead = before.with_law_discrepancy.cost - 100.0
        return replace(better, with_law_discrepancy=replace(found, cost=ahead))

    monkeypatch.setattr(series_compliance, "search_from", gone_on)
    monkeypatch.setattr(series_compliance, "ACCEPTED_ODDS", 0.0)
    assert with_series_compliances(alone("mounted"), EVERY, DiscoveryWorkers()) is not alone("mounted")
    assert asked == [alone("mounted").with_effects, *([better.with_effects] if other else [])]


@cache
def freed(car: str, law: str) -> EffectSearch:
    """A search that ended with a steering friction of free shape, beside which a closed law was the best."""
    (shape,) = open_laws(FRICTION)[-1:]
    return replace(alone(car, shape.law), with_other_laws=alone(car, law).with_effects)


@pytest.mark.parametrize(
    ("law", "near"),
    [("duhem", 5), ("iwan", 1)],
    ids=["of more numbers", "of as few as the default one"],
)
def test_a_free_shape_asks_every_closed_law_and_itself_where_loops_are_the_same(
    law: str, near: int, taken: list[FitStart]
) -> None:
    """236 N on a mount of 7600 N/mm were 155.1 +- 4.0 N by Duhem's law, by which the mount brought nothing. A
    mount that is not there is not taken: the free shape fits as well."""
    before, asked = freed("friction", law), Counted()
    assert with_series_compliances(before, EVERY, asked).with_effects is before.with_effects
    assert asked.count == near + 5 * len(SERIES_RATIOS) and not taken


def test_a_law_of_more_numbers_asks_every_closed_law(taken: list[FitStart]) -> None:
    """271 N on a mount of 7060 N/mm were 217.7 +- 1.9 N by Duhem's law, near which no free shape came."""
    before, asked = alone("friction", "duhem"), Counted()
    assert with_series_compliances(before, EVERY, asked).with_effects is before.with_effects
    assert asked.count == 5 + 4 * len(SERIES_RATIOS) and not taken


def test_a_trace_is_asked_for_by_its_own_law_alone(taken: list[FitStart]) -> None:
    """Beside a free play eight fits of a mount in series with 8 N took a tenth of a search."""
    before, asked = freed("friction", "duhem"), Counted()
    last = before.with_effects
    z = last.z.copy()
    z[last.model.dimension] = 0.02
    trace = replace(last, z=z)
    assert with_series_compliances(replace(before, with_effects=trace), EVERY, asked).with_effects is trace
    assert asked.count == 1 and not taken


@pytest.mark.usefixtures("explained")
def test_a_compliance_across_the_motion_of_a_friction_is_not_in_series_with_it() -> None:
    """A strut's bending beside the friction along the strut: five fits of it took a second and changed none
    of the sizes."""
    (friction,) = library("strut_friction")
    before = alone("friction")
    last = replace(before.with_effects, model=model("friction").extended(friction))
    asked = Counted()
    assert with_series_compliances(replace(before, with_effects=last), EVERY, asked).with_effects is last
    assert asked.count == 0


@pytest.mark.parametrize(("worse", "counts"), [(1e9, True), (0.0, False)])
def test_a_mount_must_fit_better_than_the_free_shape_without_it(
    worse: float, counts: bool, taken: list[FitStart], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A friction of two stages, 276 N, had become 397 +- 33 N on a mount that is not there."""
    before = freed("friction", "duhem")
    last = before.with_effects
    monkeypatch.setattr(series_compliance, "ACCEPTED_ODDS", -np.inf)
    poor = replace(before, with_effects=replace(last, cost=last.cost + worse))
    with_series_compliances(poor, EVERY, NoPromise())
    assert bool(taken) is counts


@pytest.mark.parametrize(("ahead", "counts"), [(0.5, True), (4.0, False)], ids=["near", "far behind"])
def test_a_mount_beside_which_the_friction_would_be_larger_counts_for_its_size(
    ahead: float, counts: bool, taken: list[FitStart], monkeypatch: pytest.MonkeyPatch
) -> None:
    """467 N on a mount of 6680 N/mm were 351.7 +- 3.4 N without, 1.3 of ln posterior odds ahead. One in
    twenty is behind by 3.0, of which the mount's own odds are 2.5 here."""
    before = freed("friction", "duhem")
    odds = before.prior.log_odds([FRICTION], MOUNT)
    monkeypatch.setattr(series_compliance, "ACCEPTED_ODDS", np.inf)
    kept = with_series_compliances(before, EVERY, ByOneLaw(before.with_effects, ahead, at=0))
    assert bool(kept.larger) is counts and not taken
    for one in kept.larger:
        assert one.gain == pytest.approx(odds - 0.5 * ahead)


def test_sets_that_fit_alike_count_by_what_the_records_say(
    taken: list[FitStart], monkeypatch: pytest.MonkeyPatch
) -> None:
    """227 N of two stages alone and 303 N on a mount of 7250 N/mm fit alike: the second, the car's, was 240
    to 1 behind for what it has in numbers, and the first told as 226.9 +- 1.9 N."""
    before = freed("friction", "duhem")
    monkeypatch.setattr(series_compliance, "ACCEPTED_ODDS", np.inf)
    by_itself = with_series_compliances(before, EVERY, ByOneLaw(before.with_effects, 4.0, at=-1))
    assert [one.gain for one in by_itself.larger] == [-2.0] and not taken
    closed = with_series_compliances(before, EVERY, ByOneLaw(before.with_effects, 4.0, at=0))
    assert not closed.larger, "by a closed law it has to be more probable"
    default = with_series_compliances(
        freed("friction", "iwan"), EVERY, ByOneLaw(before.with_effects, 4.0, at=-1)
    )
    assert not default.larger, "a closed law without numbers of its own fits as well"


class ByOneLaw(DiscoveryWorkers):
    """By one start alone there is a fit with a mount that moves nothing, behind the one without by a cost."""

    def __init__(self, last: Fit, cost: float, at: int) -> None:
        super().__init__()
        self.last, self.cost, self.at = last, cost, at

    def fits(self, starts: list[FitStart], *_: object, **__: object) -> list[Fit | None]:  # type: ignore[override]
        out: list[Fit | None] = [None] * len(starts)
        if len(starts) > 1:
            model, last = starts[self.at].model, self.last
            none = np.zeros((last.residual.size, len(MOUNT.sizes)))
            own = last.jacobian.own[:, : model.calibrations.stop + len(model.sizes) - len(MOUNT.sizes)]
            jacobian, z = model.jacobian(np.hstack([own, none])), starts[self.at].z
            out[self.at] = replace(last, model=model, z=z, jacobian=jacobian, cost=last.cost + self.cost)
        return out


@pytest.mark.parametrize(("at", "counts"), [(0, False), (-1, True)], ids=["a closed law", "the free shape"])
def test_a_mount_by_the_own_law_need_not_fit_better_than_any_free_shape(
    at: int, counts: bool, taken: list[FitStart], monkeypatch: pytest.MonkeyPatch
) -> None:
    """240 N of two stages on a mount of 3040 N/mm were 133 +- 1 N by a free shape without it."""
    before = freed("friction", "iwan")
    monkeypatch.setattr(series_compliance, "ACCEPTED_ODDS", -np.inf)
    with_series_compliances(before, EVERY, ByOneLaw(before.with_effects, 0.5, at))
    assert bool(taken) is counts


def test_a_mount_with_which_there_is_no_equilibrium_is_left_out(taken: list[FitStart]) -> None:
    class NoSolution(DiscoveryWorkers):
        def fits(self, starts: list[FitStart], *_: object, **__: object) -> list[Fit | None]:  # type: ignore[override]
            return [None] * len(starts)

    before = freed("friction", "duhem")
    assert with_series_compliances(before, EVERY, NoSolution()) is before and not taken


class NoPromise(DiscoveryWorkers):
    """By its own law a friction has no equilibrium with a mount."""

    def fits(self, starts: list[FitStart], *args: object, **kwargs: object) -> list[Fit | None]:  # type: ignore[override]
        if len(starts) == 1:
            return [None]
        return super().fits(starts, *args, **kwargs)  # type: ignore[arg-type]


def test_nothing_is_in_series_with_what_is_no_friction() -> None:
    before, asked = discovery("named").search, Counted()
    assert with_series_compliances(before, EVERY, asked) is before
    assert asked.count == 0


@pytest.mark.parametrize("explains", [True, False])
def test_what_is_unexplained_must_be_explained_by_the_mount(
    explains: bool, taken: list[FitStart], monkeypatch: pytest.MonkeyPatch
) -> None:
    """270 N of two stages on 4580 N/mm were 195 N, a power assist and something unexplained."""
    before = alone("mounted")
    assert before.with_law_discrepancy.residual_map.chance < NOISE_CHANCE
    if not explains:
        monkeypatch.setattr(series_compliance, "NOISE_CHANCE", 1.1)
    after = with_series_compliances(before, EVERY, DiscoveryWorkers())
    assert (after is not before) is explains and bool(taken) is explains


def test_beside_something_unexplained_only_what_makes_the_same_loops_is_asked() -> None:
    asked = Counted()
    without = [h for h in EVERY if h != MOUNT]
    assert with_series_compliances(alone("mounted"), without, asked).larger == ()
    assert asked.count == 0


@pytest.mark.usefixtures("explained")
def test_a_set_that_is_more_probable_by_too_little_is_kept(
    taken: list[FitStart], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(series_compliance, "ACCEPTED_ODDS", np.inf)
    kept = with_series_compliances(alone("mounted"), EVERY, DiscoveryWorkers())
    (larger,) = kept.larger
    assert larger.hypothesis == MOUNT and larger.gain > 0.0 and not taken
    assert not larger.fit.jacobian.own.size


@pytest.mark.usefixtures("explained")
def test_a_set_that_ends_no_more_probable_counts_as_what_it_ended_at(monkeypatch: pytest.MonkeyPatch) -> None:
    before = alone("mounted")
    last = before.with_law_discrepancy
    ended = replace(before, with_law_discrepancy=replace(last, cost=last.cost + 4.0))
    monkeypatch.setattr(series_compliance, "search_from", lambda *_: ended)
    (larger,) = with_series_compliances(before, EVERY, DiscoveryWorkers()).larger
    assert larger.gain == pytest.approx(ended.log_posterior - before.log_posterior) and larger.gain < 0.0
