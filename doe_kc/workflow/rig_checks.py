"""The checks of a study's rig records by physics, beside its axle's own curves."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path

from doe_kc.axle import Axle
from doe_kc.curves import CurveSet
from doe_kc.ground.errors import DoeKcError, InputError
from doe_kc.measurement import Manifest
from doe_kc.measurement.branches import RunCurves
from doe_kc.measurement.checks import RecordFinding, RigTest, check_test
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve

log = logging.getLogger("doe_kc")


def axle_curves(axle: Axle) -> CurveSet | None:
    """Curves of the axle as its file says; None where it has no equilibrium, which other commands tell."""
    try:
        return curve_set(solve(axle))
    except DoeKcError:
        return None


def rig_findings(
    source: Path, manifest: Manifest, runs: Mapping[str, tuple[RunCurves, ...]], model: CurveSet | None
) -> tuple[RecordFinding, ...]:
    """Findings on the records of a test, errors first. source: its `test.toml`."""
    return check_test(RigTest(source, manifest, runs, model)) if runs else ()


def refuse_faulty(findings: tuple[RecordFinding, ...]) -> None:
    """Warn of what is a warning; InputError for the first error, with the number of others."""
    for finding in findings:
        if finding.severity == "warning":
            log.warning(finding.message)
    errors = [f for f in findings if f.severity == "error"]
    if errors:
        more = f" `doe-kc check` tells {len(errors) - 1} more." if len(errors) > 1 else ""
        raise InputError(
            f"{errors[0].message} Where the record is right all the same, name the finding in [checks] "
            f"accept "
            f"of test.toml.{more}"
        )
