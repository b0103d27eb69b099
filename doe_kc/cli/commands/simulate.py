"""`doe-kc simulate`: K&C curves and characteristics of a model, changed by `--set` and `--effect`."""

from __future__ import annotations

import logging
import re
import time
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from doe_kc.axle import Axle, parameter_value, with_values
from doe_kc.axle.geometry import check_geometry
from doe_kc.axle.kinematics import as_mechanism
from doe_kc.axle.model import with_roll
from doe_kc.axle.plausibility import axle_warnings
from doe_kc.axle_file import read_axle
from doe_kc.cli._app import app
from doe_kc.cli.options import JsonOption, PictureChoice
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.output import write_json
from doe_kc.ground.picture_format import PictureFormat
from doe_kc.reports.simulation.tables import characteristics_document, write_simulation
from doe_kc.solver.newton import RIGID_SETTINGS
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve

SETTING = re.compile(r"\s*([^=+*\s]+)\s*([+*]?=)\s*(\S+)\s*$")


def apply_settings(axle: Axle, settings: Iterable[str]) -> Axle:
    """PATH=VALUE sets, PATH+=DELTA adds, PATH*=FACTOR scales; later ones see the earlier."""
    values: dict[str, float] = {}
    for text in settings:
        match = SETTING.match(text)
        if match is None:
            raise InputError(
                f"--set {text}: expected PATH=VALUE, PATH+=DELTA or PATH*=FACTOR, as in LLF.x+=1.0."
            )
        path, operator, number = match.groups()
        now = values.get(path)
        now = parameter_value(axle, path, source="--set") if now is None else now
        values[path] = _changed(now, operator, _number(number, text))
    changed = with_values(axle, values, source="--set") if values else axle
    check_geometry(changed, "--set")
    return changed


def _changed(now: float, operator: str, operand: float) -> float:
    if operator == "+=":
        return now + operand
    return now * operand if operator == "*=" else operand


def _number(text: str, setting: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"--set {setting}: {text!r} is not a number.") from None


def apply_effects(axle: Axle, effects: Iterable[str]) -> Axle:
    """ID or ID:key=value,...; values as in TOML, lists in brackets, plain words without quotes."""
    for text in effects:
        ident, _, rest = text.partition(":")
        options = dict(_options(rest, text)) if rest else {}
        axle = apply_effect(axle, ident.strip(), options, source="--effect")
    return axle


def _options(text: str, argument: str) -> Iterator[tuple[str, Any]]:
    for part in _split(text):
        key, equals, value = part.partition("=")
        if not equals or not key.strip():
            raise InputError(f"--effect {argument}: {part!r}, expected key=value.")
        yield key.strip(), _value(value.strip())


def _split(text: str) -> Iterator[str]:
    """At commas outside brackets."""
    depth, start = 0, 0
    for i, letter in enumerate(text):
        depth += (letter in "[{") - (letter in "]}")
        if letter == "," and depth == 0:
            yield text[start:i]
            start = i + 1
    yield text[start:]


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except RecursionError:
        return text
    except ValueError:  # TOMLDecodeError; plain for a number of 5000 digits
        if text.startswith("[") and text.endswith("]"):
            return [_value(part.strip()) for part in _split(text[1:-1])]
        return text


log = logging.getLogger("doe_kc")


@app.command("simulate")
def simulate(
    axle: Annotated[Path, typer.Argument(metavar="AXLE", help="Axle file (TOML).")],
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PATH=VALUE", help="PATH=VALUE, PATH+=DELTA or PATH*=FACTOR."),
    ] = None,
    effects: Annotated[
        list[str] | None,
        typer.Option("--effect", metavar="ID:key=value,...", help="Add an optional effect."),
    ] = None,
    case: Annotated[list[str] | None, typer.Option(help="Load case; all by default.")] = None,
    roll: Annotated[str | None, typer.Option(help="Roll technique: body or counter_phase.")] = None,
    kinematic: Annotated[
        bool,
        typer.Option("--kinematic", help="Joints in place of all bushings: pure kinematics."),
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="Folder for curves.csv, characteristics.csv and pictures.")
    ] = None,
    pictures: Annotated[
        PictureChoice, typer.Option(help="Format in which the deformed shapes are drawn, into --out.")
    ] = PictureChoice.NONE,
    json: JsonOption = None,
) -> None:
    """Solve the K&C load cases of an axle: curves (tidy CSV) and characteristics."""
    model = apply_settings(apply_effects(read_axle(axle), effects or []), settings or [])
    model = with_roll(model, roll, source="--roll")
    if pictures is not PictureChoice.NONE and out is None:
        raise InputError("--pictures: needs a folder to draw into; add --out DIR.")
    for sentence in axle_warnings(model):
        log.warning(sentence)
    if kinematic:
        model = as_mechanism(model, source="--kinematic")
    started = time.perf_counter()
    solution = solve(model, checked_cases(model, case), settings=RIGID_SETTINGS if kinematic else None)
    seconds = time.perf_counter() - started
    document = characteristics_document(solution, seconds)
    if json is not None:
        write_json(json, document)
    if out is not None:
        for path in (*write_simulation(solution, out), *_shapes(model, solution, out, pictures.value)):
            typer.echo(f"wrote {path}", err=True)
    for name, entry in document["characteristics"].items():
        typer.echo(f"{name:36}{entry['value']:>14.6g}  {entry['unit']}")


def _shapes(axle: Axle, solution: Solution, folder: Path, pictures: PictureFormat) -> list[Path]:
    if pictures == "none":
        return []
    from doe_kc.reports.axle.shapes import write_shape_figures

    return write_shape_figures(axle, solution, folder, pictures=pictures)


def checked_cases(axle: Axle, cases: list[str] | None) -> list[str] | None:
    """The load cases asked for; InputError for an unknown one."""
    for name in cases or []:
        if name not in axle.load_cases:
            raise InputError(
                f"--case {name}: is not a load case; known are {', '.join(axle.load_cases)}."
                f"{nearest(name, axle.load_cases)}"
            )
    return cases or None
