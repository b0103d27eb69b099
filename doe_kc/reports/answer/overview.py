"""The whole result in what fits one sheet of paper: the same for the first page and its print."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite, nan
from textwrap import shorten

from doe_kc.correlation.answer_record import AnswerRecord, CaseGap, EffectWords
from doe_kc.correlation.assessment import MISFIT, Assessment, inside
from doe_kc.correlation.result import Correlation
from doe_kc.correlation.status import STATUS_LABELS
from doe_kc.ground.numbers import at_sd, signed, unit_words, with_sd
from doe_kc.load_cases import CASE_ORDER, case_label
from doe_kc.reports.axle.point_moves import AxleView, correlation_view
from doe_kc.reports.correlation.parameters import ParameterRow, parameter_rows
from doe_kc.reports.table import Column, PageCell, PageLayout, Table

STATUS_FILLS = {"sound": "0072B2", "doubtful": "E69F00", "not_usable": "D55E00"}
STATUS_WORDS_OF_USE = {
    "sound": "The corrected model can be used.",
    "doubtful": "The corrected model can be used, but for what is said here.",
    "not_usable": "The corrected model cannot be used as it is.",
}
AGREEMENT_LEVELS = (
    (MISFIT, "within the noise", "CFE3F3"),
    (2.0, "slightly off", "FBF0DC"),
    (5.0, "off", "F2B866"),
    (float("inf"), "far off", "D55E00"),
)
"""Deviations up to so many times the noise of the rig: in words, and the colour behind them."""
SURE_CHANGE = 2.0
"""Standard deviations that a change must have to be one of the car and not of the noise."""
CHANGES_SHOWN, REASONS_SHOWN, EFFECTS_SHOWN = 8, 3, 6
"""Rows at most of what to act on, sentences of the status, and effects: they fit one sheet."""
REASON_LETTERS = 240
"""Letters of a sentence of the status at most."""
PHYSICS_PRINTED, TESTS_PRINTED = 2, 4
"""Effects up to which the sheet has room for what happens in the car, and for how to confirm it."""
NOT_SOUGHT = "What the model lacks was not looked for."


@dataclass(frozen=True)
class AgreementRow:
    """label: a load case, or all of them. before, after: deviation of the axle handed in, and of the one
    handed over, times the noise of the rig; nan where it is not known."""

    label: str
    before: float
    after: float


@dataclass(frozen=True)
class Overview:
    """study: its name. date: ISO 8601. record: what the chain said beside the correlation."""

    study: str
    date: str
    correlation: Correlation
    assessment: Assessment
    record: AnswerRecord

    @property
    def status(self) -> str:
        """In one word, for readers."""
        return STATUS_LABELS[self.assessment.status]

    @property
    def status_fill(self) -> str:
        """Its colour, RRGGBB."""
        return STATUS_FILLS[self.assessment.status]

    @property
    def status_sentence(self) -> str:
        """What the word means."""
        return STATUS_WORDS_OF_USE[self.assessment.status]

    @property
    def reasons(self) -> list[str]:
        """Why it is not sound: the first reasons, and how many more there are."""
        if self.assessment.status == "sound":
            return []
        all_reasons = [
            shorten(r[0].upper() + r[1:], REASON_LETTERS, placeholder=" …") for r in self.assessment.reasons
        ]
        more = len(all_reasons) - REASONS_SHOWN
        left = [f"{more} more reason{'s' if more > 1 else ''} on the page of the correlation."]
        return all_reasons[:REASONS_SHOWN] + (left if more > 0 else [])

    @property
    def met(self) -> str:
        """How many characteristics are where they shall be, before and now."""
        entries = self.correlation.improvements
        before = sum(inside(replace(e, final=e.baseline)) for e in entries)
        now = sum(inside(e) for e in entries)
        return (
            f"{now} of {len(entries)} characteristics are inside their interval or their noise, "
            f"{before} with the axle as handed in."
        )

    @property
    def sentence(self) -> str:
        """What the model lacked."""
        return self.record.sentence or NOT_SOUGHT

    @property
    def effects(self) -> Sequence[EffectWords]:
        """Those shown."""
        return self.record.words[:EFFECTS_SHOWN]

    @property
    def physics_printed(self) -> bool:
        """Whether the sheet says of each effect what happens in the car."""
        return len(self.effects) <= PHYSICS_PRINTED

    @property
    def tests_printed(self) -> bool:
        """Whether it says of each how to confirm it."""
        return len(self.effects) <= TESTS_PRINTED

    @property
    def agreement(self) -> list[AgreementRow]:
        """All load cases together, then each; empty where it is not known."""
        gap = self.record.gap
        if gap is None:
            return []
        order = {name: i for i, name in enumerate((*CASE_ORDER, "static"))}
        cases = sorted(gap.cases.items(), key=lambda item: order.get(item[0], len(order)))
        rows = [AgreementRow("All load cases", gap.nominal, gap.final)]
        return rows + [_agreement(name, case) for name, case in cases]

    @property
    def changes(self) -> list[ParameterRow]:
        """Parameters that the records move for sure, those by the largest share of their range first."""
        return sure_changes(parameter_rows(self.correlation))

    @property
    def changes_lead(self) -> str:
        """How the rows shown were chosen."""
        count, known = len(self.changes), self.correlation.posterior is not None
        if not count:
            return "No parameter is moved by more than its uncertainty."
        which = "surely changed" if known else "changed most"
        if count <= CHANGES_SHOWN:
            return f"The parameters that {which}."
        return f"The largest {CHANGES_SHOWN} of {count} parameters that {which}."

    @property
    def view(self) -> AxleView:
        """The axle before and after."""
        return correlation_view(self.correlation, "left side")


def _agreement(load_case: str, gap: CaseGap) -> AgreementRow:
    label = "Static angles" if load_case == "static" else case_label(load_case)
    return AgreementRow(label, gap.nominal, gap.final)


def sure_changes(rows: Sequence[ParameterRow]) -> list[ParameterRow]:
    """Variables whose change the records ask for, or that end at a bound and not by what is uncertain of it;
    without standard deviations those that changed at all. The largest share of the range first."""
    shown = [r for r in rows if r.role == "variable" and r.visible is not False and _counts(r)]
    return sorted(shown, key=lambda r: -abs(r.place - r.start))


def _counts(row: ParameterRow) -> bool:
    if row.at_bound:
        return not abs(row.change) < SURE_CHANGE * row.inward
    return abs(row.change) >= SURE_CHANGE * row.sd if isfinite(row.sd) else abs(row.place - row.start) > 0.01


def agreement_words(times: float) -> str:
    """`5.2 × far off`, a dash for what is not known."""
    return f"{times:.1f} × – {_level(times)[1]}" if isfinite(times) else "–"


def agreement_fill(times: float) -> str:
    """Colour behind it."""
    return _level(times)[2] if isfinite(times) else ""


def _level(times: float) -> tuple[float, str, str]:
    return next(level for level in AGREEMENT_LEVELS if round(times, 1) <= level[0])  # as it is written


AGREEMENT_COLUMNS: tuple[Column[AgreementRow], ...] = (
    Column("label", "Load case", lambda r: r.label,
           page=PageCell(style="first", strong=lambda r: r.label.startswith("All"))),
    Column("before", "Model as handed in", lambda r: r.before, page=PageCell(
        text=lambda r: agreement_words(r.before), fill=lambda r: agreement_fill(r.before),
        order=lambda r: r.before)),
    Column("after", "Model now", lambda r: r.after, page=PageCell(
        text=lambda r: agreement_words(r.after), fill=lambda r: agreement_fill(r.after),
        order=lambda r: r.after)),
)  # fmt: skip
AGREEMENT_LEAD = (
    "Deviation between model and measured car, in multiples of what the rig itself scatters from run to run: "
    "1 × is as good as the measurement."
)


def agreement_table(overview: Overview) -> Table[AgreementRow]:
    """One row a load case."""
    layout = PageLayout[AgreementRow]("agreement-table", "Agreement by load case")
    return Table("Agreement", AGREEMENT_LEAD, AGREEMENT_COLUMNS, overview.agreement, page=layout)


def _value(row: ParameterRow) -> str:
    if row.at_bound:
        return f"{at_sd(row.final, nan)}{unit_words(row.unit)}, at its {row.at_bound} bound"
    return f"{with_sd(row.final, row.sd)}{unit_words(row.unit)}"


CHANGE_COLUMNS: tuple[Column[ParameterRow], ...] = (
    Column("label", "Parameter", lambda r: r.label + (", factor" if r.unit == "-" else ""),
           page=PageCell(style="first wrap")),
    Column("path", "Code", lambda r: r.path, page=PageCell()),
    Column("baseline", "Was", lambda r: r.baseline,
           page=PageCell(style="n", text=lambda r: at_sd(r.baseline, r.sd))),
    Column("final", "Now ± uncertainty", lambda r: r.final, page=PageCell(style="n", text=_value)),
    Column("change", "Change", lambda r: r.change, page=PageCell(
        style="n", text=lambda r: signed(r.change, r.sd).partition(" ")[0])),
)  # fmt: skip


def change_table(overview: Overview) -> Table[ParameterRow]:
    """The parameters to act on."""
    layout = PageLayout[ParameterRow]("changes-table", "Numbers to act on")
    rows = overview.changes[:CHANGES_SHOWN]
    return Table("Changes", overview.changes_lead, CHANGE_COLUMNS, rows, page=layout)
