"""Sign and identity of channels, inputs, sides and files: the one error that explains all slopes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from doe_kc.measurement.checks._base import RecordFinding, RigTest, rig_check
from doe_kc.measurement.checks.identity.faults import ChannelFault, fault_set
from doe_kc.measurement.checks.identity.laws import Expectation, misfit
from doe_kc.measurement.checks.identity.slopes import measured_slopes, model_slopes

TOLD_FALL = 14.0
"""Fall of the misfit, about -2 ln likelihood, from which an error is told."""
ERROR_FALL = 35.0
"""Fall from which it is an error, not a warning."""
MOST_ERRORS = 4
"""Independent errors that are looked for, one after another."""
OPEN = 4.0
"""Errors whose misfits differ by less are named together: which one it is stays open."""


@rig_check
def signs(test: RigTest) -> Iterator[RecordFinding]:
    """Errors in the order in which they explain most."""
    table, expected = measured_slopes(test), expectation(test)
    roll = test.runs.get("roll")
    counter_phase = roll is not None and roll[0].record.case.unit == "mm"
    candidates = fault_set(tuple(test.runs), counter_phase=counter_phase)
    for _ in range(MOST_ERRORS):
        now = float(misfit(table.batch(), expected)[0])
        if now < TOLD_FALL:
            return
        undone = candidates.undone(table)
        left = misfit(undone, expected, candidates.source) + candidates.price
        ranked = np.argsort(left)
        best = candidates.members[ranked[0]]
        fall = now - float(left[ranked[0]])
        if fall < TOLD_FALL:
            return
        others = [candidates.members[i] for i in ranked[1:8] if left[i] - left[ranked[0]] < OPEN]
        yield _finding(test, best, fall, [h for h in others if not _alike(best, h)])
        if best.source is not None:
            return
        table = undone.member(int(ranked[0]))


def expectation(test: RigTest) -> Expectation:
    """From the model and what `test.toml` states."""
    return Expectation(model_slopes(test.model), test.manifest.setup.reference_wheel_load_N)


def _alike(one: ChannelFault, other: ChannelFault) -> bool:
    return one.kind == other.kind and one.channel == other.channel


def _finding(test: RigTest, best: ChannelFault, fall: float, others: list[ChannelFault]) -> RecordFinding:
    everywhere = len(best.cases) == len(test.runs)
    case = "*" if everywhere else best.cases[0]
    where = str(test.source) if everywhere else test.runs[best.cases[0]][0].record.label
    rest = "".join(f"; or {h.words}" for h in others[:2])
    evidence = f"{best.words}{rest}: without it the slopes near rest agree with laws and model better by "
    return RecordFinding(
        kind=best.kind,
        severity="error" if fall > ERROR_FALL and not others else "warning",
        case=case,
        channel=best.channel,
        where=where,
        evidence=f"{evidence}{fall:.0f} (-2 ln likelihood)",
        cure=best.cure if not others else f"look at the rig which it is, then {best.cure}",
        unit=best.unit,
    )
