"""The configurations of a correlation of the shipped example: its variables, targets and methods."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

from correlation_runs import EXAMPLE, LEVELS

from doe_kc.correlation.methods import METHODS
from doe_kc.correlation.problem import Problem
from doe_kc.study import Study, read_study
from doe_kc.targets.options import CharacteristicOptions, CurveOptions
from doe_kc.variables import Change, Space, VariableOptions, build_space
from doe_kc.variables.variable import Variable
from doe_kc.workflow.correlation_problem import study_problem, study_space
from doe_kc.workflow.influence import study_influence
from doe_kc.workflow.measure import Reduced, study_records

LEFT_OUT = (
    CharacteristicOptions(match="lateral*.camber_change", objective=False, constraint=False),
    CharacteristicOptions(match="roll.*", objective=True),
)
"""The hub's compliance is missing in this axle: forcing its targets would bend all other parameters. Both
sides of this car rolled the same way, so that roll can be used."""
LEFT_OUT_CURVES = (CurveOptions(match="lateral*.camber", objective=False),)
DOZEN = 12
STANDARD = "standard"
ALL = "_all"
"""Ends the name of a configuration that also has the targets which the example leaves out."""
FIGURES: Mapping[str, tuple[str, tuple[tuple[str, str], ...]]] = {
    "5": ("distribution", ((STANDARD, "uniform"), ("gaussian", "Gaussian"))),
    "6": ("resolution", (("levels_21", "21 levels"), (STANDARD, "101 levels"), ("continuous", "continuous"))),
    "7": ("variables", ((STANDARD, "all {n}"), ("selection", "selection, {n}"), ("dozen", "a dozen"))),
    "8": ("bounds", (("narrow", "narrow, × 0.5"), (STANDARD, "standard"), ("wide", "wide, × 2"))),
    "9": (
        "algorithm",
        (
            (STANDARD, "ego"),
            ("pareto", "pareto"),
            ("hybrid", "hybrid"),
            ("gauss_newton", "gauss_newton, all curves"),
            ("gauss_newton_targets", "gauss_newton, curves with an objective"),
        ),
    ),
    "9b": (
        "algorithm, all targets",
        (("ego_all", "ego"), ("pareto_all", "pareto"), ("hybrid_all", "hybrid")),
    ),
}
"""The thesis's figure -> what varies, and its configurations with their names in the figure."""


@lru_cache(maxsize=1)
def example() -> tuple[Study, Reduced | None]:
    """The shipped study and its records, without the targets that the bare axle cannot reach."""
    plain = read_study(EXAMPLE)
    study = replace(plain, characteristics=LEFT_OUT, curves=LEFT_OUT_CURVES)
    return study, study_records(study)


@lru_cache(maxsize=1)
def advised() -> tuple[str, ...]:
    """Variables that the influence study advises, in the order of choice."""
    study, reduced = example()
    selection = study_influence(study, reduced.measurement if reduced else None, workers=1).selection
    return tuple(v.parameter.path for v in selection.variables if v.used) if selection else ()


def space_of(name: str) -> Space:
    """The variables of a configuration."""
    study, reduced = example()
    if name == "selection":
        chosen = VariableOptions(use="selection", levels=LEVELS)
        return study_space(replace(study, variables=chosen), reduced, workers=1)
    return build_space(study.axle, options_of(name, study), "report")


def options_of(name: str, study: Study) -> VariableOptions:
    """What a study file would say."""
    match name:
        case "gaussian":
            return VariableOptions(distribution="gaussian", levels=LEVELS)
        case "levels_21":
            return VariableOptions(levels=21)
        case "continuous":
            return VariableOptions(levels="continuous")
        case "dozen":
            return VariableOptions(use=list(advised()[:DOZEN]), levels=LEVELS)
        case "narrow" | "wide":
            times = 0.5 if name == "narrow" else 2.0
            changes = [_stretched(v, times) for v in study.space.variables]
            return VariableOptions(change=changes, levels=LEVELS)
    return VariableOptions(levels=LEVELS)


def _stretched(variable: Variable, times: float) -> Change:
    """Bounds `times` as far from nominal, for factors in their logarithm."""
    low, start, high = variable.lower, variable.start, variable.upper
    if variable.logarithmic:
        bounds = [start * (low / start) ** times, start * (high / start) ** times]
    else:
        bounds = [start + (low - start) * times, start + (high - start) * times]
    return Change(match=variable.path, range=bounds)


@lru_cache(maxsize=2)
def problem_of(name: str) -> Problem:
    """The example's targets for the variables of a configuration."""
    study, reduced = example()
    if name.endswith(ALL):
        study = replace(study, characteristics=(), curves=())
    if name == "gauss_newton_targets":
        study = replace(study, correlation=study.correlation.model_copy(update={"data": "targets"}))
    return study_problem(study, reduced, space=space_of(name))


def method_of(name: str) -> str:
    """`ego`, unless the configuration is another algorithm."""
    plain = name.removesuffix(ALL).removesuffix("_targets")
    return plain if plain in METHODS else "ego"
