"""The `[surrogates]` table of a study."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from doe_kc.ground.fields import Strict

GOAL = 0.99
"""Q2 of an error of a tenth of the spread."""


class SurrogateOptions(Strict):
    """models: ids of the registered models to choose from, none = those fit for the number of designs.

    folds: of the cross-validation, none = ten, five from 150 designs on. slopes: whether the package's own
    solver gives exact sensitivities at the start for `gp_slopes`, at the cost of some five designs.
    goal: Q2 that the learning curve says the number of designs for.
    """

    models: list[str] = Field(default=[])
    folds: Annotated[int, Field(ge=2)] | None = None
    slopes: bool = True
    goal: Annotated[float, Field(gt=0.0, lt=1.0)] = GOAL
