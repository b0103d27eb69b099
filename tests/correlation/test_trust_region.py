"""The radius of the one trust region: what shrinks it, what lets it grow, and what happens at its end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.modelled.trust_region import RadiusRule, TrustRegion

RULE = RadiusRule(
    first=0.2, smallest=0.05, largest=0.5, shrinkage=0.5, growth=2.0, poor=0.1, good=0.7, floor="end"
)


@pytest.mark.parametrize(
    ("ratio", "radius"), [(-np.inf, 0.1), (0.05, 0.1), (0.1, 0.2), (0.7, 0.2), (0.8, 0.4), (np.inf, 0.4)]
)
def test_a_kept_promise_enlarges_and_a_broken_one_shrinks(ratio: float, radius: float) -> None:
    assert TrustRegion.first(RULE).after(ratio).radius == pytest.approx(radius)


def test_it_grows_to_the_largest_radius_only() -> None:
    assert TrustRegion(RULE, 0.4).after(1.0).radius == 0.5


def test_a_step_inside_the_box_shrinks_it_to_less_than_the_step() -> None:
    assert TrustRegion.first(RULE).after(0.0, length=0.12).radius == pytest.approx(0.06)
    assert TrustRegion.first(RULE).after(1.0, length=0.12).radius == pytest.approx(0.4)


def test_below_the_smallest_radius_it_stays_restarts_or_ends() -> None:
    small = TrustRegion(RULE, 0.06)
    assert small.after(0.0).radius == pytest.approx(0.03) and small.after(0.0).exhausted
    for floor, radius in (("stay", 0.05), ("restart", 0.2)):
        new = TrustRegion(replace(RULE, floor=floor), 0.06).after(0.0)  # type: ignore[arg-type]
        assert new.radius == radius and not new.exhausted


def test_the_box_ends_at_the_bounds_and_is_no_smaller_than_the_smallest() -> None:
    box = TrustRegion.first(RULE).box(np.array([0.1, 0.5]))
    assert box.lower == pytest.approx([0.0, 0.3]) and box.upper == pytest.approx([0.3, 0.7])
    assert box.clip(np.array([[2.0, 0.0]]))[0] == pytest.approx([0.3, 0.3])
    centre = np.array([0.5])
    assert TrustRegion.first(RULE).box(centre, shrunk=1).upper == pytest.approx([0.6])
    assert TrustRegion.first(RULE).box(centre, shrunk=9).upper == pytest.approx([0.55])
