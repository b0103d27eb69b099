"""What a live page works on: the study's axle with effects, its sliders, and the records as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from doe_kc.axle.model import Axle
from doe_kc.axle.places import places_of
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.effects import EFFECTS, apply_effect
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.errors import InputError
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.targets import Targets
from doe_kc.variables import Space, VariableOptions, build_space
from doe_kc.workflow.correlation_problem import study_problem
from doe_kc.workflow.measure import Reduced

EffectSizes = Mapping[str, Mapping[str, float]]
"""Hypothesis name -> `Size.name` -> value in the size's unit: the effects that are switched on."""


@dataclass(frozen=True)
class LiveModel:
    """axle: with the effects that are switched on, all sliders at their start. space: its sliders, all
    parameters that the axle's model contains. targets, likelihood: None without a target to work on.
    """

    study: Study
    axle: Axle
    space: Space
    measurement: Measurement | None
    targets: Targets | None
    likelihood: Likelihood | None

    @property
    def windows(self) -> Mapping[str, float]:
        """Fit windows of the study."""
        return self.study.windows

    def with_effects(self, effects: EffectSizes) -> LiveModel:
        """The model whose axle has other effects: sliders appear and go with them.

        InputError when an effect is not one of the axle or a size is out of range.
        """
        axle = effective_axle(self.study.axle, effects)
        return replace(self, axle=axle, space=slider_space(self.study, axle))


def live_model(study: Study, reduced: Reduced | None) -> LiveModel:
    """The model of a study without further effects; InputError as `read_study`."""
    measurement = None if reduced is None else reduced.measurement
    space = slider_space(study, study.axle)
    targets, likelihood = None, None
    if measurement is not None or any(c.target is not None for c in study.characteristics):
        problem = study_problem(study, reduced, space=space)
        targets, likelihood = problem.targets, problem.likelihood
    return LiveModel(study, study.axle, space, measurement, targets, likelihood)


def slider_space(study: Study, axle: Axle) -> Space:
    """All parameters that the axle's model contains, with the study's own bounds where it gives some."""
    own = study.variables
    options = VariableOptions(use=["*"], change=own.change)
    return build_space(axle, options, str(study.source))


def switches(axle: Axle) -> dict[str, Hypothesis]:
    """Effects that can be switched on, by name: those in the car, absent from the axle file.

    Faults of a measurement are none: they say nothing of the axle.
    """
    places = places_of(axle)
    possible = [e for e in EFFECTS.values() if not e.on_rig and not e.present(axle) and e.possible(places)]
    return {h.name: h for e in possible for h in e.hypotheses(places)}


def effective_axle(axle: Axle, effects: EffectSizes) -> Axle:
    """The axle with the effects applied; InputError naming the effect for what it cannot have."""
    known = switches(axle)
    for name, sizes in effects.items():
        if name not in known:
            raise InputError(f"effect {name!r}: is none that this axle can be given; choose one of the list.")
        axle = apply_effect(axle, known[name].effect, effect_options(known[name], sizes), source="live")
    return axle


def effect_options(hypothesis: Hypothesis, sizes: Mapping[str, float]) -> dict[str, Any]:
    """The effect's table at sizes in their units; what is not among `sizes` is typical."""
    unknown = set(sizes) - {s.name for s in hypothesis.sizes}
    if unknown:
        raise InputError(f"effect {hypothesis.name!r}: has no size {min(unknown)!r}.")
    out = hypothesis.options({s.name: _typical_amplitude(s.shape) for s in hypothesis.sizes})
    for size in hypothesis.sizes:
        value = sizes.get(size.name, size.typical)
        if size.index is None:
            out[size.key] = value
        else:
            out[size.key][size.index] = value
    return out


def _typical_amplitude(shape: bool) -> float:
    return 0.0 if shape else 1.0
