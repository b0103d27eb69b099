"""Opens the keys once all answers are in, and scores them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from benchmarks.discovery.answer import read_answer
from benchmarks.discovery.cases import Case, case_folder, unseal
from benchmarks.discovery.detectability import detectability
from benchmarks.discovery.generator import RECORDS, HiddenCar
from benchmarks.discovery.running import stored, stored_followup
from benchmarks.discovery.scoring import Predicted, Score, score
from benchmarks.discovery.truth import read_truth
from doe_kc.campaign.executors import processes
from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.measurement import reduce_measurement


def scores(chosen: Sequence[Case], folder: Path, *, workers: int = 1) -> list[Score]:
    """Of every case, in order."""
    with processes(workers) as executor:
        scored = [executor.submit(_scored, case, folder) for case in chosen]
        return [one.result() for one in scored]


def _scored(case: Case, folder: Path) -> Score:
    car = unseal(case, folder)
    predicted = _predicted(case, car, folder)
    return score(read_truth(car.key), read_answer(stored(folder, case)), predicted)


def followups(chosen: Sequence[Case], folder: Path) -> list[Score]:
    """Of the cars whose advised tests were carried out, after these."""
    out = []
    for case in chosen:
        answer = stored_followup(folder, case)
        if answer is not None:
            out.append(score(read_truth(unseal(case, folder).key), read_answer(answer)))
    return out


def _predicted(case: Case, car: HiddenCar, folder: Path) -> Predicted | None:
    """Of the hidden effects, from the opened key; kept, since it takes seconds."""
    if not car.car.hidden:
        return None
    place = folder / "keys" / f"{case.name}.detectability.json"
    if not place.exists():
        records = reduce_measurement(case_folder(folder, case) / RECORDS)
        found = detectability(car.nominal, car.car, record_likelihood(car.nominal, records))
        place.write_text(json.dumps({k: asdict(d) for k, d in found.items()}, indent=1))
    said = json.loads(place.read_text())
    shows = frozenset((at, response) for d in said.values() for at, response in d["shows"])
    return Predicted({name: (d["strength"], d["wrong"]) for name, d in said.items()}, shows)
