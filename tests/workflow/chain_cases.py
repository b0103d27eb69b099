"""The chain on small cars, each searched once for all tests."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from doe_kc.characteristics import reduce_all
from doe_kc.discovery.options import DiscoveryOptions
from doe_kc.measurement.reduction import GradientEstimate
from doe_kc.study import Study, read_study
from doe_kc.workflow.answer import Answer
from doe_kc.workflow.chain import follow_chain
from doe_kc.workflow.correlate import correlate
from doe_kc.workflow.measure import Reduced
from tests.discovery.cases import AXLE, TUNABLE, discovery, nominal, records

STUDY = f"""
name = "Small car"
axle = {str(AXLE)!r}
measurement = "none"
[variables]
use = {TUNABLE}
"""


def study(folder: Path, adopt: str | list[str] = "auto") -> Study:
    """Of the small cars: four load cases, thirteen variables."""
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    return replace(read_study(folder), axle=nominal(), discovery=DiscoveryOptions(adopt=adopt))


@cache
def answer(car: str, adopt: str = "auto") -> Answer:
    """What the chain says of a car."""
    with tempfile.TemporaryDirectory() as folder:
        return follow_chain(
            study(Path(folder), adopt),
            reduced(car),
            discover=lambda *_: discovery(car),
            correlate=lambda s, r, a: correlate(s, r, adoption=a, workers=1),
        )


def reduced(car: str) -> Reduced:
    """The car's records, their characteristics read off their own curves."""
    like = records(car)
    values = reduce_all(like.curves)
    estimates = {
        name: GradientEstimate(values[name], e.sd)
        for name, e in like.characteristics.items()
        if np.isfinite(values[name])
    }
    nothing = {name: GradientEstimate(np.nan, np.nan) for name in like.characteristics}
    return Reduced(replace(like, characteristics={**nothing, **estimates}), None)
