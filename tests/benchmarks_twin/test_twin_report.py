"""The tables of the benchmark of twins count what the runs say."""

from __future__ import annotations

from benchmarks.twin.corrections import AS_SHIPPED
from benchmarks.twin.report import report
from benchmarks.twin.running import NO_TWIN, TwinRun


def run(how: str, *improvement: float, feasible: int | None, reached: int | None) -> TwinRun:
    return TwinRun("car, two effects", how, 1, feasible, reached, improvement, "Sound: alike.", 1.0)


def test_evaluations_to_the_end_of_the_road() -> None:
    runs = [
        run(AS_SHIPPED, 0.0, 97.0, 98.2, 98.4, feasible=2, reached=3),
        run(NO_TWIN, 0.0, 0.0, 50.0, 97.0, feasible=None, reached=None),
    ]
    lines = report(runs, ["| useless |"], "command", "machine")
    assert f"| car, two effects | **{AS_SHIPPED}** | 1 | 2 | 3 | 3 | 98.2 | 98.4 | 98.4 | 1 |" in lines
    assert "| car, two effects | no twin | 1 | – | – | – | 50.0 | 97.0 | 97.0 | 1 |" in lines
    assert f"| {AS_SHIPPED} | 1 | 1 of 1 | 1 of 1 | 1 of 1 |" in lines
    assert "| no twin (the study without one) | 1 | 0 of 1 | 0 of 1 | 0 of 1 |" in lines
    assert "| useless |" in lines and "- car, two effects: Sound: alike." in lines
