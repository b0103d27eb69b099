"""One design variable: a parameter with bounds, start, resolution and distribution."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.axle.design_parameters import Parameter
from doe_kc.ground.typing import FloatArray
from doe_kc.variables.options import Distribution

GAUSSIAN_RANGE = 6.0
"""Standard deviations between the bounds of a Gaussian variable."""


@dataclass(frozen=True, kw_only=True)
class Variable:
    """A parameter that is free between `lower` and `upper` (absolute, in the parameter's unit).

    start: value of the first design. levels: number of values between the bounds, None = continuous.
    logarithmic: equal steps are equal ratios (stiffnesses, rates). Inside the package a variable is its
    place u in [0, 1] between the bounds.
    """

    parameter: Parameter
    lower: float
    upper: float
    start: float
    levels: int | None
    distribution: Distribution
    logarithmic: bool

    @property
    def path(self) -> str:
        """The parameter's path."""
        return self.parameter.path

    @property
    def unit(self) -> str:
        """The parameter's unit."""
        return self.parameter.unit

    def started(self, value: float) -> Variable:
        """The variable about another start, its bounds shifted alike."""
        shift = value - self.start
        return replace(self, start=value, lower=self.lower + shift, upper=self.upper + shift)

    def widened(self, factor: float) -> Variable:
        """The variable with its range `factor` times as wide about its middle, for a ratio in logarithms.

        Bounds that are not below zero stay so, hardpoints' aside.
        """
        if self.logarithmic:
            stretch = (self.upper / self.lower) ** ((factor - 1.0) / 2.0)
            return replace(self, lower=self.lower / stretch, upper=self.upper * stretch)
        more = (factor - 1.0) / 2.0 * (self.upper - self.lower)
        lower = self.lower - more
        if self.lower >= 0.0 and self.parameter.quantity != "coordinate":
            lower = max(lower, self.lower / factor)
        return replace(self, lower=lower, upper=self.upper + more)

    def value(self, u: float) -> float:
        """Absolute value at u; at the start's place exactly the start, so that the baseline is the axle."""
        if u == self.place(self.start):
            return self.start
        if self.logarithmic:
            return float(self.lower * (self.upper / self.lower) ** u)
        return float(self.lower + (self.upper - self.lower) * u)

    def place(self, value: float) -> float:
        """u of an absolute value; outside [0, 1] when it is beyond the bounds."""
        if self.logarithmic:
            return math.log(value / self.lower) / math.log(self.upper / self.lower)
        return (value - self.lower) / (self.upper - self.lower)

    def slope(self, u: float) -> float:
        """d value / d u at u, parameter's unit."""
        if self.logarithmic:
            return self.value(u) * math.log(self.upper / self.lower)
        return self.upper - self.lower

    def snapped(self, u: float) -> float:
        """Nearest level."""
        if self.levels is None:
            return u
        return round(u * (self.levels - 1)) / (self.levels - 1)

    @property
    def prior_sd(self) -> float:
        """Standard deviation of u before any measurement: 1/sqrt(12) uniform, 1/6 Gaussian."""
        return 1.0 / GAUSSIAN_RANGE if self.distribution == "gaussian" else 1.0 / math.sqrt(12.0)

    @property
    def is_guess(self) -> bool:
        """Whether its bounds are all that is said of it, so that its scatter is a guess."""
        return self.distribution == "uniform"

    def drawn(self, probability: FloatArray) -> FloatArray:
        """u of cumulative probabilities in (0, 1): themselves, or a Gaussian about the start cut at 0, 1."""
        if self.distribution == "uniform":
            return probability
        centre, sd = self.place(self.start), self.prior_sd
        from scipy.special import ndtr, ndtri

        low, high = ndtr(-centre / sd), ndtr((1.0 - centre) / sd)
        return np.clip(centre + sd * ndtri(low + (high - low) * probability), 0.0, 1.0)
