"""Evaluators of a surrogate that need no doe_kc: a Python file beside a JSON file, and a workbook."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from openpyxl.formatting.rule import FormulaRule
from openpyxl.styles import PatternFill
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.datavalidation import DataValidation
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.ground.output import write_whole
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.render.cells import clean, put, title, widths
from doe_kc.reports.render.workbook import new_book, write_book
from doe_kc.surrogate_models.formula import MeanFormula, mean_formulas
from doe_kc.surrogate_models.saved import SavedSurrogate

TYPED = PatternFill("solid", fgColor="FFF2CC")
"""Of cells that values are typed into."""
BEYOND = PatternFill("solid", bgColor="E6A08F")
"""Of one that holds no number between its bounds."""
FIRST = 5
"""First row of inputs, outputs and numbers."""

SCRIPT = '''"""Evaluates surrogate.json, which stands beside this file: needs Python and NumPy alone.

    python evaluate_surrogate.py LLF.z=212.0 llr.Fx=1.1

prints every characteristic with its unit and left-out error; variables that are not named keep their start.
From Python: `evaluate({"LLF.z": 212.0})` gives a dictionary.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np

DOCUMENT = json.loads(Path(__file__).with_name("surrogate.json").read_text(encoding="utf-8"))


def place(variable, value):
    """Place in [0, 1] between the bounds."""
    low, high = variable["lower"], variable["upper"]
    if variable["logarithmic"]:
        return math.log(value / low) / math.log(high / low)
    return (value - low) / (high - low)


def evaluate(values):
    """Characteristic -> mean, in its unit."""
    unknown = set(values) - {variable["path"] for variable in DOCUMENT["inputs"]}
    if unknown:
        raise SystemExit(f"{sorted(unknown)[0]}: is no variable of the surrogate.")
    u = np.array([place(v, values.get(v["path"], v["start"])) for v in DOCUMENT["inputs"]])
    return {output["id"]: mean(output["formula"], u) for output in DOCUMENT["outputs"]}


def mean(formula, u):
    """level + slope z + sum of weight g, z = u - centre."""
    z = u - np.array(formula["centre"])
    total = formula["level"] + np.array(formula["slope"]) @ z
    if formula["rows"] is None:
        return float(total)
    rows = np.array(DOCUMENT["rows"][formula["rows"]])
    curvature = np.array(formula["curvature"])
    inner = rows @ (curvature * z)
    half = -0.5 * (curvature @ (z * z) + (rows * rows) @ curvature)
    terms = np.exp(half + inner)
    if formula["matern"]:
        distance = np.sqrt(np.maximum(-10.0 * (half + inner), 0.0))
        terms = (1.0 + distance + distance**2 / 3.0) * np.exp(-distance)
    if formula["pinned"]:
        terms = terms - np.exp(half) * (1.0 + inner)
    return float(total + np.array(formula["weight"]) @ terms)


if __name__ == "__main__":
    changes = dict(argument.split("=") for argument in sys.argv[1:])
    result = evaluate({path: float(value) for path, value in changes.items()})
    for output in DOCUMENT["outputs"]:
        print(f"{output['id']:32}{result[output['id']]:>16.9g}  {output['unit']}")
