"""What a friction would be beside another stiffness."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.thresholds import LARGER_SET_ODDS
from doe_kc.discovery.verdict.alternatives import Alternatives
from doe_kc.discovery.verdict.other_sizes import OTHER_SIZE, other_sizes
from tests.discovery.cases import discovery, library
from tests.discovery.search.law_answers import with_member

(MOUNT,) = library("rack_mount_compliance")


def found() -> Discovery:
    """A steering friction of 200 N."""
    return discovery("friction")


def on_a_mount(force: float, mount: float) -> Fit:
    """As if it were another one on a mount."""
    fit = with_member(found().search.with_law_discrepancy, MOUNT)
    friction = fit.model.members[0]
    z = fit.z.copy()
    z[fit.model.place(friction).start] = friction.sizes[0].amplitude(force)
    z[fit.model.place(MOUNT).start] = MOUNT.sizes[0].amplitude(mount)
    return replace(fit, z=z)


def test_the_one_furthest_off_is_told() -> None:
    search = replace(
        found().search,
        larger=(HypothesisFit(MOUNT, on_a_mount(260.0, 7000.0), -1.0),),
        optima=(on_a_mount(310.0, 3750.0),),
    )
    (sentence,) = other_sizes(search, [], found().findings)
    assert sentence.startswith(
        f"{OTHER_SIZE}steering friction would be 310 N with rack-mount compliance of 3750 N/mm; "
    )


def test_beside_a_mount_that_hardly_yields_it_is_the_one_without() -> None:
    """The typical one of 6000 N/mm is a trace from 60 000 on; none at all has no stiffness to tell."""
    cases = {
        58e3: "with rack-mount compliance of 58000 N/mm",
        62e3: "without rack-mount",
        np.inf: "without rack",
    }
    for mount, words in cases.items():
        search = replace(found().search, optima=(on_a_mount(310.0, mount),))
        (sentence,) = other_sizes(search, [], found().findings)
        assert sentence.startswith(f"{OTHER_SIZE}steering friction would be 310 N {words}")


@pytest.mark.parametrize(("gain", "told"), [(1.0, True), (LARGER_SET_ODDS + 1.0, False)])
def test_without_a_mount_that_may_not_be_there_it_is_another_one(gain: float, told: bool) -> None:
    """184 +- 52 N on a mount with odds of 1 to 2, 120 N without."""
    alone = on_a_mount(120.0, 6000.0)
    unsure = Alternatives(alone, (), (HypothesisFit(MOUNT, alone, gain),), 1.0, no_change(), 1.0)
    sentences = other_sizes(found().search, [unsure], found().findings)
    assert bool(sentences) is told
    for sentence in sentences:
        assert sentence.startswith(f"{OTHER_SIZE}steering friction would be 120 N without rack-mount compl")


def no_change() -> Any:
    """What the sentence does not ask for."""


def test_what_is_nearly_the_same_is_not_worth_a_sentence() -> None:
    near = replace(found().search, optima=(on_a_mount(205.0, 7000.0),))
    assert not other_sizes(near, [], found().findings)
    assert not other_sizes(found().search, [], found().findings)


def test_an_effect_that_is_no_friction_has_no_other_size() -> None:
    """Nor has one of a size below none: a ride height of -5 mm had."""
    search = replace(found().search, optima=(on_a_mount(310.0, 3750.0),))
    one = discovery("named").findings[0]
    below = replace(one, estimates=tuple(replace(e, value=-e.value) for e in one.estimates))
    assert not other_sizes(search, [], [one, below])
