"""Corrupted rig records: which of them the checks tell, and whether sound cars stay without a finding.

    python benchmarks/corruptions.py AXLE CARS [CARS ...] [--other FOLDER ...] [--out results/corruptions.md]

AXLE: axle file that the cars are of. CARS: folders whose sub-folders hold a `test.toml`; every corruption is
made of each in turn. --other: folders of sound cars of other axle types, checked without a model.
"""

from __future__ import annotations

import argparse
import logging
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
import pandas as pd

from doe_kc.axle_file import read_axle
from doe_kc.curves import CurveSet
from doe_kc.ground.errors import InputError
from doe_kc.load_cases import CASE_ORDER
from doe_kc.measurement import load_manifest
from doe_kc.measurement.branches import RunCurves, reduce_case
from doe_kc.measurement.channels import parse_heading
from doe_kc.measurement.records import own_names, record_from_table
from doe_kc.measurement.tables import ArrayTable
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.workflow.rig_checks import rig_findings

Frames = dict[str, pd.DataFrame]
Edit = Callable[[Frames], None]
INPUTS = {
    "vertical": "pad_z [mm]",
    "roll": "roll [deg]",
    "lateral": "force_y [N]",
    "lateral_opposite": "force_y [N]",
    "lateral_offset": "force_y [N]",
    "drive": "force_x [N]",
    "brake": "force_x [N]",
    "steer": "steering_wheel [deg]",
}
UNITS = {"toe": "deg", "camber": "deg", "caster": "deg", "tyre_load": "N"}


@dataclass(frozen=True)
class Corruption:
    """name: what was done. kinds: of finding, any of them is right. channel: glob of the finding's channel.
    edit: of the frames by file name (`vertical`, `vertical_repeat1`). text: of test.toml."""

    name: str
    kinds: tuple[str, ...]
    channel: str
    edit: Edit | None = None
    text: Callable[[str], str] | None = None
    case: str = "*"


@dataclass(frozen=True)
class Told:
    """What the checks said of a car: findings as (severity, kind, case, channel), or a refusal."""

    findings: tuple[tuple[str, str, str, str], ...]
    refusal: str = ""


def column(quantity: str, side: str) -> str:
    """Heading of a wheel's channel."""
    return f"{quantity}_{side} [{UNITS.get(quantity, 'mm')}]"


def of_case(frames: Frames, case: str | None) -> Iterator[pd.DataFrame]:
    """All runs of a load case, or of all."""
    for name, frame in frames.items():
        if case is None or name.split("_repeat")[0] == case:
            yield frame


def scaled(quantity: str, sides: str, factor: float, case: str | None = None) -> Edit:
    def edit(frames: Frames) -> None:
        for frame in of_case(frames, case):
            for side in sides:
                frame[column(quantity, side)] *= factor

    return edit


def input_scaled(case: str, factor: float) -> Edit:
    def edit(frames: Frames) -> None:
        for frame in of_case(frames, case):
            frame[INPUTS[case]] *= factor

    return edit


def input_shifted(case: str, offset: float) -> Edit:
    def edit(frames: Frames) -> None:
        for frame in of_case(frames, case):
            frame[INPUTS[case]] += offset

    return edit


def exchanged(one: str, other: str, case: str | None = None) -> Edit:
    def edit(frames: Frames) -> None:
        for frame in of_case(frames, case):
            frame[[one, other]] = frame[[other, one]].to_numpy()

    return edit


def sides_exchanged(case: str | None, quantities: Sequence[str]) -> Edit:
    def edit(frames: Frames) -> None:
        for quantity in quantities:
            exchanged(column(quantity, "L"), column(quantity, "R"), case)(frames)

    return edit


ALL = ("toe", "camber", "caster", "wc_x", "wc_y", "wc_z", "tyre_load")


def files_exchanged(one: str, other: str, *, back: bool = True) -> Edit:
    def edit(frames: Frames) -> None:
        for suffix in ("", "_repeat1", "_repeat2"):
            a, b = frames[one + suffix], frames[other + suffix]
            frames[one + suffix] = b.copy()
            if back:
                frames[other + suffix] = a.copy()

    return edit


def sample(file: str, heading: str, at: int, value: float, *, add: bool = False) -> Edit:
    def edit(frames: Frames) -> None:
        place = frames[file].index[at], heading
        frames[file].loc[place] = value + (float(frames[file].loc[place]) if add else 0.0)

    return edit


