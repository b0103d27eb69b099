"""What a live page leaves behind, in `live` of the study's results folder: files of fixed names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError

from doe_kc.axle.parameters import with_values
from doe_kc.axle_file.write import write_axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import InputError
from doe_kc.ground.fields import Finite, Pair, Strict
from doe_kc.ground.files import read_bytes
from doe_kc.ground.output import write_json, write_whole
from doe_kc.live.answer import LiveAnswer, solve_live
from doe_kc.live.confirmation import stored_answer
from doe_kc.live.effect_switches import EffectSizes, effect_switches
from doe_kc.live.session import Session
from doe_kc.live.state import MOST_SNAPSHOTS, LiveState, Snapshot
from doe_kc.live.static_page import static_page
from doe_kc.live.tasks import SavedSizes
from doe_kc.reports.render.workbook import new_book, table_sheet, write_book
from doe_kc.reports.table import Column, SheetLayout, Table, row_digits, three_digits

EXPLORATION, LIVE_AXLE, LIVE_BOOK, LIVE_PAGE = "exploration.json", "axle.toml", "snapshots.xlsx", "page.html"


class SavedDesign(Strict):
    """Slider values and effects."""

    name: Annotated[str, Field(max_length=40)] = ""
    values: dict[str, Finite]
    effects: SavedSizes


class SavedExploration(Strict):
    """`exploration.json`."""

    schema_: Literal["doe_kc.live/1"] = Field(alias="schema")
    present: SavedDesign
    bounds: dict[str, Pair]
    locked: list[str]
    held: list[str]
    locked_effects: list[str] = Field(default=[])
    snapshots: Annotated[list[SavedDesign], Field(max_length=MOST_SNAPSHOTS)]


def live_folder(session: Session) -> Path:
    """Where everything is written."""
    return session.base.study.out / "live"


def save_state(session: Session) -> str:
    """Write `exploration.json`; says where."""
    state = session.state
    document = {
        "schema": "doe_kc.live/1",
        "present": {"values": dict(state.values), "effects": _effects(state.effects)},
        "bounds": {path: list(pair) for path, pair in state.bounds.items()},
        "locked": sorted(state.locked),
        "held": sorted(state.held),
        "locked_effects": sorted(state.locked_effects),
        "snapshots": [
            {"name": s.name, "values": dict(s.values), "effects": _effects(s.effects)}
            for s in state.snapshots
        ],
    }
    path = live_folder(session) / EXPLORATION
    write_json(path, document)
    return f"Exploration saved: {path}"


def _effects(effects: EffectSizes) -> dict[str, dict[str, float] | None]:
    return {name: None if sizes is None else dict(sizes) for name, sizes in effects.items()}


def read_state(session: Session) -> LiveState:
    """The state of `exploration.json`, its snapshots solved again.

    InputError when there is none, or it does not fit the axle.
    """
    path = live_folder(session) / EXPLORATION
    if not path.is_file():
        raise InputError(f"{path}: nothing has been saved yet.")
    try:
        saved = SavedExploration.model_validate_json(read_bytes(path, "exploration"))
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        raise InputError(f"{path}: {'.'.join(map(str, first['loc']))}: {first['msg']}.") from None
    present = saved.present
    _check_paths(session, path, present)
    snapshots = []
    for design in saved.snapshots:
        _check_paths(session, path, design)
        answer = _solved(session, design.values, design.effects)
        if isinstance(answer, LiveAnswer):
            snapshots.append(Snapshot(design.name, design.values, design.effects, answer))
    _check_rest(session, path, saved)
    bounds = {name: (pair[0], pair[1]) for name, pair in saved.bounds.items()}
    return LiveState(
        values=present.values,
        bounds=bounds,
        locked=frozenset(saved.locked),
        held=frozenset(saved.held),
        effects=present.effects,
        locked_effects=frozenset(saved.locked_effects) & set(effect_switches(session.base.study)),
        snapshots=tuple(snapshots),
    )


def _check_paths(session: Session, path: Path, design: SavedDesign) -> None:
    known = session.base.with_effects(design.effects).space.paths
    for name in design.values:
        if name not in known:
            raise InputError(f"{path}: {name} is no slider of this study's axle; save a new exploration.")


def _check_rest(session: Session, path: Path, saved: SavedExploration) -> None:
    """InputError for bounds, locks or held characteristics that the page itself could not have set."""
    targets = session.base.targets
    known = set() if targets is None else {t.entry.id for t in targets.characteristics}
    for name in saved.held:
        if name not in known:
            raise InputError(f"{path}: held: {name} has no target in this study; remove it.")
    variables = {v.path: v for v in session.base.with_effects(saved.present.effects).space.variables}
    for name, (lower, upper) in saved.bounds.items():
        if name not in variables:
            continue
        start = variables[name].start
        value = saved.present.values.get(name, start)
        if not lower < upper or not lower <= min(start, value) <= max(start, value) <= upper:
            raise InputError(
                f"{path}: bounds.{name} = [{lower:g}, {upper:g}] must rise and hold its start {start:g} and "
                f"its value {value:g}."
            )
        if variables[name].logarithmic and lower <= 0.0:
            raise InputError(f"{path}: bounds.{name}: expected a lower bound above zero.")


def _solved(session: Session, values: Mapping[str, float], effects: EffectSizes) -> LiveAnswer | str:
    model = session.base.with_effects(effects)
    known = stored_answer(model, values, session.compilation)
    return known or solve_live(model, values, session.compilation)


def export_axle(session: Session) -> str:
    """Write `axle.toml` of the present design, as designed (see `Study.as_designed`); says where."""
    if session.failure:
        raise InputError(f"the present design has no answer: {session.failure}")
    study, present = session.base.study, session.present
    path = live_folder(session) / LIVE_AXLE
    # of an outside solver the drawn axle may be its twin
    axle = with_values(study.axle, present.values) if session.model.outside else present.axle
    note = "set on the live page" + ("" if present.true else ", not confirmed by the outside solver")
    write_axle(study.as_designed(axle), study.axle_path, path, note=note)
    return f"Axle written: {path}"


@dataclass(frozen=True)
class SnapshotRow:
    """One parameter or characteristic. values: nominal, snapshots, present; target, sd: nan without one."""

    ident: str
    label: str
    unit: str
    values: tuple[float, ...]
    target: float = float("nan")
    sd: float = float("nan")


def snapshot_tables(session: Session) -> tuple[Table[SnapshotRow], Table[SnapshotRow]]:
    """Characteristics and parameters of the nominal axle, every snapshot and the present design."""
    designs = [("Nominal", session.nominal)]
    designs += [(s.name, s.answer) for s in session.state.snapshots]
    designs += [("Present", session.present)]
    targets = session.base.targets
    known = {} if targets is None else {t.entry.id: t for t in targets.characteristics}
    characteristics = [
        SnapshotRow(
            ident,
            entry.label,
            entry.unit,
            tuple(float(a.characteristics[i]) for _, a in designs),
            known[ident].value if ident in known else float("nan"),
            known[ident].sd if ident in known else float("nan"),
        )
        for i, (ident, entry) in enumerate(CHARACTERISTICS.items())
    ]
    parameters = [
        SnapshotRow(
            v.path, v.parameter.label, v.unit, tuple(a.values.get(v.path, v.start) for _, a in designs)
        )
        for v in session.model.space.variables
    ]
    names = [name for name, _ in designs]
    return (
        _table("Characteristics", "Of the left wheel, by the true model.", names, characteristics, True),
        _table("Parameters", "Absolute values.", names, parameters, False),
    )


def _table(
    name: str, remark: str, designs: list[str], rows: list[SnapshotRow], targets: bool
) -> Table[SnapshotRow]:
    def number(row: SnapshotRow) -> str:
        return row_digits(row.sd, row.values[0])

    columns = [
        Column[SnapshotRow]("id", "Name", lambda r: r.ident, width=28.0),
        Column[SnapshotRow]("label", "Meaning", lambda r: r.label, width=40.0),
        Column[SnapshotRow]("unit", "Unit", lambda r: r.unit, width=9.0),
    ]
    if targets:
        columns += [
            Column[SnapshotRow]("target", "Target", lambda r: r.target, number),
            Column[SnapshotRow]("sd", "Standard deviation", lambda r: r.sd, lambda r: three_digits(r.sd)),
        ]
    columns += [_column(i, head, number) for i, head in enumerate(designs)]
    layout = SheetLayout(frozen="label", wrapped=False)
    return Table(name, remark, tuple(columns), rows, sheet=layout)


def _column(i: int, head: str, number: Callable[[SnapshotRow], str]) -> Column[SnapshotRow]:
    return Column(f"design_{i}", head, lambda r: r.values[i], number, width=14.0)


def export_table(session: Session) -> str:
    """Write `snapshots.xlsx`; says where."""
    study = session.base.study
    book = new_book(f"{study.name}, {date.today().isoformat()}")
    for table in snapshot_tables(session):
        table_sheet(book, table, study.name)
    path = write_book(live_folder(session) / LIVE_BOOK, book)
    return f"Snapshot table written: {path}"


def export_page(session: Session) -> str:
    """Write `page.html`, see `static_page`; says where. InputError beside an outside solver: the page is
    checked by some hundred designs."""
    if session.failure:
        raise InputError(f"the present design has no answer: {session.failure}")
    if session.model.outside is not None:
        raise InputError(
            "a page that still moves is checked by a hundred designs and more, too many for an outside "
            "solver; doe-kc surrogates writes evaluators of the stored designs."
        )
    html = static_page(session)
    path = live_folder(session) / LIVE_PAGE
    write_whole(path, lambda beside: beside.write_text(html, encoding="utf-8"))
    return f"Page written: {path}"


KEEPERS: Mapping[str, Callable[[Session], str]] = {
    "save": save_state,
    "export_axle": export_axle,
    "export_table": export_table,
    "export_page": export_page,
}
"""By the page's word; each says what it wrote."""
