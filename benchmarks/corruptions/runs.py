"""Whole records under a wrong name, and repeats that differ."""

from __future__ import annotations

from collections.abc import Sequence

from corruptions.edit import Corruption, Edit, Frames


def files_exchanged(one: str, other: str, *, back: bool = True) -> Edit:
    def edit(frames: Frames) -> None:
        for suffix in ("", "_repeat1", "_repeat2"):
            a, b = frames[one + suffix], frames[other + suffix]
            frames[one + suffix] = b.copy()
            if back:
                frames[other + suffix] = a.copy()

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


def load_cases() -> list[Corruption]:
    """Records listed under another load case."""
    out: list[Corruption] = []
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
    return out


def repeats() -> list[Corruption]:
    """One run unlike the others of its load case."""
    out: list[Corruption] = []
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
    ]
    return out
