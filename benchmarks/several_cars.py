"""What several measured cars tell beyond one: effects of one design, in one of its cars and in their mean.

python -m benchmarks.several_cars FOLDER [--cars 3] [--suites weak ...] [--seeds 0 1 2 ...] [--report PATH]

Each seed is one design with an effect, and production scatter of its own in every car, as of
`benchmarks.discovery`. It is analysed twice: its first car alone, and the mean of its cars as `doe-kc
discover` does it. Answers are kept in FOLDER: a killed run goes on.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.discovery.generator import RECORDS, hidden_car
from benchmarks.discovery.hidden import Hidden
from doe_kc.axle_file import read_axle
from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.discovery.discover import discover
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result import Discovery, Finding
from doe_kc.effects import EFFECTS
from doe_kc.ground.numbers import with_sd
from doe_kc.measurement import reduce_cars
from doe_kc.variables import VariableOptions
from doe_kc.workflow.discover import discovery_space, effect_library, mean_car, recorded

KINDS = ("one", "mean")
HEADS = {"one": "one car", "mean": "{n} cars"}


@dataclass(frozen=True)
class SeriesCase:
    """One design of which `cars` cars are measured."""

    suite: str
    seed: int
    cars: int

    @property
    def name(self) -> str:
        return f"{self.suite}_{self.seed}_{self.cars}"

    def write(self, folder: Path) -> Path:
        """Axle and records of every car, once."""
        place = folder / self.name
        for number in range(self.cars):
            if not (place / f"car_{number + 1}" / RECORDS / "test.toml").exists():
                name = f"car_{number + 1}"
                hidden_car(self.seed, self.suite, name=name, number=number).write(place / name)
        return place


def analysed(case: SeriesCase, kind: str, folder: Path) -> dict[str, Any]:
    """The answer of one kind, from FOLDER or computed."""
    place = folder / f"{case.name}_{kind}.json"
    if not place.exists():
        part = place.with_suffix(".part")
        part.write_text(json.dumps(_analyse(case, kind, case.write(folder))))
        part.replace(place)
    return dict(json.loads(place.read_text()))


def _analyse(case: SeriesCase, kind: str, place: Path) -> dict[str, Any]:
    started = time.process_time()
    axle = read_axle(place / "car_1" / "axle.toml")
    folders = [place / f"car_{k + 1}" / RECORDS for k in range(1 if kind == "one" else case.cars)]
    measurement = reduce_cars(folders, half_track=axle.half_track)
    axle = recorded(axle, measurement)
    space = discovery_space(axle, VariableOptions(), "benchmark")
    model, words = mean_car(EffectModel(axle, space, record_likelihood(axle, measurement)), measurement)
    found = discover(model, effect_library(axle))
    (hidden,) = hidden_car(case.seed, case.suite).content.hidden
    return {**_figures(found, hidden), "words": list(words), "seconds": time.process_time() - started}


def _figures(found: Discovery, hidden: Hidden) -> dict[str, Any]:
    """What is said of the hidden effect. gain: largest ln evidence by which it was screened alone. z: largest
    disagreement before it is in the model."""
    worst = found.tuned_map.worst(1)
    gain = max(
        (s.gain for s in found.search.first.screened if s.hypothesis.effect == hidden.id), default=math.nan
    )
    own = next((f for f in found.findings if f.hypothesis.effect == hidden.id), None)
    return {
        "effect": hidden.id,
        "size": hidden.size,
        "verdict": found.verdict,
        "names": [f.hypothesis.effect for f in found.findings if f.verdict == "named"],
        "z": abs(worst[0][1]) if worst else 0.0,
        "gain": gain,
        "detectability": None if own is None else own.detectability,
        "estimates": {} if own is None else _estimates(own, hidden),
    }


def _estimates(finding: Finding, hidden: Hidden) -> dict[str, list[float]]:
    """Parameter -> true value, value, standard deviation: single numbers of the place that is hidden."""
    return {
        e.key: [float(hidden.parameters[e.key]), e.value, e.sd]
        for e in finding.estimates
        if e.index is None and e.key in hidden.parameters
    }


def _named(answer: dict[str, Any]) -> bool:
    return answer["effect"] in answer["names"]


def _size_words(answer: dict[str, Any]) -> str:
    if not answer["estimates"]:
        return "–"
    return "; ".join(
        f"{key} {with_sd(value, sd)} ({(value - true) / sd:+.1f})"
        for key, (true, value, sd) in answer["estimates"].items()
    )


def _sd_ratios(answers: Sequence[dict[str, dict[str, Any]]], kind: str) -> list[float]:
    """sd of `kind` over that of one car, relative to the values, of parameters that both estimate."""
    out = []
    for answer in answers:
        one, other = answer["one"]["estimates"], answer[kind]["estimates"]
        out += [(other[k][2] / other[k][1]) / (one[k][2] / one[k][1]) for k in one.keys() & other.keys()]
    return out


def report(cases: Sequence[SeriesCase], answers: Sequence[dict[str, dict[str, Any]]]) -> str:
    """The table of all cases, and what follows."""
    n = cases[0].cars
    heads = [HEADS[k].format(n=n) for k in KINDS]
    lines = [
        "# Several measured cars",
        "",
        f"`python -m benchmarks.several_cars`: designs with one effect each; {n} cars of a design have the "
        "effect and small shares of all others in common, and parts, sides, rig errors and repeats of their "
        "own. Analysed are the first car alone and the mean of all. z: largest disagreement of the re-tuned "
        "axle, in standard deviations. ln gain: evidence of the effect alone, screened. Size: value ± sd and "
        "its error in sd.",
        "",
        "| effect, typical sizes | | verdict | named | z | ln gain | detectability | size |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for answer in answers:
        for kind, head in zip(KINDS, heads, strict=True):
            a = answer[kind]
            first = f"{EFFECTS[a['effect']].id}, {a['size']:.2f}" if kind == "one" else ""
            seen = "–" if a["detectability"] is None else f"{a['detectability']:.1f}"
            lines.append(
                f"| {first} | {head} | {a['verdict']} | {'yes' if _named(a) else 'no'} | {a['z']:.1f} | "
                f"{a['gain']:.1f} | {seen} | {_size_words(a)} |"
            )
    lines += ["", "| | " + " | ".join(heads) + " |", "|---|" + "---|" * len(KINDS)]
    every = {k: [a[k] for a in answers] for k in KINDS}
    unexplained = [str(sum(a["verdict"] == "unexplained" for a in every[k])) for k in KINDS]
    lines += [
        _row("something left unexplained", unexplained),
        _row("named", [f"{sum(map(_named, every[k]))} of {len(answers)}" for k in KINDS]),
        _row(
            "another effect named",
            [str(sum(bool(set(a["names"]) - {a["effect"]}) for a in every[k])) for k in KINDS],
        ),
        _row("median z", [f"{median(a['z'] for a in every[k]):.1f}" for k in KINDS]),
        _row("median ln gain", [f"{median(a['gain'] for a in every[k]):.1f}" for k in KINDS]),
        _row("median sd over that of one car", [_median_text(_sd_ratios(answers, k)) for k in KINDS]),
        _row("RMS error of sizes in sd", [_rms_text(every[k]) for k in KINDS]),
        _row("median processor time, s", [f"{median(a['seconds'] for a in every[k]):.0f}" for k in KINDS]),
    ]
    return "\n".join([*lines, ""])


def _row(head: str, cells: Sequence[str]) -> str:
    return f"| {head} | " + " | ".join(cells) + " |"


def _median_text(values: Sequence[float]) -> str:
    return f"{median(values):.2f} (of {len(values)})" if values else "–"


def _rms_text(answers: Sequence[dict[str, Any]]) -> str:
    errors = [(v - t) / sd for a in answers for t, v, sd in a["estimates"].values()]
    return f"{np.sqrt(np.mean(np.square(errors))):.2f} (of {len(errors)})" if errors else "–"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cars", type=int, default=3)
    parser.add_argument("--suites", nargs="+", default=["weak", "confounded"])
    parser.add_argument("--seeds", type=int, nargs="+", default=list(range(6)))
    parser.add_argument("--report", type=Path)
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    cases = [SeriesCase(suite, seed, asked.cars) for suite in asked.suites for seed in asked.seeds]
    answers = []
    for case in cases:
        answers.append({kind: analysed(case, kind, asked.folder) for kind in KINDS})
        print(case.name, {k: (a["verdict"], a["names"], round(a["seconds"])) for k, a in answers[-1].items()})
    if asked.report is not None:
        asked.report.write_text(report(cases, answers))


if __name__ == "__main__":
    main()
