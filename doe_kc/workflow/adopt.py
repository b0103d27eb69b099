"""Adopt: the effects that a discovery found, added to the axle that is correlated."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from doe_kc.axle.model import Axle
from doe_kc.correlation.record import EffectRecord
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.screening.contrasts import LOOP_SHAPES, Contrast
from doe_kc.discovery.thresholds import AMPLITUDE_STEP
from doe_kc.effects import EFFECTS, apply_effect
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.effects.words import effect_label, place_words
from doe_kc.study import Study

PLACES_LISTED = 8
"""Places that nothing explains which are left out at most: the worst ones."""


@dataclass(frozen=True)
class AdoptedEffect:
    """id, location: of the hypothesis. options: of the effect's table. uncertain: others could be it."""

    id: str
    location: str | None
    options: Mapping[str, Any]
    uncertain: bool

    @property
    def label(self) -> str:
        """Name and place, in words."""
        label = effect_label(self.id).lower()
        return f"{label} ({place_words(self.location)})" if self.location else label

    @property
    def on_rig(self) -> bool:
        """Whether it is a fault of the measurement, which no axle file holds."""
        return EFFECTS[self.id].on_rig


@dataclass(frozen=True)
class Adoption:
    """axle: the study's, with the effects at the sizes found. effects: those added, largest first.

    refit: path -> absolute value that the axle is set to for the parameters of the discovery's fit. without:
    (load case, response) that nothing explains. size_steps: the axle with one size of one effect larger by
    AMPLITUDE_STEP, for each of them: the records leave sizes as open as parameters; none for a run that is
    read back.
    """

    axle: Axle
    effects: tuple[AdoptedEffect, ...]
    refit: Mapping[str, float]
    without: frozenset[tuple[str, str]]
    size_steps: tuple[Axle, ...] = ()

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was done, in words."""
        return tuple(_sentences(self))

    @property
    def records(self) -> list[EffectRecord]:
        """The effects, for the record of a run."""
        return [
            EffectRecord(id=e.id, location=e.location, options=dict(e.options), uncertain=e.uncertain)
            for e in self.effects
        ]


def adopt(study: Study, discovery: Discovery) -> Adoption:
    """What the study's `[discovery] adopt` takes over."""
    chosen = _chosen(study, discovery)
    fitted = discovery.fitted
    ambiguous = {effect for group in discovery.classes for effect in group}
    effects = tuple(
        _effect(
            f.hypothesis,
            fitted.model.sizes_at(fitted.z, f.hypothesis),
            uncertain=discovery.verdict != "named" and f.hypothesis.effect in ambiguous,
        )
        for f in chosen
    )
    best = fitted if chosen else discovery.search.tuned
    axle = with_effects(study.axle, effects)
    return Adoption(
        axle=axle,
        effects=effects,
        refit=best.model.values_with(axle, best.z),
        without=_without(discovery, bool(chosen)),
        size_steps=tuple(_size_steps(study.axle, effects, chosen, fitted)),
    )


def _effect(
    hypothesis: Hypothesis, amplitudes: Mapping[str, float], *, uncertain: bool = False
) -> AdoptedEffect:
    """amplitudes: by `Size.name`."""
    return AdoptedEffect(hypothesis.effect, hypothesis.location, hypothesis.options(amplitudes), uncertain)


def _size_steps(
    axle: Axle, effects: Sequence[AdoptedEffect], findings: Sequence[Finding], fitted: Fit
) -> Iterator[Axle]:
    """axle: without effects. findings: in the order of the effects. fitted: with them."""
    for i, finding in enumerate(findings):
        amplitudes = fitted.model.sizes_at(fitted.z, finding.hypothesis)
        for size in finding.hypothesis.sizes:
            larger = {**amplitudes, size.name: size.beside(amplitudes[size.name], AMPLITUDE_STEP)}
            yield with_effects(axle, [*effects[:i], _effect(finding.hypothesis, larger), *effects[i + 1 :]])


def adopted(study: Study, records: Sequence[EffectRecord], without: Sequence[Sequence[str]]) -> Adoption:
    """The adoption of a run that is read back."""
    effects = tuple(AdoptedEffect(r.id, r.location, r.options, r.uncertain) for r in records)
    places = frozenset((case, response) for case, response in without)
    return Adoption(with_effects(study.axle, effects), effects, {}, places)


def with_effects(axle: Axle, effects: Sequence[AdoptedEffect]) -> Axle:
    """The axle with the effects at their sizes."""
    for e in effects:
        axle = apply_effect(axle, e.id, e.options, source=e.label)
    return axle


def _chosen(study: Study, discovery: Discovery) -> tuple[Finding, ...]:
    wanted = study.discovery.adopt
    if wanted == "never":
        return ()
    if wanted == "auto":
        return tuple(f for f in discovery.findings if f.verdict != "lead")
    known = (*discovery.findings, *discovery.traces)
    return tuple(f for f in known if f.hypothesis.effect in wanted)


def _without(discovery: Discovery, any_effect: bool) -> frozenset[tuple[str, str]]:
    """Places whose mean curves nothing explains; what opens a loop only is no matter of the targets."""
    if discovery.verdict != "unexplained":
        return frozenset()
    left: Sequence[tuple[Contrast, float]] = (
        discovery.unexplained if any_effect else discovery.tuned_map.worst(PLACES_LISTED)
    )
    return frozenset((c.load_case, c.response) for c, _ in left if c.shape not in LOOP_SHAPES)


def _sentences(adoption: Adoption) -> Iterator[str]:
    for effect in adoption.effects:
        doubt = ", the leading one of a class" if effect.uncertain else ""
        done = "taken into account as a fault of the measurement" if effect.on_rig else "added to the axle"
        yield f"{effect.label}{doubt}: {done}"
    for load_case, response in sorted(adoption.without):
        yield f"{load_case} {response}: left out of the objectives, nothing explains what the records show"
