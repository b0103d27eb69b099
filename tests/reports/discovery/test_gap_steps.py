"""The gap step by step: falls to what the axle handed over leaves."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import pytest

from doe_kc.reports.discovery.effect_words import effect_words, effect_words_table, size_name
from doe_kc.reports.discovery.evidence import evidence_steps
from doe_kc.reports.discovery.gap_steps import GapStep, gap_steps, gap_steps_figure
from doe_kc.reports.drawing.words import extent
from tests.discovery.cases import discovery


@pytest.mark.parametrize("car", ["none", "named", "two", "unexplained"])
def test_steps_begin_with_the_axle_handed_in_and_end_with_the_one_handed_over(car: str) -> None:
    found = discovery(car)
    steps = gap_steps(found)
    assert [s.gap for s in steps[:2]] == [found.gap.nominal, found.gap.tuned]
    assert steps[-1].gap == (found.gap.with_effect if found.fitted.model.members else found.gap.tuned)
    assert len(steps) >= 2 + bool(found.fitted.model.members)


def test_two_effects_are_two_steps_each_closer_to_the_records() -> None:
    found = discovery("two")
    steps = gap_steps(found)
    effects = [pair for pair in pairwise(steps) if pair[1].label.startswith("+ ")]
    assert len(effects) >= 2
    assert all(later.gap < 0.95 * earlier.gap for earlier, later in effects)
    # a law of fewer numbers takes over in the end, by what its numbers followed of the noise
    assert all(later.gap < 1.001 * earlier.gap for earlier, later in pairwise(steps))


def test_a_law_that_changed_is_a_step_of_its_own() -> None:
    """Of two steps that were both called refitted nobody knew what had been done."""
    found = discovery("friction")
    last = found.search.steps[-1]
    (friction,) = found.fitted.model.members
    before = replace(last, members=(replace(friction, law="duhem"),))
    after = replace(last, members=(replace(friction, law="iwan"),))
    search = replace(found.search, steps=(found.search.steps[0], before, after))
    labels = [s.label for s in gap_steps(replace(found, search=search))]
    assert labels[2:4] == ["+ steering friction", "other law of steering friction"]
    titles = [s.title for s in evidence_steps(replace(found, search=search))]
    assert titles[1] == "Step 2: re-tuned with steering friction"
    assert titles[2].startswith("Step 3: re-tuned with steering friction; other law of steering friction")


@pytest.mark.parametrize("car", ["none", "two"])
def test_the_picture_holds_every_step(car: str) -> None:
    found = discovery(car)
    steps = gap_steps(found)
    page = gap_steps_figure(steps, found.gap.noise_floor)
    said = [w.text for w in page.words]
    assert page.outside == [] and "noise of the rig" in said
    assert {f"{s.gap:.2f} ×" for s in steps} <= set(said)


def test_a_long_name_does_not_touch_the_next() -> None:
    """An effect that comes in, one that goes and two laws that change have three lines."""
    gone, laws = "− sub-frame flexibility", "other law of strut friction and rubber hysteresis"
    long = f"+ tyre horizontal compliance, {gone}, {laws}"
    names = ["model as handed in", long, long, f"{long}, + hub and wheel-bearing compliance", "re-tuned"]
    page = gap_steps_figure([GapStep(name, 1.0) for name in names], 1.0)
    lines = [extent(w) for w in page.words if any(w.text and w.text.split("\n")[0] in n for n in names)]
    assert len(lines) == len(names)
    assert all(above[1] > below[3] for above, below in pairwise(sorted(lines, key=lambda e: -e[1])))


def test_an_effect_in_one_line() -> None:
    found = discovery("named")
    words = effect_words(found, found.findings[0])
    assert words.kind == "found" and words.sure.startswith("sure (")
    assert words.sizes[0].startswith("stiffness in camber ") and "±" in words.sizes[0]
    assert words.confirm and words.physics and words.adopted is None
    assert len(effect_words_table([words]).page_columns) == 6


def test_sizes_have_names_without_units() -> None:
    sizes = {
        size_name(s) for car in ("named", "two") for f in discovery(car).findings for s in f.hypothesis.sizes
    }
    assert not [name for name in sizes if "_" in name]