def run_changed(file: str, headings: Sequence[str], gain: float = 1.0, offset: float = 0.0) -> Edit:
    def edit(frames: Frames) -> None:
        for heading in headings:
            frames[file][heading] = gain * frames[file][heading] + offset

    return edit


def run_of(file: str, other: str) -> Edit:
    def edit(frames: Frames) -> None:
        changed = frames[other].copy()
        frames[file] = changed

    return edit


def stuck(file: str, heading: str, first: int, length: int) -> Edit:
    def edit(frames: Frames) -> None:
        frames[file].loc[first : first + length - 1, heading] = frames[file].loc[first, heading]

    return edit


def clipped(file: str, heading: str, quantile: float) -> Edit:
    def edit(frames: Frames) -> None:
        frames[file][heading] = frames[file][heading].clip(upper=frames[file][heading].quantile(quantile))

    return edit


def dead(case: str, heading: str, noise: float) -> Edit:
    def edit(frames: Frames) -> None:
        rng = np.random.default_rng(0)
        for frame in of_case(frames, case):
            frame[heading] = noise * rng.normal(size=len(frame))

    return edit


def gap(file: str, first: int, length: int) -> Edit:
    def edit(frames: Frames) -> None:
        frames[file] = frames[file].drop(index=range(first, first + length)).reset_index(drop=True)

    return edit


def drifting(file: str, heading: str, size: float) -> Edit:
    def edit(frames: Frames) -> None:
        frames[file][heading] += np.linspace(0.0, size, len(frames[file]))

    return edit


def noisy(file: str, heading: str, sd: float) -> Edit:
    def edit(frames: Frames) -> None:
        frames[file][heading] += np.random.default_rng(1).normal(size=len(frames[file])) * sd

    return edit


def replaced(old: str, new: str) -> Callable[[str], str]:
    return lambda text: text.replace(old, new)


def alignment(change: Callable[[str, str, float], float]) -> Callable[[str], str]:
    """change: side, angle, value -> value."""
    import re

    def edit(text: str) -> str:
        lines = []
        for line in text.split("\n"):
            side = re.match(r"(left|right) *=", line)
            if side is not None:
                line = re.sub(
                    r"(toe|camber|caster)_deg = ([-+.\d]+)",
                    lambda m, s=side: f"{m[1]}_deg = {change(s[1], m[1], float(m[2])):g}",  # type: ignore[misc]
                    line,
                )
            lines.append(line)
        return "\n".join(lines)

    return edit


