"""Samples that are wrong, missing, stuck, noisy or drift away."""

from __future__ import annotations

import numpy as np
from corruptions.edit import Corruption, Edit, Frames, of_case


def sample(file: str, heading: str, at: int, value: float, *, add: bool = False) -> Edit:
    def edit(frames: Frames) -> None:
        place = frames[file].index[at], heading
        frames[file].loc[place] = value + (float(frames[file].loc[place]) if add else 0.0)

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


def sample_faults() -> list[Corruption]:
    """Of one channel or file, by kind."""
    out: list[Corruption] = []
    out += [
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
    ]
    return out
