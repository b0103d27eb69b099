"""What `doe-kc run` hands over for rig records whose answer is known or not: one axle a car, and its status.

Run: python reports/answers.py [--work DIR] [FOLDER ...], each a folder of test.toml and records, by default
the four cars of the tests and the customer's one of the example. Writes answers.md beside itself. DIR keeps
what is computed, so that an interrupted report goes on. Stops with an error when an axle is handed over that
is worse than the nominal one in anything measured.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from report_text import number, table

from doe_kc.correlation.assessment import harmed, inside
from doe_kc.correlation.posterior import BOUND_SHARE
from doe_kc.correlation.status import STATUS_LABELS
from doe_kc.discovery.verdict.size_words import size_words
from doe_kc.solver.suite import solve
from doe_kc.study import read_study
from doe_kc.workflow.adopt import AdoptedEffect
from doe_kc.workflow.answer import Answer
from doe_kc.workflow.chain import follow_chain
from doe_kc.workflow.correlate import correlate
from doe_kc.workflow.discover import discover_study
from doe_kc.workflow.measure import reduce_records

HERE = Path(__file__).parent
EXAMPLE = HERE.parent / "examples" / "front_axle"
RIG = HERE.parent / "tests" / "data" / "rig"
DEFAULT = {"car_a": EXAMPLE / "rig"} | {car: RIG / car for car in ("car_b", "car_c", "car_d", "car_e")}
INTRODUCTION = """# The answer for {count} cars

A study of two lines each, the nominal axle of the example and the records: what the model lacks is looked
for, added, and the extended axle correlated, all by default. Inside: characteristics within their interval
(equations 5.1, 5.2) or three standard deviations of their target. Worst change: of all characteristics the
largest growth of the distance from the target, in half-widths of its interval; "none" where nothing has moved
away by more than noise. Improvement: mean over the characteristics whose baseline is three standard
deviations off. Exact model: what the car's own true values would show on average, as their targets have
noise; above it the noise is fitted. Gap: whitened RMS of all records, handed in, re-tuned, handed over; 1 is
noise. `car_a` and `car_s` have no key.

"""
HEAD = (
    "car", "status", "effects added", "inside", "worst change", "improvement, %", "exact model, %", "gap",
    "at a bound", "evaluations",
)  # fmt: skip


def main() -> None:
    """Answer for every car and write the report."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--work", type=Path)
    given = parser.parse_args()
    folders = {folder.name: folder for folder in given.folders} or DEFAULT
    rows, reasons = [], []
    with tempfile.TemporaryDirectory() as place:
        for car, folder in folders.items():
            answer = answered(folder, (given.work or Path(place)) / car)
            rows.append(_row(car, answer))
            reasons.append(f"- **{car}**: {answer.assessment.line}")
            print(*rows[-1], sep=" | ", flush=True)
            if any(e.target.hold and harmed(e) for e in answer.correlation.improvements):
                sys.exit(f"{car}: something measured is worse than in the nominal axle")
    text = INTRODUCTION.format(count=len(rows)) + table(HEAD, rows) + "\n\n" + "\n".join(reasons) + "\n"
    (HERE / "answers.md").write_text(text, encoding="utf-8")


def answered(folder: Path, work: Path) -> Answer:
    """The chain on the nominal axle and a folder of records."""
    work.mkdir(parents=True, exist_ok=True)
    file = work / "study.toml"
    file.write_text(f"axle = {str(EXAMPLE / 'axle.toml')!r}\nmeasurement = {str(folder.resolve())!r}\n")
    study = read_study(file)
    reduced = reduce_records(study, solve(study.axle))
    return follow_chain(study, reduced, discover_study, _correlated)


def _correlated(study, reduced, adoption):  # type: ignore[no-untyped-def]
    return correlate(study, reduced, adoption=adoption)


def _row(car: str, answer: Answer) -> list[str]:
    found, gap = answer.correlation, answer.gap
    entries = found.improvements
    point = found.best.point
    ended = int(((point <= BOUND_SHARE) | (point >= 1.0 - BOUND_SHARE)).sum())
    adopted = answer.adoption.effects if answer.adoption is not None else ()
    return [
        car,
        STATUS_LABELS[answer.assessment.status].lower(),
        "; ".join(_effect(answer, e) for e in adopted) or "none",
        f"{sum(map(inside, entries))} of {len(entries)}",
        _worst(answer),
        number(found.mean_improvement, 3),
        number(found.exact_model_improvement, 3),
        " → ".join(f"{g:.2f}" for g in (gap.nominal, gap.tuned, gap.final) if g is not None) if gap else "-",
        f"{ended} of {point.size}",
        f"{len(found.run.evaluated)}",
    ]


def _effect(answer: Answer, effect: AdoptedEffect) -> str:
    discovery, place = answer.discovery, (effect.id, effect.location)
    assert discovery is not None
    findings = (*discovery.findings, *discovery.traces)
    finding = next(f for f in findings if (f.hypothesis.effect, f.hypothesis.location) == place)
    sizes = size_words(finding)
    return f"{effect.label}: {sizes}" if sizes else effect.label


def _worst(answer: Answer) -> str:
    changes = []
    for e in answer.correlation.improvements:
        half = 0.15 * e.target.scale
        before, after = abs(e.baseline - e.target.value), abs(e.final - e.target.value)
        if after > max(before, 3.0 * e.target.sd):
            changes.append(((after - before) / half, e.target.entry.id))
    if not changes:
        return "none"
    most, name = max(changes)
    return f"{number(most, 2)} ({name})"


if __name__ == "__main__":
    np.seterr(all="ignore")
    main()
