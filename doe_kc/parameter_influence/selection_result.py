"""What a selection of variables finds: verdicts per parameter, forecast per characteristic."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from doe_kc.axle.design_parameters import Parameter

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class VariableAdvice:
    """What to do with one parameter; moves and bounds are in its unit.

    pivot: place in the order of choice, 1 first; None when fixed.
    influence: norm of its scaled sensitivities, in sd of the measurement per prior sd.
    strongest: the characteristic that it moves most in these terms.
    collinearity: 1 / sin of the angle to the span of the other variables in use; 1 = independent.
    partner: the used variable most alike, empty when there is none.
    posterior_ratio: sd after over sd before the measurement, all parameters free: 1 = nothing learnt.
    move: expected change from nominal to reach the target, 0 when fixed.
    at_bound: "lower", "upper" or "".
    lower, upper: suggested bounds, absolute; widened: they differ from the default.
    """

    parameter: Parameter
    verdict: str
    pivot: int | None
    influence: float
    strongest: str
    collinearity: float
    partner: str
    posterior_ratio: float
    move: float
    at_bound: str
    lower: float
    upper: float

    @property
    def used(self) -> bool:
        """Whether the correlation should free it."""
        return self.pivot is not None

    @property
    def widened(self) -> bool:
        """Whether the suggested bounds are wider than the default ones."""
        return (self.lower, self.upper) != (self.parameter.lower, self.parameter.upper)


@dataclass(frozen=True)
class CharacteristicForecast:
    """One characteristic, in its unit. expected: linear forecast with the used variables' moves."""

    characteristic: str
    unit: str
    baseline: float
    target: float
    sd: float
    expected: float

    @property
    def before(self) -> float:
        """(target - baseline) / sd."""
        return (self.target - self.baseline) / self.sd

    @property
    def after(self) -> float:
        """(target - expected) / sd: what the variables cannot reach within their bounds."""
        return (self.target - self.expected) / self.sd


@dataclass(frozen=True)
class Selection:
    """Verdicts in the order of choice, used ones first.

    singular_values: of the scaled sensitivities of all parameters, falling.
    rank: how many are not rounding.
    informed: how many exceed 1: directions that the measurement knows better than the prior.
    condition: largest over smallest singular value of the used variables' columns.
    """

    variables: tuple[VariableAdvice, ...]
    outcomes: tuple[CharacteristicForecast, ...]
    singular_values: tuple[float, ...]
    rank: int
    informed: int
    condition: float

    def to_frame(self) -> pd.DataFrame:
        """One row per parameter, in the order of choice."""
        rows = [
            {
                "parameter": v.parameter.path,
                "verdict": v.verdict,
                "pivot": v.pivot,
                "influence_sd": v.influence,
                "strongest": v.strongest,
                "collinearity": v.collinearity,
                "partner": v.partner,
                "posterior_ratio": v.posterior_ratio,
                "unit": v.parameter.unit,
                "nominal": v.parameter.nominal,
                "move": v.move,
                "at_bound": v.at_bound,
                "lower": v.lower,
                "upper": v.upper,
                "widened": v.widened,
            }
            for v in self.variables
        ]
        import pandas as pd

        return pd.DataFrame(rows).astype({"pivot": "Int64"})

    def outcome_frame(self) -> pd.DataFrame:
        """One row per characteristic: baseline, target, sd, expected, distance before and after."""
        import pandas as pd

        names = ("characteristic", "unit", "baseline", "target", "sd", "expected", "before", "after")
        return pd.DataFrame([{n: getattr(o, n) for n in names} for o in self.outcomes])
