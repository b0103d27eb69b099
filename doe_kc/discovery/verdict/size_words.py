"""The numbers of an effect in words, the same in every sentence, table and page."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from doe_kc.discovery.result import Finding, ParameterEstimate
from doe_kc.effects.hypothesis import Size
from doe_kc.ground.numbers import number, unit_words, with_sd


@dataclass(frozen=True)
class SizeEstimate:
    """One number of an effect that a discovery tells."""

    size: Size
    estimate: ParameterEstimate

    @property
    def seen(self) -> bool:
        """Whether the records tell it from none."""
        return self.estimate.limit is None and self.estimate.shown

    @property
    def words(self) -> str:
        """`5012 ± 26 Nm/deg`, or the limit of one that cannot be told from none, or that it is not shown."""
        unit = unit_words(self.size.unit)
        if not self.estimate.shown:
            return "not shown by these records"
        if self.estimate.limit is None:
            return f"{with_sd(self.estimate.value, self.estimate.sd)}{unit}"
        limit = f"{number(self.estimate.limit)}{unit}"
        if self.size.growth == "compliance":
            return f"not told from rigid (above {limit}, 95 %)"
        return f"not told from none (below {limit}, 95 %)"

    @property
    def sentence(self) -> str:
        """The option's name with `words`."""
        return f"{self.size.name} {'= ' if self.seen else ''}{self.words}"


def size_estimates(finding: Finding) -> Iterator[SizeEstimate]:
    """The numbers of a finding in the order of its hypothesis."""
    for size, own in zip(finding.hypothesis.sizes, finding.estimates, strict=True):
        yield SizeEstimate(size, own)


def told_sizes(finding: Finding) -> Iterator[SizeEstimate]:
    """Those that a reader can use: without the sliders of a free law, which mean nothing one by one."""
    return (s for s in size_estimates(finding) if not (s.size.shape and s.size.index is not None))


def size_words(finding: Finding) -> str:
    """The sizes of a finding in one line."""
    return "; ".join(s.sentence for s in told_sizes(finding))