'''


def write_evaluator(folder: Path, saved: SavedSurrogate) -> list[Path]:
    """surrogate.json, evaluate_surrogate.py and surrogate_evaluator.xlsx; InputError for a model without a
    formula, RunError as `write_whole`."""
    formulas = mean_formulas(saved.model)
    rows, which = _row_blocks(formulas)
    document = {
        "format": "doe-kc surrogate formulas 1",
        "study": saved.study,
        "designs": saved.designs,
        "inputs": [vars(known) for known in saved.inputs],
        "outputs": [
            {**vars(known), "q2": _known(known.q2), "rmse": _known(known.rmse), "formula": _listed(f, block)}
            for known, f, block in zip(saved.outputs, formulas, which, strict=True)
        ],
        "rows": [block.tolist() for block in rows],
    }
    text = json.dumps(document, allow_nan=False, ensure_ascii=False)
    return [
        write_whole(folder / "surrogate.json", lambda p: p.write_text(text + "\n", encoding="utf-8")),
        write_whole(folder / "evaluate_surrogate.py", lambda p: p.write_text(SCRIPT, encoding="utf-8")),
        write_book_evaluator(folder / "surrogate_evaluator.xlsx", saved, formulas),
    ]


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _row_blocks(formulas: list[MeanFormula]) -> tuple[list[FloatArray], list[int | None]]:
    """Rows without repetition, and the block of each formula; None for a plane."""
    blocks: list[FloatArray] = []
    which: list[int | None] = []
    for formula in formulas:
        if not len(formula.rows):
            which.append(None)
            continue
        equal = (
            k for k, b in enumerate(blocks) if b.shape == formula.rows.shape and (b == formula.rows).all()
        )
        k = next(equal, len(blocks))
        if k == len(blocks):
            blocks.append(formula.rows)
        which.append(k)
    return blocks, which


def _listed(formula: MeanFormula, block: int | None) -> dict[str, object]:
    return {
        "level": formula.level,
        "slope": formula.slope.tolist(),
        "centre": formula.centre.tolist(),
        "curvature": formula.curvature.tolist(),
        "weight": formula.weight.tolist(),
        "rows": block,
        "pinned": formula.pinned,
        "matern": formula.matern,
    }


def write_book_evaluator(path: Path, saved: SavedSurrogate, formulas: list[MeanFormula]) -> Path:
    """Sheet Evaluator: values to type in, characteristics by live formulas; their numbers in other sheets.

    Those are hidden. Terms has a column an output and a row a design, Distances alike for a Matérn kernel,
    Rows the designs, Numbers a column an output: level, then slope, centre and curvature of every variable.
    RunError as `write_book`.
    """
    book = new_book(f"Surrogate: {saved.study}")
    blocks, which = _row_blocks(formulas)
    front = book.create_sheet("Evaluator")
    _put_inputs(front, saved)
    numbers = book.create_sheet("Numbers")
    for j, formula in enumerate(formulas):
        _put_numbers(numbers, j, saved.outputs[j].id, formula)
    for k, block in enumerate(blocks):
        sheet = book.create_sheet(f"Rows {k + 1}")
        for i, row in enumerate(block):
            for c, value in enumerate(row):
                sheet.cell(c + 1, i + 1, float(value))
    terms, distances = book.create_sheet("Terms"), book.create_sheet("Distances")
    for j, (formula, place) in enumerate(zip(formulas, which, strict=True)):
        _put_terms(terms, distances, j, saved.outputs[j].id, formula, place)
    for j, known in enumerate(saved.outputs):
        r, column = FIRST + j, get_column_letter(j + 1)
        put(front, r, 8, clean(f"{known.id}"))
        d = len(saved.inputs)
        z = f"(Evaluator!$F${FIRST}:$F${FIRST + d - 1}-Numbers!{column}${3 + d}:{column}${2 + 2 * d})"
        total = f"=Numbers!{column}$2+SUMPRODUCT(Numbers!{column}$3:{column}${2 + d},{z})"
        if which[j] is not None:
            total += f"+SUM(Terms!{column}$2:{column}${len(formulas[j].rows) + 1})"
        _put_formula(front, r, 9, total, "0.000000")
        put(front, r, 10, clean(known.unit), indent=1)
        put(front, r, 11, _known(known.rmse), number="0.000E+00")
        put(front, r, 12, clean(known.model), indent=1)
    for sheet in book.worksheets[1:]:
        sheet.sheet_state = "hidden"  # numbers alone, 150 printed pages of them
    return write_book(path, book)


def _put_formula(ws: Worksheet, row: int, column: int, formula: str, number: str) -> None:
    """A live formula, looking as the numbers beside it."""
    put(ws, row, column, 0.0, number=number)
    ws.cell(row, column).value = formula


def _put_inputs(ws: Worksheet, saved: SavedSurrogate) -> None:
    title(
        ws, "Surrogate evaluator", f"{saved.study}: type values in column B, shaded; {saved.designs} designs"
    )
    texts = {1, 3, 8, 10, 12}
    heads = ("Variable", "Value", "Unit", "Lowest", "Highest", "Place", None, "Characteristic", "Mean",
             "Unit", "Left-out RMSE", "Model")  # fmt: skip
    for c, head in enumerate(heads, start=1):
        if head is not None:
            side, indent = ("left", int(c in {3, 10, 12})) if c in texts else ("right", 0)
            put(ws, FIRST - 1, c, head, bold=True, horizontal=side, indent=indent)
    for i, known in enumerate(saved.inputs):
        r = FIRST + i
        put(ws, r, 1, clean(known.path))
        put(ws, r, 2, known.start, fill=TYPED)
        put(ws, r, 3, clean(known.unit), indent=1)
        put(ws, r, 4, known.lower)
        put(ws, r, 5, known.upper)
        linear = f"=(B{r}-D{r})/(E{r}-D{r})"
        ratio = f"=LN(B{r}/D{r})/LN(E{r}/D{r})"
        _put_formula(ws, r, 6, ratio if known.logarithmic else linear, "0.0000")
    _guard_inputs(ws, FIRST, FIRST + len(saved.inputs) - 1)
    widths(ws, (24, 14, 9, 12, 12, 10, 3, 32, 16, 10, 14, 12))
    ws.freeze_panes = f"A{FIRST}"
    ws.page_setup.orientation = "landscape"
    ws.page_setup.fitToHeight = 0
    ws.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    ws.print_title_rows = f"{FIRST - 1}:{FIRST - 1}"


def _guard_inputs(ws: Worksheet, first: int, last: int) -> None:
    """Ask before a value beyond the designs is taken, and show it red: there the surrogate knows nothing."""
    asked = DataValidation(
        type="decimal", operator="between", formula1=f"$D{first}", formula2=f"$E{first}", allow_blank=False,
        errorStyle="warning", showErrorMessage=True, errorTitle="Beyond the designs",
        error="The surrogate has learnt nothing outside Lowest and Highest.",
    )  # fmt: skip
    asked.add(f"B{first}:B{last}")
    ws.add_data_validation(asked)
    beyond = f"OR(NOT(ISNUMBER($B{first})),$B{first}<$D{first},$B{first}>$E{first})"
    ws.conditional_formatting.add(f"B{first}:B{last}", FormulaRule([beyond], fill=BEYOND))


def _put_numbers(ws: Worksheet, j: int, name: str, formula: MeanFormula) -> None:
    numbers = [formula.level, *formula.slope, *formula.centre, *formula.curvature]
    ws.cell(1, j + 1, clean(name))
    for r, value in enumerate(numbers, start=2):
        ws.cell(r, j + 1, float(value))


def _put_terms(
    ws: Worksheet, distances: Worksheet, j: int, name: str, formula: MeanFormula, block: int | None
) -> None:
    """Every row's part of the sum, its weight as a number in its formula."""
    for sheet in (ws, distances):
        sheet.cell(1, j + 1, clean(name))
    if block is None:
        return
    d, column = len(formula.centre), get_column_letter(j + 1)
    z = f"(Evaluator!$F${FIRST}:$F${FIRST + d - 1}-Numbers!{column}${3 + d}:{column}${2 + 2 * d})"
    v = f"Numbers!{column}${3 + 2 * d}:{column}${2 + 3 * d}"
    for i, weight in enumerate(formula.weight):
        at = get_column_letter(i + 1)
        row = f"'Rows {block + 1}'!${at}$1:${at}${d}"
        square = f"SUMPRODUCT({v},({z}-{row})^2)"
        term = f"EXP(-0.5*{square})"
        if formula.matern:
            distances.cell(i + 2, j + 1, f"=SQRT(5*{square})")
            s = f"Distances!{column}{i + 2}"
            term = f"(1+{s}+{s}^2/3)*EXP(-{s})"
        if formula.pinned:
            inner = f"SUMPRODUCT({v},{z},{row})"
            term = f"({term}-EXP(-0.5*SUMPRODUCT({v},{z}^2+{row}^2))*(1+{inner}))"
        ws.cell(i + 2, j + 1, f"={float(weight)!r}*{term}")
