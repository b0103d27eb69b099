"""The answer of a study: one axle, whether it can be used, and what stands behind it; and its files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from doe_kc.axle_file.write import write_axle
from doe_kc.characteristics import characteristics_of, reduce_all
from doe_kc.correlation.answer_record import AnswerRecord, EffectWords, GapRecord
from doe_kc.correlation.assessment import MISFIT, Assessment, Objection, assess
from doe_kc.correlation.result import Correlation
from doe_kc.curves import response_name
from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.verdict.size_words import size_words
from doe_kc.effects.words import effect_label
from doe_kc.ground.output import write_json
from doe_kc.load_cases import case_label
from doe_kc.measurement import Measurement
from doe_kc.reports.answer.overview import Overview
from doe_kc.reports.answer.overview_sheet import write_overview
from doe_kc.reports.correlation.characteristics import characteristic_table
from doe_kc.reports.correlation.twin_tables import twin_entry
from doe_kc.reports.discovery.effect_words import effect_words
from doe_kc.reports.page.answer import files_there, write_answer_page
from doe_kc.reports.page.links import link_pages
from doe_kc.reports.page.simulation import write_simulation_page
from doe_kc.reports.render.json import table_records
from doe_kc.study import Study
from doe_kc.workflow.adopt import AdoptedEffect, Adoption
from doe_kc.workflow.discovery_document import effect_entry
from doe_kc.workflow.gap import answer_gap
from doe_kc.workflow.twin_discovery import DiscoveryGround
from doe_kc.workflow.write_correlation import AXLE, axle_note


@dataclass(frozen=True)
class Answer:
    """discovery, adoption: None where none was made; with an outside solver a discovery is advice and not
    adopted. gap: None without curves from the solver. further: what speaks against the axle beyond what the
    correlation itself shows. ground: what a discovery through the twin of an outside model worked on."""

    correlation: Correlation
    assessment: Assessment
    discovery: Discovery | None
    adoption: Adoption | None
    gap: GapRecord | None
    further: tuple[Objection, ...] = ()
    ground: DiscoveryGround | None = None


def answered(
    study: Study,
    measurement: Measurement,
    correlation: Correlation,
    discovery: Discovery | None,
    adoption: Adoption | None,
    remarks: tuple[str, ...] = (),
    ground: DiscoveryGround | None = None,
) -> Answer:
    """Judge the axle that was correlated. remarks: what else speaks against calling it sound. ground: of the
    discovery, where it was made on the twin of an outside model; the gap is then that of the outside model,
    by the records as they are."""
    gap = answer_gap(study, measurement, correlation, discovery if ground is None else None)
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
    return Answer(correlation, assessment, discovery, adoption, gap, tuple(further), ground)


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
        places = sorted(
            {f"{case_label(c.load_case)} ({response_name(c.response)})" for c, _ in discovery.unexplained}
        )
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
        sentence=discovery.sentences[0] if discovery is not None else "",
        words=[] if discovery is None else list(_effect_words(discovery, adoption)),
    )


def _effect_words(discovery: Discovery, adoption: Adoption | None) -> Iterator[EffectWords]:
    """Of every finding, and of traces that were adopted."""
    for finding in (*discovery.findings, *discovery.traces):
        taken = _taken(finding, adoption)
        if taken or finding in discovery.findings:
            yield effect_words(discovery, finding).model_copy(update={"adopted": taken})


def _taken(finding: Finding, adoption: Adoption | None) -> bool:
    """Whether the axle handed over has it."""
    adopted = adoption.effects if adoption is not None else ()
    return any(
        (e.id, e.location) == (finding.hypothesis.effect, finding.hypothesis.location) for e in adopted
    )


def _effect_entries(discovery: Discovery, adoption: Adoption | None) -> Iterator[dict[str, Any]]:
    for finding in (*discovery.findings, *discovery.traces):
        taken = _taken(finding, adoption)
        named = finding in discovery.findings and finding.verdict != "lead"
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
        **({"twin": twin_entry(correlation.twin)} if correlation.twin is not None else {}),
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
            return f"{effect.label}: {size_words(finding)}"
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
        lines.append(f"Deviation from the records: {' → '.join(steps)} ({gap.noise_floor:.2f} is noise)")
    return lines


SUMMARY = "summary.json"
PAGE = "index.html"
SHEET = "summary.pdf"


def write_answer(
    study: Study,
    correlation: Correlation,
    assessment: Assessment,
    record: AnswerRecord,
    measurement: Measurement,
) -> list[Path]:
    """axle.toml, summary.json, index.html and summary.pdf, the page as one A4 sheet, in the study's folder,
    and the page of the axle handed in; returns the paths. All pages of the study are linked with each other.

    RunError when the folder cannot be written.
    """
    axle = write_axle(
        study.as_designed(correlation.axle),
        study.axle_path,
        study.out / AXLE,
        note=axle_note(correlation, assessment),
    )
    given = _write_given(study, correlation)
    document = summary_document(correlation, assessment, record, str(study.out / AXLE))
    summary = write_json(study.out / SUMMARY, document)
    overview = Overview(study.name, date.today().isoformat(), correlation, assessment, record)
    others = {name: words for name, words in files_there(study.out).items() if name != SHEET}
    sheet = write_overview(study.out / SHEET, overview, others)
    page = write_answer_page(
        study.out / PAGE,
        overview,
        notes={
            "Axle": f"{AXLE}, from {study.axle_path.name}",
            "Measurement": measurement.manifest.name,
            "Run time": f"{record.seconds:.0f} s",
        },
        files=files_there(study.out),
    )
    link_pages(study.out)
    return [axle, summary, page, sheet, *given]


def _write_given(study: Study, correlation: Correlation) -> list[Path]:
    """The page of the axle handed in, where its solver gives curves."""
    curves = correlation.baseline.outcome.curves
    if curves is None:
        return []
    reduced, today = reduce_all(curves, study.windows), date.today().isoformat()
    values = {entry.id: reduced[entry.id] for entry in characteristics_of(study.axle)}
    path = study.out / "simulate" / "report.html"
    return [write_simulation_page(path, curves, values, study=study.name, date=today)]
