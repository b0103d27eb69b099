"""From which size on a corruption is told."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from corruptions.checking import Car, right, told
from corruptions.edit import Corruption, Edit
from corruptions.inputs import input_shifted
from corruptions.runs import run_changed
from corruptions.samples import drifting, gap, noisy, sample, stuck

from doe_kc.curves import CurveSet

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
