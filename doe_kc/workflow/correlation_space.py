"""The variables of a correlation: the study's, those that its influence study advises, or a discovery's."""

from __future__ import annotations

from doe_kc.ground.errors import InputError
from doe_kc.measurement import Measurement
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.study import Study
from doe_kc.variables import Space, build_space
from doe_kc.variables.build import Advice
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.discover import discovery_space
from doe_kc.workflow.influence import study_influence
from doe_kc.workflow.measure import Reduced


def correlation_space(
    study: Study,
    reduced: Reduced | None,
    adoption: Adoption | None,
    selection: Selection | None = None,
    workers: int | None = None,
) -> Space:
    """The variables of a run: the study's, on the axle with the effects adopted.

    After a discovery a parameter that is an effect in other words stays as it is, unless the study names it:
    whether the car differs in it has been decided.
    """
    if adoption is None or study.variables.use == "selection":
        return study_space(study, reduced, selection, workers)
    return discovery_space(adoption.axle, study.variables, str(study.source))


def study_space(
    study: Study, reduced: Reduced | None, selection: Selection | None = None, workers: int | None = None
) -> Space:
    """The study's variables; for `use = "selection"` those that the influence study advises.

    selection: its advice; None makes the study. InputError when it is asked for without records.
    """
    if study.variables.use != "selection":
        return study.space
    measurement: Measurement | None = reduced.measurement if reduced is not None else None
    if measurement is None:
        raise InputError(
            f'{study.source}: variables: use = "selection" needs a measurement for the influence study to '
            'choose for; name one, or use = ["*"].'
        )
    advice = selection or study_influence(study, measurement, workers=workers).selection
    used = advice.variables if advice is not None else ()
    bounds = {v.parameter.path: (v.lower, v.upper) for v in used if v.used}
    return build_space(study.axle, study.variables, str(study.source), advice=Advice(bounds))
