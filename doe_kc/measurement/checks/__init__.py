"""Rig records checked by physics: `check_test` runs every check on a test."""

from __future__ import annotations

import sys
from dataclasses import replace

from doe_kc.ground.registry import import_members
from doe_kc.measurement.checks._base import CHECKS, RecordFinding, RigTest, accepted

import_members(sys.modules[__name__])


def check_test(test: RigTest) -> tuple[RecordFinding, ...]:
    """Findings of all checks, errors first. What the test's `accept` names is a warning at most."""
    globs = test.manifest.checks.accept
    findings = [
        replace(f, severity="warning") if accepted(f, globs) else f
        for check in CHECKS.values()
        for f in check(test)
    ]
    return tuple(sorted(_first_causes(findings), key=lambda f: f.severity))


def _first_causes(findings: list[RecordFinding]) -> list[RecordFinding]:
    """Without what follows from another finding: the caster of the bench where a faulty toe or camber channel
    contradicts it, repeats that differ in a hole."""
    faulty = any(
        f.kind in ("sign", "sides", "columns", "unit") and ("toe" in f.channel or "camber" in f.channel)
        for f in findings
    )
    holes = {f.where for f in findings if f.kind == "gap"}
    return [
        f
        for f in findings
        if not (faulty and f.ident == "alignment.static.caster")
        and not (f.kind == "repeat" and f.where in holes)
    ]


__all__ = ["CHECKS", "RecordFinding", "RigTest", "accepted", "check_test"]