def catalogue() -> list[Corruption]:
    """Every corruption, by kind."""
    out: list[Corruption] = []
    out += [Corruption(f"sign of {q}, all cases", ("sign",), f"{q}*", scaled(q, "LR", -1.0)) for q in ALL]
    for q, side in (
        ("toe", "R"),
        ("camber", "L"),
        ("caster", "R"),
        ("wc_x", "L"),
        ("wc_y", "R"),
        ("wc_z", "L"),
    ):
        out.append(Corruption(f"sign of {q}_{side}", ("sign",), f"{q}*", scaled(q, side, -1.0)))
    for q, case in (
        ("camber", "lateral"),
        ("wc_y", "lateral_opposite"),
        ("wc_x", "brake"),
        ("wc_z", "vertical"),
        ("caster", "drive"),
        ("toe", "steer"),
        ("toe", "vertical"),
        ("camber", "roll"),
        ("tyre_load", "roll"),
    ):
        out.append(
            Corruption(
                f"sign of {q} in {case}", ("sign", "sides"), f"[{q[0]}*]*", scaled(q, "LR", -1.0, case)
            )
        )
    for case in INPUTS:
        name = INPUTS[case].split(" ")[0]
        kinds = ("input_sign", "sides") if case == "roll" else ("input_sign",)
        out.append(
            Corruption(f"sign of the input of {case}", kinds, f"[{name[0]}*]*", input_scaled(case, -1.0))
        )
    for case in (None, "roll", "lateral", "steer"):
        words = "all cases" if case is None else case
        out.append(
            Corruption(
                f"left and right exchanged, {words}", ("sides", "input_sign"), "*", sides_exchanged(case, ALL)
            )
        )
    for q in ("toe", "camber", "wc_y", "wc_z", "tyre_load"):
        out.append(
            Corruption(f"left and right {q} exchanged", ("sides",), f"{q}*", sides_exchanged(None, (q,)))
        )
    for a, b, s in (
        ("toe", "camber", "LR"),
        ("wc_x", "wc_y", "LR"),
        ("camber", "caster", "L"),
        ("wc_y", "wc_z", "R"),
        ("toe", "caster", "LR"),
    ):

        def columns(frames: Frames, a: str = a, b: str = b, s: str = s) -> None:
            for side in s:
                exchanged(column(a, side), column(b, side))(frames)

        out.append(Corruption(f"columns {a} and {b} exchanged, {s}", ("columns",), f"*{b}*", columns))
    for q, factor, unit in (
        ("toe", np.pi / 180, "rad"),
        ("camber", np.pi / 180, "rad"),
        ("caster", 60.0, "minutes"),
        ("toe", 60.0, "minutes"),
        ("wc_x", 1e-3, "m"),
        ("wc_y", 1 / 25.4, "in"),
        ("wc_z", 0.1, "cm"),
        ("wc_z", 1e-3, "m"),
        ("tyre_load", 1e-3, "kN"),
        ("tyre_load", 1 / 9.80665, "kg"),
        ("tyre_load", 1 / 4.4482216, "lbf"),
        ("toe", 2.0, "total toe"),
    ):
        out.append(Corruption(f"{q} in {unit}", ("unit",), f"{q}*", scaled(q, "LR", factor)))
    out.append(Corruption("toe_L in rad", ("unit",), "toe_L", scaled("toe", "L", np.pi / 180)))
    for case, factor, unit in (
        ("lateral", 1e-3, "kN"),
        ("brake", 1 / 9.80665, "kg"),
        ("vertical", 1e-3, "m"),
        ("vertical", 0.1, "cm"),
        ("steer", np.pi / 180, "rad"),
        ("roll", np.pi / 180, "rad"),
    ):
        name = INPUTS[case].split(" ")[0]
        out.append(
            Corruption(
                f"input of {case} in {unit}",
                ("refused", "input_unit"),
                f"{name}*",
                input_scaled(case, factor),
            )
        )
    for a, b in (
        ("lateral", "lateral_opposite"),
        ("lateral", "lateral_offset"),
        ("drive", "brake"),
        ("lateral_opposite", "lateral_offset"),
    ):
        out.append(
            Corruption(f"records of {a} and {b} exchanged", ("load_case",), "*", files_exchanged(a, b))
        )
    out.append(
        Corruption(
            "lateral_opposite's files for lateral too",
            ("load_case",),
            "*",
            files_exchanged("lateral", "lateral_opposite", back=False),
        )
    )
    one = "vertical_repeat1"
    out += [
        Corruption("one repeat's toe_L x 10", ("repeat",), "toe_L", run_changed(one, ["toe_L [deg]"], 10.0)),
        Corruption(
            "one repeat's camber_R with its sign reversed",
            ("repeat",),
            "camber_R",
            run_changed(one, ["camber_R [deg]"], -1.0),
        ),
        Corruption(
            "one repeat's tyre_load_L + 200 N",
            ("repeat",),
            "tyre_load_L",
            run_changed(one, ["tyre_load_L [N]"], 1.0, 200.0),
        ),
        Corruption(
            "one repeat's wc_y_R + 1 mm",
            ("repeat",),
            "wc_y_R",
            run_changed("brake_repeat2", ["wc_y_R [mm]"], 1.0, 1.0),
        ),
        Corruption(
            "one repeat's force + 200 N", ("repeat",), "*", run_changed("brake", ["force_x [N]"], 1.0, 200.0)
        ),
        Corruption("one repeat's pad x 1.1", ("repeat",), "*", run_changed(one, ["pad_z [mm]"], 1.1)),
        Corruption(
            "the main run's pad with its sign reversed",
            ("repeat",),
            "*",
            run_changed("vertical", ["pad_z [mm]"], -1.0),
        ),
        Corruption(
            "a repeat of brake is one of drive", ("repeat",), "*", run_of("brake_repeat1", "drive_repeat1")
        ),
        Corruption(
            "the main run of lateral is one of lateral_opposite",
            ("repeat", "load_case"),
            "*",
            run_of("lateral", "lateral_opposite_repeat1"),
        ),
        Corruption(
            "a sample of toe_L of 1e6", ("outlier",), "toe_L", sample("vertical", "toe_L [deg]", 100, 1e6)
        ),
        Corruption(
            "a sample of toe_L of 1e300", ("outlier",), "toe_L", sample("vertical", "toe_L [deg]", 100, 1e300)
        ),
        Corruption(
            "a sample of wc_z_R of -9999", ("outlier",), "wc_z_R", sample("roll", "wc_z_R [mm]", 300, -9999.0)
        ),
        Corruption(
            "a sample of camber_L 0.1 deg off",
            ("outlier",),
            "camber_L",
            sample("lateral", "camber_L [deg]", 200, 0.1, add=True),
        ),
        Corruption(
            "a sample of tyre_load_R 150 N off",
            ("outlier",),
            "tyre_load_R",
            sample("steer", "tyre_load_R [N]", 60, 150.0, add=True),
        ),
        Corruption(
            "a sample of the pad 40 mm off",
            ("outlier",),
            "pad_z",
            sample("vertical", "pad_z [mm]", 180, 40.0, add=True),
        ),
        Corruption("toe_R dead", ("dead",), "toe_R", dead("roll", "toe_R [deg]", 0.0)),
        Corruption("wc_y_L shows noise alone", ("dead",), "wc_y_L", dead("drive", "wc_y_L [mm]", 0.02)),
        Corruption(
            "camber_L shows noise alone", ("dead",), "camber_L", dead("vertical", "camber_L [deg]", 0.003)
        ),
        Corruption(
            "wc_x_L stuck for 30 samples", ("stuck",), "wc_x_L", stuck("brake", "wc_x_L [mm]", 200, 30)
        ),
        Corruption(
            "toe_L stuck for 100 samples",
            ("stuck",),
            "toe_L",
            stuck("steer_repeat1", "toe_L [deg]", 300, 100),
        ),
        Corruption(
            "tyre_load_R clipped at its upper 15 %",
            ("clipped",),
            "tyre_load_R",
            clipped("vertical", "tyre_load_R [N]", 0.85),
        ),
        Corruption(
            "camber_L clipped at its upper 5 %",
            ("clipped",),
            "camber_L",
            clipped("roll", "camber_L [deg]", 0.95),
        ),
        Corruption("60 samples missing", ("gap",), "*", gap("lateral", 100, 60)),
        Corruption("20 samples missing", ("gap",), "*", gap("vertical_repeat1", 300, 20)),
        Corruption(
            "camber_R drifts by 0.1 deg", ("drift",), "camber_R", drifting("lateral", "camber_R [deg]", 0.1)
        ),
        Corruption(
            "tyre_load_L drifts by 400 N",
            ("drift",),
            "tyre_load_L",
            drifting("vertical", "tyre_load_L [N]", 400.0),
        ),
        Corruption(
            "caster_L with ten times the noise",
            ("noise",),
            "caster_L",
            noisy("brake", "caster_L [deg]", 0.03),
        ),
        Corruption(
            "wc_x_R with ten times the noise", ("noise",), "wc_x_R", noisy("vertical", "wc_x_R [mm]", 0.2)
        ),
        Corruption("input of vertical + 5 mm", ("input_offset",), "pad_z", input_shifted("vertical", 5.0)),
        Corruption("input of lateral + 300 N", ("input_offset",), "force_y", input_shifted("lateral", 300.0)),
        Corruption(
            "input of steer + 20 deg", ("input_offset",), "steering_wheel", input_shifted("steer", 20.0)
        ),
        Corruption("input of roll + 0.3 deg", ("input_offset",), "roll", input_shifted("roll", 0.3)),
        Corruption(
            "toe_R given as a copy of toe_L",
            ("copy",),
            "toe_R",
            lambda f: [x.__setitem__("toe_R [deg]", x["toe_L [deg]"]) for x in f.values()] and None,
        ),
        Corruption(
            "alignment: caster with its sign reversed",
            ("alignment",),
            "caster*",
            text=alignment(lambda s, a, v: -v if a == "caster" else v),
        ),
        Corruption(
            "alignment: caster 3 deg off",
            ("alignment",),
            "caster*",
            text=alignment(lambda s, a, v: v + 3.0 if a == "caster" else v),
        ),
        Corruption(
            "alignment: camber in minutes",
            ("alignment",),
            "camber*",
            text=alignment(lambda s, a, v: 60 * v if a == "camber" else v),
        ),
        Corruption(
            "alignment: right camber with its sign reversed",
            ("alignment",),
            "camber*",
            text=alignment(lambda s, a, v: -v if (s, a) == ("right", "camber") else v),
        ),
        Corruption(
            "alignment: toe 0.8 deg off",
            ("alignment",),
            "toe*",
            text=alignment(lambda s, a, v: v + 0.8 if a == "toe" else v),
        ),
        Corruption(
            "alignment: camber and caster exchanged",
            ("alignment",),
            "c*",
            text=lambda t: (
                t.replace("camber_deg", "x_deg")
                .replace("caster_deg", "camber_deg")
                .replace("x_deg", "caster_deg")
            ),
        ),
    ]
    return out


