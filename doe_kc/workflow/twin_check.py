"""Whether the twin of an outside model has the numbers that the study's axle file has."""

from __future__ import annotations

from collections.abc import Iterator

from doe_kc.ground.listing import first_of
from doe_kc.study import Study

SAME = 1e-6
"""Relative difference up to which two nominal values are one, written with other digits."""
TWIN_NAMES = 4
"""Numbers that a sentence names."""


def twin_differences(study: Study) -> Iterator[str]:
    """A sentence on numbers of the twin that are missing or others in the study's axle file, which is what is
    known of the outside model.

    A variable is set to the same value in both models; what is none keeps the difference. No sentence for
    a twin that is the study's own axle.
    """
    if study.twin is None or study.twin_path == study.axle_path:
        return
    ours, twin = study.axle.values, study.twin.values
    lacking = _named([n for n in ours if n not in twin])
    other = [n for n in ours if n in twin and abs(twin[n] - ours[n]) > SAME * max(abs(twin[n]), abs(ours[n]))]
    place = f"{study.source}: solver.twin {study.twin_path.name}"
    if lacking:
        names = first_of(lacking, TWIN_NAMES)
        yield f"{place}: lacks {names}, which the study's axle has; expected the same axle."
    if other:
        pairs = {_plain(n): f"{_plain(n)} {twin[n]:g} for {ours[n]:g}" for n in other}
        values = first_of(list(pairs.values()), TWIN_NAMES)
        yield f"{place}: {values} in the study's axle; mend the file that is wrong."


def _plain(name: str) -> str:
    """The name without its side."""
    return name.split("@")[0]


def _named(names: list[str]) -> list[str]:
    return list(dict.fromkeys(_plain(n) for n in names))
