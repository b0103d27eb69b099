"""The `[tolerance]` table of a study."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from doe_kc.ground.fields import Finite, NotNegative, Positive, Strict

LawId = Literal["normal", "truncated_normal", "uniform"]
Share = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
Coefficient = Annotated[float, Field(ge=-1, le=1, allow_inf_nan=False)]
FEWEST_CARS, MOST_CARS = 30, 1_000_000


class ScatterOptions(Strict):
    """What differs for the parameters whose path matches a glob; later entries win, key by key.

    sd: standard deviation between cars, in the parameter's unit. share: the same over the nominal value.
    tolerance: half width, in the parameter's unit: `limits` standard deviations of a normal, the cut of a
    truncated normal, the end of a uniform distribution. common: share of the variance that both sides have
    in common. A scatter of 0 holds the parameter.
    """

    match: str
    sd: NotNegative | None = None
    share: NotNegative | None = None
    tolerance: NotNegative | None = None
    distribution: LawId | None = None
    limits: Positive | None = None
    common: Share | None = None

    @model_validator(mode="after")
    def _one_size(self) -> ScatterOptions:
        if sum(v is not None for v in (self.sd, self.share, self.tolerance)) > 1:
            raise ValueError("give one of sd, share and tolerance, not several")
        return self


class ScatterCorrelationOptions(Strict):
    """Correlation between the deviations of every two parameters that match one of the globs, on the same
    side; later entries win."""

    match: Annotated[list[str], Field(min_length=1)]
    value: Coefficient


class RequirementOptions(Strict):
    """low <= characteristic <= high, one of the two at least, in its unit; later entries win."""

    match: str
    low: Finite | None = None
    high: Finite | None = None

    @model_validator(mode="after")
    def _limits(self) -> RequirementOptions:
        if self.low is None and self.high is None:
            raise ValueError("give low, high or both")
        if self.low is not None and self.high is not None and not self.low < self.high:
            raise ValueError(f"low = {self.low:g} is not below high = {self.high:g}")
        return self


class ToleranceOptions(Strict):
    """samples: cars of the Monte Carlo. parameters: globs of those that scatter, among those that scatter by
    kind. distribution, limits, common: of all that no entry of `scatter` says otherwise of. cars: folders of
    measured cars, relative to the study, by default its measurement.
    """

    samples: Annotated[int, Field(ge=FEWEST_CARS, le=MOST_CARS)] = 1000
    parameters: list[str] = Field(default=["*"], min_length=1)
    distribution: LawId = "truncated_normal"
    limits: Positive = 3.0
    common: Share = 0.5
    scatter: list[ScatterOptions] = Field(default=[])
    correlation: list[ScatterCorrelationOptions] = Field(default=[])
    requirement: list[RequirementOptions] = Field(default=[])
    cars: list[str] | None = None
