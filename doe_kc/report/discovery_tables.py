"""The tables of a discovery: disagreement, library, gap, load cases held out, parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from doe_kc.discovery.result import Discovery
from doe_kc.discovery.verdict.exclusion import HypothesisStatus
from doe_kc.effects import EFFECTS
from doe_kc.report.discovery_words import (
    STATUS_WORDS,
    effect_label,
    hypothesis_label,
    limit_words,
    mistaken_words,
    place_of,
    typical_words,
)


@dataclass(frozen=True)
class DisagreementRow:
    """One contrast; z in standard deviations, nan where re-tuning absorbs it wholly, + = model above.

    z_nominal counts the noise alone; the others what re-tuning cannot absorb; nan without an effect.
    """

    load_case: str
    response: str
    shape: str
    wheels: str
    z_nominal: float
    z_tuned: float
    z_with_effect: float


def disagreement_rows(discovery: Discovery) -> list[DisagreementRow]:
    """Every contrast of the records."""
    after = (
        discovery.residual_map.z
        if discovery.fitted.model.members
        else np.full(len(discovery.residual_map.names), np.nan)
    )
    return [
        DisagreementRow(
            c.load_case, c.response, c.shape, c.wheels,
            float(discovery.nominal_map.z[i]), float(discovery.tuned_map.z[i]), float(after[i]),
        )
        for i, c in enumerate(discovery.nominal_map.names)
    ]  # fmt: skip


def disagreement_frame(discovery: Discovery) -> pd.DataFrame:
    """One row a contrast, as `DisagreementRow`."""
    return pd.DataFrame([vars(r) for r in disagreement_rows(discovery)])


def library_frame(discovery: Discovery) -> pd.DataFrame:
    """One row a hypothesis, found ones first; detectable in words and as a multiple of the typical size."""
    labels = {s.hypothesis.name: hypothesis_label(s.hypothesis) for s in discovery.statuses}
    return pd.DataFrame([_library(s, labels) for s in ordered_standings(discovery)])


STATUS_ORDER = tuple(STATUS_WORDS)


def ordered_standings(discovery: Discovery) -> list[HypothesisStatus]:
    """By status, then in the order of the library."""
    order = list(EFFECTS)
    return sorted(
        discovery.statuses,
        key=lambda s: (
            STATUS_ORDER.index(s.status),
            order.index(s.hypothesis.effect),
            s.hypothesis.name,
        ),
    )


def _library(standing: HypothesisStatus, labels: Mapping[str, str]) -> dict[str, object]:
    h = standing.hypothesis
    return {
        "effect": h.effect,
        "label": effect_label(h.effect),
        "place": place_of(h),
        "status": standing.status,
        "detectable": limit_words(standing),
        "detectable_times_typical": standing.detectable,
        "typical": typical_words(h),
        "absorbed_percent": 100.0 * standing.absorbed,
        "hidden_by": hidden_words(standing),
        "parts_to_measure": bench_words(standing),
        "looks_like": alike_words(standing, labels),
        "mistaken_for": mistaken_words(h.effect),
        "physics": EFFECTS[h.effect].physics,
        "shown_by": EFFECTS[h.effect].shown_by,
    }


def hidden_words(standing: HypothesisStatus) -> str:
    """Parameters that take the effect's place, with their move in standard deviations of the prior."""
    return ", ".join(f"{path} ({move:+.1f} sd)" for path, move in standing.hidden_by)


def bench_words(standing: HypothesisStatus) -> str:
    """Parts that a bench has to measure for the effect to show, and by how much it then does."""
    test = standing.component_test
    return "" if test is None else f"{', '.join(test.parts)} ({test.separation:.0f} sd)"


def alike_words(standing: HypothesisStatus, labels: Mapping[str, str]) -> str:
    """Hypotheses whose remaining change is the same, with the correlation. labels: by their names."""
    return "; ".join(f"{labels.get(name, name)} ({r:+.2f})" for name, r in standing.alike)


def gap_frame(discovery: Discovery) -> pd.DataFrame:
    """Whitened RMS of all records, then of each load case and response; 1 is noise."""
    rows = [{"load_case": "all", "response": "all"} | vars(discovery.gap)]
    rows += [{"load_case": g.load_case, "response": g.response} | vars(g.gap) for g in discovery.gaps]
    frame = pd.DataFrame(rows)
    if not discovery.fitted.model.members:
        frame["with_effect"] = math.nan
    return frame[["load_case", "response", "nominal", "tuned", "with_effect", "best_decoy", "noise_floor"]]


def held_out_frame(discovery: Discovery) -> pd.DataFrame:
    """One row a load case that was left out of the fit; RMS in sd of the prediction, gain in ln density."""
    columns = ["load_case", "rms_tuned", "rms_with_effect", "rms_law_granted", "gain_ln_density"]
    rows = [
        (h.load_case, h.tuned.rms, h.with_effect.rms, h.law_granted.rms, h.gain) for h in discovery.held_out
    ]
    return pd.DataFrame(rows, columns=columns)


@dataclass(frozen=True)
class TunedParameter:
    """A tunable parameter, values absolute in `unit`; sd: of the final value; distances from nominal in
    standard deviations of its prior, nan with effects where there are none; beyond: whether the last value is
    outside the study's bounds."""

    path: str
    label: str
    group: str
    unit: str
    nominal: float
    tuned: float
    with_effect: float
    sd: float
    tuned_distance: float
    with_effect_distance: float
    beyond: bool

    @property
    def moved(self) -> float:
        """Largest distance from nominal, sd of the prior."""
        return float(np.nanmax(np.abs([self.tuned_distance, self.with_effect_distance])))


def tuned_parameters(discovery: Discovery) -> list[TunedParameter]:
    """In the order of the variables."""
    tuned, final = discovery.search.tuned, discovery.fitted
    model = final.model
    has_effect = bool(model.members)
    sd = np.sqrt(np.diag(final.covariance))
    out = []
    for i, v in enumerate(model.space.variables):
        start, one, two = model.centre[i], tuned.z[i], final.z[i]
        out.append(
            TunedParameter(
                path=v.path,
                label=v.parameter.label,
                group=v.parameter.group,
                unit=v.unit,
                nominal=v.start,
                tuned=v.value(one),
                with_effect=v.value(two) if has_effect else math.nan,
                sd=float(sd[i]) * v.slope(two),
                tuned_distance=float((one - start) / model.prior_sd[i]),
                with_effect_distance=float((two - start) / model.prior_sd[i]) if has_effect else math.nan,
                beyond=v.path in discovery.beyond,
            )
        )
    return out


def parameter_frame(discovery: Discovery) -> pd.DataFrame:
    """One row a tunable parameter, as `TunedParameter`."""
    return pd.DataFrame([vars(p) for p in tuned_parameters(discovery)])
