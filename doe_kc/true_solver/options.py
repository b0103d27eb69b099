"""The `[solver]` table of a study."""

from __future__ import annotations

from pydantic import Field, field_validator, model_validator

from doe_kc.ground.errors import nearest
from doe_kc.ground.fields import Positive, Strict
from doe_kc.load_cases import LOAD_CASES


class SolverOptions(Strict):
    """command: an outside solver as a list of words; the package's own when empty.

    timeout: seconds granted to one run of it. load_cases: those that the command gives curves of, all of
    the axle's when empty. twin: axle file of the package's own model of the same axle, which gives slopes;
    true: the study's own axle, false: none. Without a command it means nothing.
    """

    command: list[str] = Field(default=[])
    timeout: Positive = 3600.0
    load_cases: list[str] = Field(default=[])
    twin: bool | str = True

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

    @field_validator("twin", mode="before")
    @classmethod
    def _is_a_file_or_a_switch(cls, twin: object) -> object:
        if not isinstance(twin, bool | str):
            raise ValueError("expected the path of an axle file, true or false")
        if isinstance(twin, str) and (not twin or "\0" in twin):
            raise ValueError("is no path; name an axle file, or write twin = false")
        return twin

    @model_validator(mode="after")
    def _twin_has_an_outside_model(self) -> SolverOptions:
        if isinstance(self.twin, str) and not self.command:
            raise ValueError("twin names the twin of an outside model; add command, or drop twin")
        return self
