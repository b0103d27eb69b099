"""The `[sampling]` table of a study."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from doe_kc.axle.schema import Strict


class SamplingOptions(Strict):
    """method: id of a registered sampler; n: number of designs; table: CSV or Excel file of designs."""

    method: str = "lhs"
    n: Annotated[int, Field(ge=1)] = 100
    table: str | None = None
