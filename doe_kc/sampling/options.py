"""The `[sampling]` table of a study."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field, model_validator

from doe_kc.ground.fields import Finite, Strict
from doe_kc.sampling.constraints import LinearConstraint


class ConstraintOptions(Strict):
    """low <= sum of factor times parameter <= high, one of the two at least; factors by path of a variable,
    parameters absolute in their units."""

    factors: Annotated[dict[str, Finite], Field(min_length=1)]
    low: Finite | None = None
    high: Finite | None = None

    @model_validator(mode="after")
    def _bounds(self) -> ConstraintOptions:
        if self.low is None and self.high is None:
            raise ValueError("give low, high or both")
        if self.low is not None and self.high is not None and self.low > self.high:
            raise ValueError(f"low = {self.low:g} is above high = {self.high:g}")
        return self

    def build(self) -> LinearConstraint:
        """The constraint."""
        return LinearConstraint(
            tuple(self.factors.items()),
            -math.inf if self.low is None else self.low,
            math.inf if self.high is None else self.high,
        )


class SamplingOptions(Strict):
    """method: id of a registered sampler; n: number of designs, for the methods that take one.

    levels: of each variable in a full factorial. table: CSV or Excel file of designs, relative to the study.
    constraint: between parameters of a design; the sampler alone keeps them.
    """

    method: str = "lhs"
    n: Annotated[int, Field(ge=1)] = 100
    levels: Annotated[int, Field(ge=2)] = 3
    table: str | None = None
    constraint: list[ConstraintOptions] = Field(default=[])
