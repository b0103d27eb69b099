"""The result as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from corruptions.checking import Car, told
from corruptions.edit import Corruption

from doe_kc.curves import CurveSet


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
        "The thresholds were set on these cars. Records that the benchmark draws hold a few outlying "
        "samples, which are told as what they are.",
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
        name = car.folder.parent.name if car.folder.name == "records" else car.folder.name
        out.append(f"{name}: {outcome.refusal or words}")
    return out
