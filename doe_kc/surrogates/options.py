"""The `[surrogates]` table of a study."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from doe_kc.ground.fields import Strict


class SurrogateOptions(Strict):
    """models: ids of the registered models to choose from, none = those fit for the number of designs."""

    models: list[str] = Field(default=[])
    folds: Annotated[int, Field(ge=2)] = 10