@dataclass(frozen=True)
class Car:
    """A test: its `test.toml` and records by file name, and the reduced runs of its load cases."""

    folder: Path
    text: str
    frames: Frames
    runs: dict[str, tuple[RunCurves, ...]]


def read_car(folder: Path) -> Car:
    """As its files are."""
    frames = {p.stem: pd.read_csv(p) for p in sorted(folder.glob("*.csv"))}
    text = (folder / "test.toml").read_text(encoding="utf-8")
    car = Car(folder, text, frames, {})
    for case in (c for c in CASE_ORDER if c in frames):
        car.runs[case] = reduced(frames, case)
    return car


def reduced(frames: Frames, case: str) -> tuple[RunCurves, ...]:
    """Of a load case, by the way of every record: channel map, checks of the sweep, outliers, branches."""
    return reduce_case(
        [
            record_from_table(table(name, frame), case, own_names())
            for name, frame in frames.items()
            if name.split("_repeat")[0] == case
        ]
    )


def table(name: str, frame: pd.DataFrame) -> ArrayTable:
    """A frame as a container would give it."""
    headings = tuple(parse_heading(c) for c in frame.columns)
    return ArrayTable(name, headings, tuple(frame[c].to_numpy(float) for c in frame.columns))


def told(car: Car, corruption: Corruption | None, model: CurveSet | None) -> Told:
    """What `doe-kc check` tells of a car's records with a corruption."""
    frames = {name: frame.copy() for name, frame in car.frames.items()}
    text = car.text
    if corruption is not None:
        if corruption.edit is not None:
            corruption.edit(frames)
        text = corruption.text(text) if corruption.text else text
    runs, refusal = {}, ""
    for case, sound in car.runs.items():
        names = [n for n in frames if n.split("_repeat")[0] == case]
        if all(frames[n].equals(car.frames[n]) for n in names):
            runs[case] = sound
            continue
        try:
            runs[case] = reduced(frames, case)
        except InputError as error:
            refusal = str(error)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.toml"
        path.write_text(text, encoding="utf-8")
        findings = rig_findings(path, load_manifest(path), runs, model)
    return Told(tuple((f.severity, f.kind, f.case, f.channel) for f in findings), refusal)


