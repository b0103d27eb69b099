"""Hardpoints of the files to those of an axle type: frame, units, sides, subsystems joined by name."""

from __future__ import annotations

import numpy as np

from doe_kc.adams.conversion import Conversion, NumberPlace
from doe_kc.adams.frame import AdamsFrame, frame_signs
from doe_kc.adams.name_map import FrameTable
from doe_kc.adams.subsystem import AdamsSubsystem, HardpointRow
from doe_kc.axle.parameter_kinds import COORDINATES
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

SAME_POINT = 0.01
"""mm; hardpoints of one name in two subsystems closer than this are one point."""
GROUND_BAND = (150.0, 500.0)
"""mm; height of a passenger car's wheel centre above the ground."""


def set_frame(conversion: Conversion) -> None:
    """The frame by what the name map says, else by the points: the left side, what is above what.

    InputError for a frame that is left-handed, or where the points contradict it.
    """
    c, table = conversion, conversion.names.frame
    signs = _signs(c, table)
    frame = AdamsFrame(signs)
    centre = _left(c, c.names.hardpoints["WLC"])
    if centre is None:
        raise InputError(
            f"{c.database.subsystems[0].path}: has no hardpoint {' or '.join(c.names.hardpoints['WLC'])}, "
            "the "
            "wheel centre; correct the name map."
        )
    if table.ground_z is not None:
        c.frame = AdamsFrame(signs, float(signs[2]) * table.ground_z)
        return
    height = frame.place(centre[1].place)[2]
    if not GROUND_BAND[0] <= height <= GROUND_BAND[1]:
        raise InputError(
            f"{centre[0].path}: line {centre[1].side_cell.line}: the wheel centre is {height:.4g} mm above "
            "the "
            "origin, so the ground is not there; give its height in the files' frame as ground_z under "
            "[frame] "
            "of the name map."
        )
    c.inferred.append(f"the ground is at z = 0 of the files: the wheel centre is {height:.4g} mm above it")
    c.frame = frame


def _signs(c: Conversion, table: FrameTable) -> FloatArray:
    said = [
        None if word is None else sign
        for word, sign in (
            (table.x, 1.0 if table.x == "rearwards" else -1.0),
            (table.y, 1.0 if table.y == "right" else -1.0),
            (table.z, 1.0 if table.z == "up" else -1.0),
        )
    ]
    lower, upper = (_left(c, c.names.hardpoints[p]) for p in (c.names.lower, c.names.upper))
    centre = _left(c, c.names.hardpoints["WLC"])
    source = str(c.database.subsystems[0].path)
    if lower is None or upper is None or centre is None:
        lacking = c.names.lower if lower is None else c.names.upper if upper is None else "WLC"
        raise InputError(
            f"{source}: has no hardpoint for {lacking} ({', '.join(c.names.hardpoints[lacking])}); "
            "name the one that it is in the name map (--map)."
        )
    seen_y = -float(np.sign(centre[1].place[1]))
    seen_z = float(np.sign(upper[1].place[2] - lower[1].place[2]))
    for axis, stated, seen in (("y", said[1], seen_y), ("z", said[2], seen_z)):
        if seen == 0.0 or (stated is not None and stated != seen):
            raise InputError(
                f"{centre[0].path}: line {centre[1].side_cell.line}: the left wheel centre at y = "
                f"{centre[1].place[1]:g} and {c.names.upper} {'above' if seen_z > 0 else 'below'} "
                f"{c.names.lower} "
                f"contradict {axis} under [frame] of the name map; correct it."
            )
    try:
        signs = frame_signs(said[0], seen_y, seen_z)
    except ValueError as error:
        raise InputError(f"{source}: [frame] of the name map: {error}; correct it.") from None
    if None in said:
        c.inferred.append(
            f"the frame is {AdamsFrame(signs).words()}: left points have y {'<' if seen_y > 0 else '>'} 0, "
            f"{c.names.upper} lies {'above' if seen_z > 0 else 'below'} {c.names.lower}, right-handed"
        )
    return signs


def _left(c: Conversion, names: list[str]) -> tuple[AdamsSubsystem, HardpointRow] | None:
    return next(((s, r) for s, r in c.row(names) if r.side != "right"), None)


