"""Rig records checked by physics: `check_test` runs every check on a test."""

from __future__ import annotations

import sys
from dataclasses import replace

from doe_kc.ground.registry import import_members
from doe_kc.measurement.checks._base import CHECKS, Finding, RigTest, accepted

import_members(sys.modules[__name__])


def check_test(test: RigTest) -> tuple[Finding, ...]:
    """Findings of all checks, errors first. What the test's `accept` names is a warning at most."""
    globs = test.manifest.checks.accept
    findings = [
        replace(f, severity="warning") if accepted(f, globs) else f
        for check in CHECKS.values()
        for f in check(test)
    ]
    return tuple(sorted(_first_causes(findings), key=lambda f: f.severity))


def _first_causes(findings: list[Finding]) -> list[Finding]:
    """Without the caster of the bench where a faulty toe or camber channel contradicts it."""
    faulty = any(
        f.kind in ("sign", "sides", "columns", "unit") and ("toe" in f.channel or "camber" in f.channel)
        for f in findings
    )
    return [f for f in findings if not (faulty and f.kind == "alignment" and f.channel == "caster")]


__all__ = ["CHECKS", "Finding", "RigTest", "accepted", "check_test"]
