"""Evaluations as tables: one row a design, and the curves one row a point and side; CSV or Parquet."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Literal

import pandas as pd

from doe_kc.campaign.record import StoredEvaluation
from doe_kc.campaign.store import Store
from doe_kc.characteristics.result_columns import CHARACTERISTIC_RESULTS, STATUS
from doe_kc.curves import SIDES, CurveSet
from doe_kc.ground.errors import InputError
from doe_kc.ground.output import write_csv, write_whole
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.protocol import Values

Format = Literal["csv", "parquet"]
FORMATS: tuple[Format, ...] = ("csv", "parquet")


def require_format(form: str) -> Format:
    """The format; InputError for an unknown one, or for Parquet without the package that writes it."""
    if form not in FORMATS:
        raise InputError(f"--export {form}: expected {' or '.join(FORMATS)}.")
    if form == "parquet" and importlib.util.find_spec("pyarrow") is None:
        raise InputError("--export parquet: needs the extra `parquet`; install doe-kc[parquet], or take csv.")
    return "parquet" if form == "parquet" else "csv"


def design_row(values: Values, outcome: Outcome) -> dict[str, object]:
    """Parameters, status, reason, characteristics in their units (empty where unknown), seconds."""
    known = dict(zip(CHARACTERISTIC_RESULTS, map(float, outcome.characteristics), strict=True))
    status = "failed" if outcome.failed else "ok"
    return {**values, STATUS: status, "reason": outcome.reason, **known, "seconds": outcome.seconds}


def designs_frame(designs: Sequence[Values], outcomes: Sequence[Outcome]) -> pd.DataFrame:
    """One row a design, in their order."""
    return pd.DataFrame([design_row(v, o) for v, o in zip(designs, outcomes, strict=True)])


def evaluations_frame(store: Store, windows: Mapping[str, float], origin: str = "*") -> pd.DataFrame:
    """Everything that a store holds: key, columns of `design_row`, origin, created.

    windows: of the fits. Parameters that a design does not name are empty.
    """
    rows, parameters = [], dict[str, None]()
    for record in store.records(origin):
        outcome = store.read(record, windows, curves=False)
        parameters |= dict.fromkeys(record.parameters)
        tail = {"origin": record.origin, "created": record.created}
        rows.append({"key": record.key, **design_row(record.parameters, outcome), **tail})
    end = (STATUS, "reason", *CHARACTERISTIC_RESULTS, "seconds", "origin", "created")
    return pd.DataFrame(rows, columns=["key", *parameters, *end])


def curves_frames(store: Store, windows: Mapping[str, float]) -> Iterator[pd.DataFrame]:
    """The curves of each evaluation that has some: see `curve_rows`."""
    for record in store.records():
        curves = store.read(record, windows).curves if record.packed.curves else None
        if curves is not None:
            yield curve_rows(record, curves)


def curve_rows(record: StoredEvaluation, curves: CurveSet) -> pd.DataFrame:
    """key, load_case, side, input, input_unit, and per response its mean and `<response>_half_width`.

    Units as in `doe_kc.curves`; angles and wheel centre are changes from static.
    """
    parts = []
    for case in curves.cases.values():
        for row, side in enumerate(SIDES):
            columns: dict[str, object] = {
                "key": record.key,
                "load_case": case.load_case,
                "side": side,
                "input": case.input,
                "input_unit": case.input_unit,
            }
            columns |= {name: curve[row] for name, curve in case.mean.items()}
            columns |= {f"{name}_half_width": curve[row] for name, curve in case.half_width.items()}
            parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def write_table(path: Path, frame: pd.DataFrame) -> Path:
    """A table as CSV or, when the name ends so, as Parquet."""
    if path.suffix != ".parquet":
        return write_csv(path, frame)
    require_format("parquet")
    return write_whole(path, lambda p: frame.to_parquet(p, index=False, engine="pyarrow"))


def export_store(
    store: Store, folder: Path, form: Format, windows: Mapping[str, float] | None = None
) -> list[Path]:
    """evaluations.csv and curves.csv (or .parquet) of a whole store in a folder."""
    used = windows or {}
    table = write_table(folder / f"evaluations.{form}", evaluations_frame(store, used))
    frames = curves_frames(store, used)
    return [table, write_parts(folder / f"curves.{form}", frames, form)]


def write_parts(path: Path, frames: Iterator[pd.DataFrame], form: Format) -> Path:
    """One table from many, one after the other: it may be larger than the memory."""
    if form == "csv":
        return write_whole(path, lambda p: _csv_parts(p, frames))
    return write_whole(path, lambda p: _parquet_parts(p, frames))


def _csv_parts(path: Path, frames: Iterator[pd.DataFrame]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        for number, frame in enumerate(frames):
            frame.to_csv(file, index=False, float_format="%.10g", header=number == 0)


def _parquet_parts(path: Path, frames: Iterator[pd.DataFrame]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    first = next(frames, None)
    table = pa.Table.from_pandas(pd.DataFrame() if first is None else first, preserve_index=False)
    with pq.ParquetWriter(path, table.schema) as writer:
        writer.write_table(table)
        for frame in frames:
            writer.write_table(pa.Table.from_pandas(frame, table.schema, preserve_index=False))