def add_points(conversion: Conversion, points: tuple[str, ...], single: tuple[str, ...] = ()) -> None:
    """`[hardpoints]`, `[follow]` and what of `[right]` is a hardpoint's; missing ones are noted.

    InputError for a `single` point where one a side is needed.
    """
    c = conversion
    leaders: dict[str, str] = {}
    for point in points:
        names = c.names.hardpoints.get(point, [])
        rows = c.row(names)
        if not rows:
            continue
        _join(c, point, rows)
        subsystem, left = next(((s, r) for s, r in rows if r.side != "right"), rows[0])
        if (left.side == "single") != (point in single):
            raise InputError(
                f"{subsystem.path}: line {left.side_cell.line}: hardpoint {left.name} is {left.side!r}, but "
                f"{point} of the type is {'one for both sides' if point in single else 'one a side'}; "
                "correct the name map."
            )
        place = c.frame.place(left.place)
        c.put("hardpoints", point, [tidy(v) for v in place], f"{subsystem.path.name}: {left.name}")
        if left.name.lower() != names[0].lower():
            c.inferred.append(f"{point} is {left.name}: there is no {names[0]}")
        _add_right(c, point, rows, place)
        if left.name.lower() in leaders:
            c.document.setdefault("follow", {})[point] = leaders[left.name.lower()]
            continue
        leaders[left.name.lower()] = point
        for s, row in rows:
            _note_numbers(c, point, s, row)


def _join(c: Conversion, point: str, rows: list[tuple[AdamsSubsystem, HardpointRow]]) -> None:
    """Says that a point joins subsystems, and where their coordinates differ."""
    first, left = next(((s, r) for s, r in rows if r.side != "right"), rows[0])
    for other, row in rows:
        if other is first or row.side == "right":
            continue
        gap = float(np.abs(row.place - left.place).max())
        if gap > SAME_POINT:
            c.inferred.append(
                f"{point}: {left.name} of {first.path.name} and {other.path.name} are {gap:.4g} mm apart; "
                f"that of {first.path.name} counts"
            )
        else:
            c.inferred.append(f"{first.path.name} and {other.path.name} are joined at {left.name}")


def _add_right(
    c: Conversion, point: str, rows: list[tuple[AdamsSubsystem, HardpointRow]], left: FloatArray
) -> None:
    for subsystem, row in rows:
        if row.side != "right":
            continue
        place = c.frame.place(row.place)
        for axis, value, mirrored in zip(COORDINATES, place, left * (1.0, -1.0, 1.0), strict=True):
            if tidy(value) != tidy(mirrored):
                c.put_right(f"{point}.{axis}", tidy(value), f"{subsystem.path.name}: {row.name}, right")
        return


def _note_numbers(c: Conversion, point: str, subsystem: AdamsSubsystem, row: HardpointRow) -> None:
    side = "right." if row.side == "right" else ""
    shifts = (0.0, 0.0, -c.frame.ground)
    for axis, cell, sign, shift in zip(COORDINATES, row.cells, c.frame.signs, shifts, strict=True):
        gain = float(sign) * subsystem.units.length
        c.numbers.append(
            NumberPlace(
                f"{side}{point}.{axis}", subsystem.file, cell, row.side, row.side_cell, gain=gain, shift=shift
            )
        )


def derive_mcpherson_points(conversion: Conversion, top_mount: FloatArray | None) -> None:
    """Points of the McPherson axle that few templates have: UPBBI and SAH.

    top_mount: (3,) direction of the top mount's z, None where nothing tells it.
    """
    points = conversion.document.get("hardpoints", {})
    if "UPBBI" not in points and "UPB" in points:
        along = np.array([0.0, 0.0, 1.0]) if top_mount is None else top_mount
        place = np.array(points["UPB"]) + 100.0 * (along if along[2] > 0 else -along)
        source = "straight up" if top_mount is None else "along z of the top mount"
        conversion.put("hardpoints", "UPBBI", [tidy(v) for v in place], f"100 mm {source}")
        conversion.inferred.append(f"UPBBI is 100 mm from UPB, {source}")
    if "SAH" not in points and {"ROB", "WLC"} <= points.keys():
        place = 0.75 * np.array(points["ROB"]) + 0.25 * np.array(points["WLC"])
        conversion.put("hardpoints", "SAH", [tidy(v) for v in place], "between ROB and WLC; of use to none")
        conversion.inferred.append(
            "SAH is between ROB and WLC: the steer arm is rigid, so it has no influence"
        )


COORDINATE_DIGITS, PRODUCT_DIGITS = 15, 12
"""Significant digits of a number after its unit is converted, and of one that several numbers make."""


def tidy(value: float, digits: int = COORDINATE_DIGITS) -> float:
    """A number without what converting units leaves in its last digits."""
    return float(f"{value:.{digits}g}") + 0.0
