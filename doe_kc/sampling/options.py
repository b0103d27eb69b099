"""The `[sampling]` table of a study."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from doe_kc.ground.fields import Strict


class SamplingOptions(Strict):
    """method: id of a registered sampler; n: number of designs, for the methods that take one.

    levels: of each variable in a full factorial. table: CSV or Excel file of designs, relative to the study.
    """

    method: str = "lhs"
    n: Annotated[int, Field(ge=1)] = 100
    levels: Annotated[int, Field(ge=2)] = 3
    table: str | None = None
