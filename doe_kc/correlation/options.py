"""The `[correlation]` table of a study."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from doe_kc.ground.fields import Strict

Count = Annotated[int, Field(ge=1)]
Gradients = Literal["auto"] | bool
ObjectiveKind = Literal["measured", "thesis"]
SetFirst = Literal["ride_height", "static.toe", "static.camber"]


class CorrelationOptions(Strict):
    """method: id of a registered method. budget: true-solver evaluations, the baseline among them.

    objective: "measured" counts every measured characteristic and curve that the study does not take out;
    "thesis" the terms of equation 2.2 alone. Both hold what they do not count.
    until: "feasible" stops at the first design that meets every constraint.
    batch: candidates confirmed side by side in one round. first: designs of the opening sample, by
    default the method's own. gradients: whether `ego` learns the exact sensitivities of its best designs:
    "auto" where the solver gives them, true insists on it, false learns values alone. data: curves that
    `gauss_newton` fits: all that were measured, or those with an objective; never those switched off.
    set_first: parameters set from the records before the correlation. sampled: let designs of an earlier
    `sample` campaign count as known.
    """

    method: str = "ego"
    budget: Count = 100
    objective: ObjectiveKind = "measured"
    until: Literal["converged", "feasible"] = "converged"
    batch: Count = 1
    first: Count | None = None
    gradients: Gradients = "auto"
    data: Literal["all", "targets"] = "all"
    set_first: list[SetFirst] = Field(default=[])
    sampled: bool = True
