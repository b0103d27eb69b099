"""The `[solver]` table of a study."""

from __future__ import annotations

from pydantic import Field

from doe_kc.axle.schema import Positive, Strict


class SolverOptions(Strict):
    """command: an outside solver as a list of words; the package's own when empty.

    timeout: seconds granted to one run of it.
    """

    command: list[str] = Field(default=[])
    timeout: Positive = 3600.0
