"""Types of the keys of user files."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Point = Annotated[list[Finite], Field(min_length=3, max_length=3)]
Pair = Annotated[list[Finite], Field(min_length=2, max_length=2)]


class Strict(BaseModel):
    """Unknown keys are errors, numbers are not read from strings."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)
