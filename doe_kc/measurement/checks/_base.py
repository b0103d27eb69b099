"""What a check of rig records is: the whole test in, findings out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Literal

from doe_kc.curves import CurveSet
from doe_kc.measurement.branches import RunCurves
from doe_kc.measurement.channels import RIG_NAMES
from doe_kc.measurement.manifest import Manifest

Severity = Literal["error", "warning"]


@dataclass(frozen=True)
class RecordFinding:
    """Something that is wrong with a record, or looks so.

    kind: of fault, such as `outlier` or `sign`. case: load case, `*` for all. channel: as in the package's
    records (`toe_L`, `caster`, `pad_z`), `*` for all. where: file. evidence, cure: clauses of the message.
    unit: in which the channel is, where that is the fault.
    """

    kind: str
    severity: Severity
    case: str
    channel: str
    where: str
    evidence: str
    cure: str
    unit: str = ""

    @property
    def ident(self) -> str:
        """`kind.case.channel`, by which a test accepts it."""
        return f"{self.kind}.{self.case}.{self.channel}"

    @property
    def message(self) -> str:
        """One sentence: file, evidence, cure."""
        return f"{self.where}: {self.evidence}; {self.cure} [{self.ident}]."


@dataclass(frozen=True, eq=False)  # hashed as itself: what checks share is kept by it
class RigTest:
    """A test as it is checked. source: its `test.toml`. runs: load case -> reduced runs, main run first.

    model: curves of the axle that the records are meant to be of; None where it is not known.
    """

    source: Path
    manifest: Manifest
    runs: Mapping[str, tuple[RunCurves, ...]]
    model: CurveSet | None = None

    def resolution(self, response: str) -> float:
        """Of the sensor of a response, deg, mm or N."""
        sensors = self.manifest.sensor_resolution
        if response.startswith("wc"):
            return sensors.displacement_mm
        return sensors.tyre_load_N if response == "tyre_load" else sensors.angle_deg


Check = Callable[[RigTest], Iterator[RecordFinding]]
CHECKS: dict[str, Check] = {}
"""Every check by the name of its module, in the order in which findings are told."""


def rig_check(check: Check) -> Check:
    """Register a check under the name of its module."""
    CHECKS[check.__module__.rpartition(".")[2]] = check
    return check


def channel_name(response: str, side: int | None = None) -> str:
    """`caster_L` of ("spin", 0): as records name it."""
    name = RIG_NAMES[response]
    return name if side is None else f"{name}_{'LR'[side]}"


def accepted(finding: RecordFinding, globs: tuple[str, ...]) -> bool:
    """Whether the test's `accept` names it."""
    return any(fnmatchcase(finding.ident, glob) for glob in globs)
