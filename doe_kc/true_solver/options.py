"""The `[solver]` table of a study."""

from __future__ import annotations

from pydantic import Field, field_validator

from doe_kc.ground.errors import nearest
from doe_kc.ground.fields import Positive, Strict
from doe_kc.load_cases import LOAD_CASES


class SolverOptions(Strict):
    """command: an outside solver as a list of words; the package's own when empty.

    timeout: seconds granted to one run of it. load_cases: those that the command gives curves of, all of
    the axle's when empty.
    """

    command: list[str] = Field(default=[])
    timeout: Positive = 3600.0
    load_cases: list[str] = Field(default=[])

    @field_validator("command")
    @classmethod
    def _has_words(cls, command: list[str]) -> list[str]:
        if any(not word or "\0" in word for word in command):
            raise ValueError("a word of the command is empty")
        return command

    @field_validator("load_cases")
    @classmethod
    def _are_known(cls, cases: list[str]) -> list[str]:
        for case in cases:
            if case not in LOAD_CASES:
                known = ", ".join(LOAD_CASES)
                raise ValueError(f"{case} is no load case; known are {known}.{nearest(case, LOAD_CASES)}")
        return cases
