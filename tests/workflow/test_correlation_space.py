"""The variables that a correlation works on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.solver.suite import solve
from doe_kc.study import read_study
from doe_kc.workflow import correlation_problem as module
from doe_kc.workflow.correlation_problem import correlation_space
from doe_kc.workflow.influence import study_influence
from doe_kc.workflow.measure import reduce_records
from tests.cli.runner import write_study


def test_a_selection_that_is_known_is_not_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    records = {"lateral": ("lateral.csv", "lateral_repeat1.csv")}
    study = read_study(write_study(tmp_path, records=records, parameters=["LLF.z", "llr.Fy", "llf.Fx"]))
    study = replace(study, variables=study.variables.model_copy(update={"use": "selection"}))
    reduced = reduce_records(study, solve(study.axle))
    selection = study_influence(study, reduced.measurement, workers=1).selection
    assert selection is not None
    own = correlation_space(study, reduced, None, workers=1)

    def again(*_: object, **__: object) -> Selection:
        raise AssertionError("the influence study runs a second time")

    monkeypatch.setattr(module, "study_influence", again)
    assert correlation_space(study, reduced, None, selection).variables == own.variables
    with pytest.raises(AssertionError, match="second time"):
        correlation_space(study, reduced, None)
