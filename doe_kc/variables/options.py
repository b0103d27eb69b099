"""The `[variables]` table of a study."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from doe_kc.ground.fields import Finite, Pair, Strict

Levels = Annotated[int, Field(ge=2, le=1_000_001)] | Literal["continuous"]
Distribution = Literal["uniform", "gaussian"]


class Change(Strict):
    """What differs for the variables whose path matches a glob; later entries win.

    offset, factor: bounds relative to the axle's value; range: absolute bounds. start, fixed: absolute.
    tie: path that these follow by the same offset (positions, angles) or ratio (stiffnesses).
    """

    match: str
    offset: Pair | None = None
    factor: Pair | None = None
    range: Pair | None = None
    levels: Levels | None = None
    distribution: Distribution | None = None
    start: Finite | None = None
    fixed: Finite | None = None
    tie: str | None = None

    @model_validator(mode="after")
    def _one_of_each(self) -> Change:
        if sum(b is not None for b in (self.offset, self.factor, self.range)) > 1:
            raise ValueError("give one of offset, factor and range, not several")
        if self.fixed is not None and self.tie is not None:
            raise ValueError("a variable is either fixed or tied, not both")
        for name in ("offset", "factor", "range"):
            pair = getattr(self, name)
            if pair is not None and not pair[0] < pair[1]:
                raise ValueError(f"{name} = [{pair[0]:g}, {pair[1]:g}]: the lower bound comes first")
        return self


class VariableOptions(Strict):
    """use: globs over parameter paths, or "selection" for those that the influence study advises."""

    use: list[str] | Literal["selection"] = Field(default=["*"])
    leave_out: list[str] = Field(default=[])
    levels: Levels = "continuous"
    distribution: Distribution = "uniform"
    change: list[Change] = Field(default=[])
