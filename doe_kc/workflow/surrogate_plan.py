"""What surrogates there are to fit: the models asked for, and the stored designs that they can learn from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.campaign.store import read_store
from doe_kc.ground.errors import InputError
from doe_kc.study import Study
from doe_kc.surrogates.designs import Designs, designs_in_space
from doe_kc.surrogates.models import SURROGATES, make
from doe_kc.surrogates.study import VALIDATION_DESIGNS, default_models, number_of_tasks


@dataclass(frozen=True)
class Plan:
    """designs: of the store. models: ids to fit. steps: of the progress."""

    designs: Designs
    models: tuple[str, ...]
    steps: int


def plan_surrogates(study: Study, models: Sequence[str] = ()) -> Plan:
    """What there is to fit; InputError for an unknown model, or saying how many designs are missing."""
    names = tuple(dict.fromkeys(models or study.surrogates.models))
    for name in names:
        make(name, "--models" if models else f"{study.source}: surrogates")
    designs = _designs(study)
    needed = _needed(names, study.space.dimension)
    if len(designs.x) < needed:
        raise InputError(_too_few(study, designs, needed))
    chosen = names or tuple(default_models(*designs.x.shape))
    return Plan(designs, chosen, number_of_tasks(chosen, len(designs.x), study.surrogates.folds))


def _designs(study: Study) -> Designs:
    if not study.store.is_file():
        return Designs((), np.zeros((0, study.space.dimension)), np.zeros((0, 0)), 0, 0)
    with read_store(study.store) as store:
        return designs_in_space(store, study.space, study.axle, study.windows)


def _needed(names: Sequence[str], variables: int) -> int:
    """Designs for the least demanding of the models."""
    fewest = [SURROGATES[n]().fewest(variables) for n in names]
    return max(VALIDATION_DESIGNS, min(fewest, default=0))


def _too_few(study: Study, designs: Designs, needed: int) -> str:
    lost = [
        text.format(n=n)
        for n, text in (
            (designs.failed, "{n} failed"),
            (designs.elsewhere, "{n} of other variables or bounds"),
        )
        if n
    ]
    more = f" (besides {' and '.join(lost)})" if lost else ""
    n = max(needed, 2 * study.space.dimension)
    return (
        f"{study.store}: holds {len(designs.x)} designs of the study's variables{more}, surrogates need at "
        f"least {needed} and do well with {n}; run doe-kc sample {study.source} --n {n} first."
    )
