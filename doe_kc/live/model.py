"""What a live page works on: the study's axle with effects, its sliders, and the records as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import ParameterMap
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.live.effect_switches import EffectSizes, effective_axle
from doe_kc.live.outside_model import OutsideModel, outside_model
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.targets import Targets
from doe_kc.variables import Space, VariableOptions, build_space
from doe_kc.workflow.correlation_problem import study_problem
from doe_kc.workflow.measure import Reduced


@dataclass(frozen=True)
class LiveModel:
    """axle: with the effects that are switched on, all sliders at their start; whose shape is drawn. space:
    its sliders, all parameters that the axle's model contains, of an outside solver the study's variables.
    targets, likelihood: None without a target to work on. outside: None for the package's own solver.
    """

    study: Study
    axle: Axle
    space: Space
    measurement: Measurement | None
    targets: Targets | None
    likelihood: Likelihood | None
    outside: OutsideModel | None = None

    @property
    def windows(self) -> Mapping[str, float]:
        """Fit windows of the study."""
        return self.study.windows

    @cached_property
    def paths(self) -> tuple[str, ...]:
        """Every path that a design of the space sets: variables, ties, fixed."""
        return tuple(self.space.values(self.space.start))

    @cached_property
    def parameter_map(self) -> ParameterMap:
        """Of the paths."""
        return ParameterMap(self.axle, self.paths)

    def axle_at(self, values: Mapping[str, float]) -> Axle:
        """The axle at absolute values of every path; InputError as `with_values`."""
        return self.parameter_map.axle([values[path] for path in self.paths])

    def with_effects(self, effects: EffectSizes) -> LiveModel:
        """The model whose axle has other effects: sliders appear and go with them.

        InputError when an effect is not one of the axle or a size is out of range.
        """
        axle = effective_axle(self.study, effects)
        if self.outside is not None:
            return self
        return replace(self, axle=axle, space=slider_space(self.study, axle))


def live_model(study: Study, reduced: Reduced | None) -> LiveModel:
    """The model of a study without further effects; InputError as `read_study`, and for an outside solver
    whose store holds too few designs."""
    measurement = None if reduced is None else reduced.measurement
    outside = outside_model(study, study.space) if study.solver.command else None
    space = slider_space(study, study.axle) if outside is None else study.space
    targets, likelihood = None, None
    if measurement is not None or any(c.target is not None for c in study.characteristics):
        problem = study_problem(study, reduced, space=space)
        targets, likelihood = problem.targets, problem.likelihood
    if outside is not None and targets is not None and likelihood is not None:
        known = outside.form.told
        asked = {(c.load_case, c.response) for c in likelihood.curves}
        asked |= {("static", f.response) for f in likelihood.figures if f.row < 0}
        likelihood = likelihood.without(asked - known)
        curves = tuple(c for c in targets.curves if (c.load_case, c.response) in known)
        targets = replace(targets, curves=curves)
    axle = study.axle if outside is None else outside.drawn_axle
    return LiveModel(study, axle, space, measurement, targets, likelihood, outside)


def slider_space(study: Study, axle: Axle) -> Space:
    """All parameters that the axle's model contains, with the study's own bounds where it gives some."""
    own = study.variables
    options = VariableOptions(use=["*"], change=own.change)
    return build_space(axle, options, str(study.source))
