"""What a discovery found: the verdict and all that stands behind it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from doe_kc.discovery.adequacy import Adequacy
from doe_kc.discovery.contrasts import Contrast
from doe_kc.discovery.disagreement import Map
from doe_kc.discovery.exclusion import HypothesisStatus
from doe_kc.discovery.extra_test import ExtraTest
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.held_out import HeldOut
from doe_kc.discovery.scan import Scan
from doe_kc.discovery.search import EffectSearch
from doe_kc.discovery.trials import HypothesisFit
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray

VerdictKind = Literal["named", "class", "none", "unexplained"]


@dataclass(frozen=True)
class ParameterEstimate:
    """A number of an effect, as in its table. index: place in a list option, None for a number."""

    key: str
    index: int | None
    value: float
    sd: float
    unit: str


@dataclass(frozen=True)
class Rival:
    """Another effect that could be the one named, with its probability."""

    effect: str
    probability: float


@dataclass(frozen=True)
class Finding:
    """An effect that the data ask for.

    All is judged beside the other effects of the final set. probability: that it is this effect, in whatever
    place, among it, none at all, and its rivals in its place, each refitted. log10_odds: of the effect
    against the best of those, `against`: the id of a rival, empty for none at all. rivals: most probable
    first. gain: ln of the evidence over the set without it. detectability: standard deviations that it makes
    after re-tuning. wrong_name: chance that noise names its closest rival instead. alike: effects that the
    records hardly tell from it, whatever their odds. largest: its largest amplitude, in typical sizes.
    believed: whether that is not surely too large. relevant: whether it is worth naming. elsewhere: other
    places that explain the records about as well.
    """

    hypothesis: Hypothesis
    estimates: tuple[ParameterEstimate, ...]
    probability: float
    log10_odds: float
    against: str
    rivals: tuple[Rival, ...]
    gain: float
    detectability: float
    wrong_name: float
    alike: tuple[str, ...]
    largest: float
    believed: bool
    relevant: bool
    elsewhere: tuple[str, ...] = ()


@dataclass(frozen=True)
class Gap:
    """Whitened RMS of all records' deviations; 1 is noise. best_decoy: of the best other effect, nan
    without one."""

    nominal: float
    tuned: float
    with_effect: float
    noise_floor: float
    best_decoy: float


@dataclass(frozen=True)
class CurveGap:
    """The gap of one response in one load case, both branches and wheels."""

    load_case: str
    response: str
    gap: Gap


@dataclass(frozen=True)
class Returned:
    """A parameter's distance from nominal in standard deviations of its prior, before and after."""

    path: str
    nominal: float
    tuned: float
    with_effect: float
    unit: str
    tuned_distance: float
    with_effect_distance: float


@dataclass(frozen=True, repr=False)
class Discovery:
    """verdict: named, class (one of several), none (none needed) or unexplained.

    findings: effects worth naming, largest first; leads where the verdict is unexplained. traces: effects
    that the data show but too small to matter; of the rig only where the set holds. sentences: the verdict in
    words. adequacy: whether the final set explains the records. raw: map of the nominal axle; tuned: after
    re-tuning; final: with the effects. nominal: (M,) residual of the nominal axle.
    scan: places of the generic scan at the re-tuned axle, None where noise explains what remains there.
    widened: by how much all ranges of the parameters are wider than the study's, 1 where the records do not
    ask for that; beyond: paths of the parameters that the final axle has outside the study's. separating: of
    the first effect of a class and each other one, load cases that tell them apart, best first.
    """

    verdict: VerdictKind
    sentences: tuple[str, ...]
    findings: tuple[Finding, ...]
    traces: tuple[Finding, ...]
    classes: tuple[tuple[str, ...], ...]
    statuses: tuple[HypothesisStatus, ...]
    unexplained: tuple[tuple[Contrast, float], ...]
    adequacy: Adequacy
    search: EffectSearch
    decoy: HypothesisFit | None
    nominal: FloatArray
    raw: Map
    tuned: Map
    final: Map
    gap: Gap
    gaps: tuple[CurveGap, ...]
    held_out: tuple[HeldOut, ...]
    returned: tuple[Returned, ...]
    next_tests: tuple[str, ...]
    seconds: float
    scan: Scan | None = None
    widened: float = 1.0
    beyond: tuple[str, ...] = ()
    separating: Mapping[tuple[str, str], tuple[ExtraTest, ...]] = field(default_factory=dict)

    @property
    def fitted(self) -> Fit:
        """The most probable axle, with the effects."""
        return self.search.plain

    @property
    def held_out_by_case(self) -> Mapping[str, HeldOut]:
        """Load case -> its prediction."""
        return {h.load_case: h for h in self.held_out}
