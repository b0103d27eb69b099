"""The answer of a study: one axle, whether it can be used, and what stands behind it; and its files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.axle_file.write import write_axle
from doe_kc.correlation.answer_record import AnswerRecord, GapRecord
from doe_kc.correlation.assessment import MISFIT, Assessment, Objection, assess
from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.correlation.result import Correlation
from doe_kc.curves import CurveSet
from doe_kc.discovery.model import NO_CHARACTERISTICS
from doe_kc.discovery.result import Discovery
from doe_kc.ground.output import write_json
from doe_kc.measurement import Measurement
from doe_kc.report.correlation_characteristics import characteristic_table
from doe_kc.report.discovery_words import effect_label, size_words
from doe_kc.report.page.answer import write_answer_page
from doe_kc.report.render.json import table_records
from doe_kc.study import Study
from doe_kc.workflow.adopt import AdoptedEffect, Adoption
from doe_kc.workflow.discover import recorded
from doe_kc.workflow.discovery_document import effect_entry
from doe_kc.workflow.write_correlation import AXLE, axle_note


@dataclass(frozen=True)
class Answer:
    """discovery, adoption: None where none was made; with an outside solver a discovery is advice and not
    adopted. gap: None without curves from the solver. further: what speaks against the axle beyond what the
    correlation itself shows."""

    correlation: Correlation
    assessment: Assessment
    discovery: Discovery | None
    adoption: Adoption | None
    gap: GapRecord | None
    further: tuple[Objection, ...] = ()


def answered(
    study: Study,
    measurement: Measurement,
    correlation: Correlation,
    discovery: Discovery | None,
    adoption: Adoption | None,
    remarks: tuple[str, ...] = (),
) -> Answer:
    """Judge the axle that was correlated. remarks: what else speaks against calling it sound."""
    gap = answer_gap(study, measurement, correlation, discovery)
    further = [*_objections(study, discovery, adoption), *(Objection(r) for r in remarks)]
    if gap is not None and gap.final > gap.nominal * 1.001 and gap.final > MISFIT:
        further.append(
            Objection(
                f"The deviations from the records grew from {gap.nominal:.2f} to {gap.final:.2f} times "
                "their noise.",
                fatal=True,
            )
        )
    assessment = assess(correlation, misfit=None if gap is None else gap.final, further=further)
    return Answer(correlation, assessment, discovery, adoption, gap, tuple(further))


def answer_gap(
    study: Study, measurement: Measurement, correlation: Correlation, discovery: Discovery | None
) -> GapRecord | None:
    """The gap of the records before and after. A discovery's calibrations of the rig and differences between
    the wheels are taken as it found them."""
    before, after = correlation.baseline.outcome.curves, correlation.best.outcome.curves
    if before is None or after is None:
        return None
    if discovery is not None:
        fitted, known = discovery.fitted, discovery.gap
        if correlation.problem.exact:
            final = fitted.model.residual_of(recorded(correlation.axle, measurement), fitted.z)
        else:
            final = fitted.model.likelihood.residual(after, NO_CHARACTERISTICS)
        return GapRecord(
            nominal=known.nominal, tuned=known.tuned, final=_rms(final), noise_floor=known.noise_floor
        )
    data = record_likelihood(study.axle, measurement)

    def left(curves: CurveSet) -> float:
        return _rms(data.residual(curves, NO_CHARACTERISTICS))

    if not data.curves:
        return None
    return GapRecord(nominal=left(before), tuned=None, final=left(after), noise_floor=1.0)


def _rms(residual: np.ndarray) -> float:
    return float(np.sqrt(np.mean(residual**2)))


def _objections(study: Study, discovery: Discovery | None, adoption: Adoption | None) -> Iterator[Objection]:
    """What the discovery leaves open."""
    if discovery is None:
        return
    taken = {e.id for e in adoption.effects} if adoption is not None else set()
    for effect in adoption.effects if adoption is not None else ():
        if effect.uncertain:
            others = next(
                ([e for e in group if e != effect.id] for group in discovery.classes if effect.id in group),
                [],
            )
            yield Objection(
                f"The leading one of a class was added, {effect.label}; it could be "
                f"{' or '.join(effect_label(e).lower() for e in others)}."
            )
    left = [f for f in discovery.findings if f.hypothesis.effect not in taken]
    if discovery.verdict == "unexplained":
        places = sorted({f"{c.load_case} {c.response}" for c, _ in discovery.unexplained})
        where = f": {', '.join(places)}" if places else ""
        leads = ", ".join(effect_label(f.hypothesis.effect).lower() for f in left)
        hint = f"; the best lead, not adopted, is {leads}" if leads else ""
        yield Objection(f"The records show something that nothing explains{where}{hint}.")
    elif left:
        names = ", ".join(effect_label(f.hypothesis.effect).lower() for f in left)
        how = "as the study says" if study.discovery.adopt != "auto" else "the outside model does not have it"
        yield Objection(f"The records ask for {names}, which was not adopted, {how}.")


def answer_record(answer: Answer, seconds: float) -> AnswerRecord:
    """What is kept of an answer beside its correlation. seconds: of the whole run."""
    discovery, adoption = answer.discovery, answer.adoption
    return AnswerRecord(
        verdict=discovery.verdict if discovery is not None else None,
        effects=[] if discovery is None else list(_effect_entries(discovery, adoption)),
        added=[] if adoption is None else [_effect_line(answer, e) for e in adoption.effects],
        gap=answer.gap,
        seconds=seconds,
    )


def _effect_entries(discovery: Discovery, adoption: Adoption | None) -> Iterator[dict[str, Any]]:
    adopted = {(e.id, e.location) for e in adoption.effects} if adoption is not None else set()
    for finding in (*discovery.findings, *discovery.traces):
        taken = (finding.hypothesis.effect, finding.hypothesis.location) in adopted
        named = discovery.verdict in ("named", "class") and finding in discovery.findings
        if named or taken:
            yield effect_entry(finding) | {"adopted": taken}


def summary_document(
    correlation: Correlation, assessment: Assessment, record: AnswerRecord, axle_path: str
) -> dict[str, Any]:
    """summary.json, and the head of what `run --json` writes."""
    return {
        "status": assessment.status,
        "reasons": list(assessment.reasons),
        "axle": axle_path,
        "verdict": record.verdict,
        "effects": record.effects,
        "characteristics": table_records(characteristic_table(correlation)),
        "gap": None if record.gap is None else record.gap.model_dump(),
        "rating": correlation.rating,
        "mean_improvement_percent": correlation.mean_improvement,
        "seconds": record.seconds,
    }


def _effect_line(answer: Answer, effect: AdoptedEffect) -> str:
    """Name, place and sizes with their standard deviations."""
    discovery = answer.discovery
    if discovery is None:
        return effect.label
    place = (effect.id, effect.location)
    for finding in (*discovery.findings, *discovery.traces):
        if (finding.hypothesis.effect, finding.hypothesis.location) == place and finding.hypothesis.sizes:
            return f"{effect.label}: {size_words(discovery, finding)}"
    return effect.label


def answer_lines(assessment: Assessment, record: AnswerRecord) -> list[str]:
    """The first lines of a terminal: status, effects, gap."""
    lines = [assessment.line, *(f"Added: {words}" for words in record.added)]
    gap = record.gap
    if gap is not None:
        steps = [f"{gap.nominal:.2f} as handed in"]
        if gap.tuned is not None:
            steps.append(f"{gap.tuned:.2f} re-tuned without an effect")
        steps.append(f"{gap.final:.2f} now")
        lines.append(f"Deviation from the records: {' -> '.join(steps)} ({gap.noise_floor:.2f} is noise)")
    return lines


SUMMARY = "summary.json"
PAGE = "index.html"


def write_answer(
    study: Study,
    correlation: Correlation,
    assessment: Assessment,
    record: AnswerRecord,
    measurement: Measurement,
) -> list[Path]:
    """axle.toml, summary.json and index.html in the study's folder; returns the paths.

    RunError when the folder cannot be written.
    """
    axle = write_axle(
        correlation.axle, study.axle_path, study.out / AXLE, note=axle_note(correlation, assessment)
    )
    document = summary_document(correlation, assessment, record, str(study.out / AXLE))
    summary = write_json(study.out / SUMMARY, document)
    page = write_answer_page(
        study.out / PAGE,
        correlation,
        assessment,
        study=study.name,
        date=date.today().isoformat(),
        lines=answer_lines(assessment, record)[1:],
        notes={
            "Axle": f"{AXLE}, from {study.axle_path.name}",
            "Measurement": measurement.manifest.name,
            "Run time": f"{record.seconds:.0f} s",
        },
        folder=study.out,
    )
    return [axle, summary, page]
