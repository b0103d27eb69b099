"""The result of a discovery: the verdict and its evidence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screening.contrasts import Contrast
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.screening.scan import Scan
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.verdict.adequacy import Adequacy
from doe_kc.discovery.verdict.exclusion import HypothesisStatus
from doe_kc.discovery.verdict.extra_test import ExtraTest
from doe_kc.discovery.verdict.held_out import HeldOut
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray

FindingVerdict = Literal["named", "class", "lead"]
VerdictKind = Literal["named", "class", "none", "unexplained"]


@dataclass(frozen=True)
class ParameterEstimate:
    """A number of an effect, as in its table of the axle file."""

    key: str
    """Key of the option."""
    index: int | None
    """Place in a list option, None for a number."""
    value: float
    """The number, in `unit`."""
    sd: float
    """Its standard deviation, in `unit`."""
    unit: str
    """Unit of the option; `-` without one."""
    limit: float | None = None
    """What a number that the records do not tell from none is at most (of a stiffness: at least), in `unit`,
    by the records alone with a confidence of 95 %; None where they do tell, where it may be of either sign,
    and where they do not show it."""
    shown: bool = True
    """Whether the records say more of it than what such a part has before them."""


@dataclass(frozen=True)
class Rival:
    """Another effect that could be the one named."""

    effect: str
    """Its id."""
    probability: float
    """That it is this one, 0 to 1."""


@dataclass(frozen=True)
class Finding:
    """An effect that the data ask for, judged beside the other effects of the last set."""

    hypothesis: Hypothesis
    """The effect in its place."""
    estimates: tuple[ParameterEstimate, ...]
    """Its numbers."""
    probability: float
    """That it is this effect, in whatever place, among it, none at all, and its rivals in its place, each
    refitted, less the chance that something outside the library has taken its place; of a trace among those
    alone."""
    log10_odds: float
    """log10 of the odds of the effect against the best of those, `against`."""
    against: str
    """Id of the rival with the largest probability, empty for none at all."""
    rivals: tuple[Rival, ...]
    """Other effects in its place, the most probable first."""
    gain: float
    """ln of the evidence over that of the set without it."""
    detectability: float
    """Standard deviations that it makes after re-tuning."""
    wrong_name: float
    """Chance that noise names its closest rival instead."""
    alike: tuple[str, ...]
    """Ids of effects that the records hardly tell from it, whatever their odds."""
    largest: float
    """Its largest amplitude, in typical sizes."""
    believed: bool
    """Whether no size is surely larger than such a part has."""
    seen: bool
    """Whether the records tell one of its sizes from none."""
    relevant: bool
    """Whether it is worth naming; a trace otherwise."""
    small: bool = True
    """Whether it is not surely more than a trace, as every car has."""
    elsewhere: tuple[str, ...] = ()
    """Other places of the same effect that explain the records about as well."""
    verdict: FindingVerdict = "lead"
    """named; class, one of several that cannot be told apart; or lead, where something remains unexplained
    that could be this effect's doing or that this effect could stand for. A trace is a lead."""


@dataclass(frozen=True)
class Gap:
    """Whitened RMS of all records' deviations; 1 is noise."""

    nominal: float
    """Of the axle as it is in the file."""
    tuned: float
    """Of the re-tuned axle without an effect."""
    with_effect: float
    """Of the re-tuned axle with the effects."""
    noise_floor: float
    """Expected of the right model: sqrt(1 - parameters used / data)."""
    best_decoy: float
    """Of the best other effect in place of the largest finding; nan without one."""


@dataclass(frozen=True)
class CurveGap:
    """The gap of one response in one load case, both branches and wheels."""

    load_case: str
    """Id of the load case."""
    response: str
    """Id of the response."""
    gap: Gap
    """Its whitened RMS; the noise floor is 1."""


@dataclass(frozen=True, repr=False)
class Discovery:
    """The verdict on one car and its evidence."""

    verdict: VerdictKind
    """named, class (one of several), none (no effect needed) or unexplained."""
    sentences: tuple[str, ...]
    """The verdict in words."""
    findings: tuple[Finding, ...]
    """Effects worth naming, the most detectable first; leads where the verdict is unexplained."""
    traces: tuple[Finding, ...]
    """Effects that the data show but too small to matter, or too weakly to be named; of the rig only where
    the set is adequate."""
    classes: tuple[tuple[str, ...], ...]
    """Ids of effects that the records do not tell apart, one group for each ambiguous finding."""
    statuses: tuple[HypothesisStatus, ...]
    """Of every hypothesis that is in the set or can come in beside it: found, a trace, excluded, unresolved,
    not testable or without an equilibrium."""
    unexplained: tuple[tuple[Contrast, float], ...]
    """The largest disagreements that remain, in standard deviations; empty unless unexplained."""
    adequacy: Adequacy
    """Whether the last set of effects explains the records."""
    search: EffectSearch
    """The steps of the search and its fits."""
    decoy: HypothesisFit | None
    """The best refit of another effect in place of the largest finding, None without one."""
    nominal: FloatArray
    """(M,) residual of the nominal axle, in standard deviations of the records."""
    nominal_map: Map
    """Disagreement of the nominal axle as it is, in units of the records' noise."""
    tuned_map: Map
    """Disagreement of the re-tuned axle without an effect, beyond what re-tuning can absorb."""
    residual_map: Map
    """Disagreement of the axle with the effects, beyond what re-tuning and their sizes can absorb."""
    gap: Gap
    """Whitened RMS of all records."""
    gaps: tuple[CurveGap, ...]
    """The same of every load case and response."""
    held_out: tuple[HeldOut, ...]
    """Every load case predicted from all others; empty without a finding."""
    next_tests: tuple[str, ...]
    """Tests that would separate a class, confirm a name or show what is not testable, in words."""
    seconds: float
    """Wall time of the discovery, s."""
    scan: Scan | None = None
    """Generic scan at the re-tuned axle, None where noise explains what remains there."""
    widened: float = 1.0
    """Factor by which all ranges of the parameters are wider than the study's; 1 unless the records ask."""
    beyond: tuple[str, ...] = ()
    """Paths of the parameters whose values are outside the study's bounds."""
    separating: Mapping[tuple[str, str], tuple[ExtraTest, ...]] = field(default_factory=dict)
    """Of the first effect of a class and each other one: load cases that tell them apart, best first."""

    @property
    def fitted(self) -> Fit:
        """The most probable axle, with the effects."""
        return self.search.with_effects
