"""The sizes of a found effect with their uncertainty, and what they do not say."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from doe_kc.discovery.fit import amplitude_estimates
from doe_kc.discovery.result import Discovery, Finding, ParameterEstimate
from doe_kc.discovery.thresholds import ONE_SIDED
from doe_kc.effects.hypothesis import Size
from doe_kc.ground.numbers import number, unit_words, with_sd

SIZE_LEVEL = 2.0
"""Standard deviations above zero from which a size that cannot be negative is told from none."""


@dataclass(frozen=True)
class FoundSize:
    """One number of a found effect. times: as a multiple of the typical size (shapes: sd off typical)."""

    size: Size
    estimate: ParameterEstimate
    times: float
    limit: float
    seen: bool

    @property
    def words(self) -> str:
        """`5012 ± 26 Nm/deg`, or the limit of one that cannot be told from none."""
        unit = unit_words(self.size.unit)
        if self.seen:
            return f"{with_sd(self.estimate.value, self.estimate.sd)}{unit}"
        limit = f"{number(self.limit)}{unit}"
        if self.size.growth == "compliance":
            return f"not told from rigid (above {limit}, 95 %)"
        return f"not told from none (below {limit}, 95 %)"

    @property
    def sentence(self) -> str:
        """The option's name with `words`."""
        return f"{self.size.name} {'= ' if self.seen else ''}{self.words}"


def found_sizes(discovery: Discovery, finding: Finding) -> Iterator[FoundSize]:
    """The numbers of a finding in the order of its hypothesis."""
    known = zip(*amplitude_estimates(discovery.fitted, finding.hypothesis), strict=True)
    for size, estimate, (amplitude, sd) in zip(
        finding.hypothesis.sizes, finding.estimates, known, strict=True
    ):
        one_sided = not (size.signed or size.shape or size.growth == "factor")
        yield FoundSize(
            size,
            estimate,
            float(amplitude),
            size.value(float(amplitude + ONE_SIDED * sd)),
            bool(not one_sided or amplitude >= SIZE_LEVEL * sd),
        )


def size_words(discovery: Discovery, finding: Finding) -> str:
    """All sizes of a finding in one line."""
    return "; ".join(s.sentence for s in found_sizes(discovery, finding))
