"""The `[influence]` table of a study."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from doe_kc.ground.fields import Strict

GlobalMethodId = Literal["morris", "sobol", "pawn"]


class InfluenceOptions(Strict):
    """parameters: globs over parameter paths, e.g. ["LLF.*", "llr.F?"].

    methods (key `global`): global sensitivities over the ranges of [variables], by registered methods; by
    default none. morris: trajectories, sobol: base samples, pawn: designs.
    """

    parameters: list[str] = Field(default=["*"])
    methods: list[GlobalMethodId] = Field(default=[], alias="global")
    morris: Annotated[int, Field(ge=4, le=100_000)] = 20
    sobol: Annotated[int, Field(ge=64, le=1_000_000)] = 256
    pawn: Annotated[int, Field(ge=50, le=1_000_000)] = 1000