def right(corruption: Corruption, outcome: Told) -> bool:
    """Whether a finding, or the refusal, has the right kind and channel."""
    if "refused" in corruption.kinds and outcome.refusal:
        return corruption.channel.strip("*") in outcome.refusal
    return any(
        kind in corruption.kinds and (corruption.channel == "*" or fnmatchcase(channel, corruption.channel))
        for _, kind, _, channel in outcome.findings
    )


def cars_of(folders: Sequence[Path]) -> list[Path]:
    return [p.parent for folder in folders for p in sorted(folder.glob("*/test.toml"))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("axle", type=Path)
    parser.add_argument("cars", type=Path, nargs="+")
    parser.add_argument("--other", type=Path, nargs="*", default=[])
    parser.add_argument("--out", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--no-model", action="store_true")
    options = parser.parse_args()
    logging.disable(logging.WARNING)
    model = None if options.no_model else curve_set(solve(read_axle(options.axle)))
    cars = [read_car(folder) for folder in cars_of(options.cars)]
    lines = sound_lines(cars, model) + sound_lines([read_car(f) for f in cars_of(options.other)], None)
    rows = []
    for number, corruption in enumerate(catalogue()):
        if options.only not in corruption.name:
            continue
        car = cars[number % len(cars)]
        outcome = told(car, corruption, model)
        ok = right(corruption, outcome)
        words = "; ".join(f"{s} {k}.{c}.{n}" for s, k, c, n in outcome.findings[:3]) or "-"
        words = "refused: " + outcome.refusal.split(": ", 1)[-1][:90] if outcome.refusal else words
        rows.append((corruption, car.folder.name, ok, words))
        print("ok " if ok else "NO ", corruption.name, "|", car.folder.name, "|", words, flush=True)
    hit = sum(ok for *_, ok, _ in rows)
    print(f"{hit} of {len(rows)} told ({100 * hit / max(len(rows), 1):.1f} %)")
    print("\n".join(lines))
    if options.out is not None:
        sizes = size_rows(cars[:2], model)
        options.out.write_text(page(rows, lines, sizes, with_model=model is not None), encoding="utf-8")


SCANS: dict[str, tuple[str, str, Callable[[float], Edit], tuple[float, ...]]] = {
    "one sample of toe off, deg": (
        "outlier", "toe_L", lambda x: sample("lateral", "toe_L [deg]", 150, x, add=True), (0.02, 0.03,
        0.04, 0.06),
    ),
    "one run's camber times": (
        "repeat", "camber_R", lambda x: run_changed("vertical", ["camber_R [deg]"], x), (1.01, 1.02, 1.04,
        1.08),
    ),
    "one run's tyre load plus, N": (
        "repeat", "tyre_load_L", lambda x: run_changed("vertical", ["tyre_load_L [N]"], 1.0, x),
        (50.0, 100.0, 150.0, 200.0),
    ),
    "drift of camber in lateral, deg": (
        "drift", "camber_R", lambda x: drifting("lateral", "camber_R [deg]", x), (0.01, 0.02, 0.03, 0.05),
    ),
    "toe stuck in steer, samples": (
        "stuck", "toe_L", lambda x: stuck("steer", "toe_L [deg]", 300, int(x)), (6.0, 9.0, 12.0, 16.0),
    ),
    "samples missing": ("gap", "*", lambda x: gap("lateral", 100, int(x)), (5.0, 8.0, 12.0, 16.0)),
    "pad offset in vertical, mm": ("input_offset", "pad_z", lambda x: input_shifted("vertical", x), (0.5,
    1.0, 2.0)),
    "lateral force offset, N": (
        "input_offset", "force_y", lambda x: input_shifted("lateral", x), (100.0, 150.0, 200.0, 300.0),
    ),
    "noise of caster in brake, deg": (
        "noise", "caster_L", lambda x: noisy("brake", "caster_L [deg]", x), (0.01, 0.015, 0.02, 0.03),
    ),
}  # fmt: skip
"""Corruption -> kind, channel, edit of a size, sizes."""


def size_rows(cars: Sequence[Car], model: CurveSet | None) -> list[tuple[str, str, str]]:
    """Name, kind and the least size from which all larger ones are told on every car."""
    out = []
    for name, (kind, channel, make, sizes) in SCANS.items():
        least = "-"
        for size in reversed(sizes):
            corruption = Corruption(name, (kind,), channel, make(size))
            if not all(right(corruption, told(car, corruption, model)) for car in cars):
                break
            least = f"{size:g}"
        out.append((name, kind, least))
        print("size", name, least, flush=True)
    return out


def page(
    rows: Sequence[tuple[Corruption, str, bool, str]],
    sound: Sequence[str],
    sizes: Sequence[tuple[str, str, str]],
    *,
    with_model: bool,
) -> str:
    """The result as Markdown."""
    hit = sum(ok for *_, ok, _ in rows)
    kinds = sorted({k for c, *_ in rows for k in c.kinds})
    clean = sum(line.endswith(": -") for line in sound)
    head = [
        "# Corrupted rig records",
        "",
        f"`python benchmarks/corruptions.py`, {'beside' if with_model else 'without'} the nominal model. "
        f"{hit} of {len(rows)} corruptions of {len(kinds)} kinds are told with the right kind and channel "
        f"({100 * hit / max(len(rows), 1):.1f} %); {clean} of {len(sound)} sound cars are without any "
        f"finding. "
        "The thresholds were set on these cars.",
        "",
        "| corruption | car | right | told |",
        "|---|---|---|---|",
    ]
    body = [f"| {c.name} | {car} | {'yes' if ok else 'NO'} | {words} |" for c, car, ok, words in rows]
    scan = ["", "## From which size", "", "| corruption | kind | told from |", "|---|---|---|"]
    scan += [f"| {name} | `{kind}` | {least} |" for name, kind, least in sizes]
    cars = ["", "## Sound cars", "", *(f"- {line}" for line in sound), ""]
    return "\n".join([*head, *body, *scan, *cars])


def sound_lines(cars: Sequence[Car], model: CurveSet | None) -> list[str]:
    out = []
    for car in cars:
        outcome = told(car, None, model)
        words = "; ".join(f"{s} {k}.{c}.{n}" for s, k, c, n in outcome.findings) or "-"
        out.append(f"{car.folder.parent.parent.name}/{car.folder.name}: {outcome.refusal or words}")
    return out


if __name__ == "__main__":
    main()
