"""Anti-roll bar of the files: its rate from torsional stiffness and lever."""

from __future__ import annotations

import math

import numpy as np

from doe_kc.adams.conversion import Conversion, NumberPlace
from doe_kc.adams.points import PRODUCT_DIGITS, tidy
from doe_kc.ground.errors import InputError

TORSION_FACTORS = {
    "Nmm/deg": 180.0 / math.pi,
    "Nm/deg": 1000.0 * 180.0 / math.pi,
    "Nmm/rad": 1.0,
    "Nm/rad": 1000.0,
}
"""To N mm/rad."""
LINK_TILT = 15.0
"""deg of a drop link from the vertical, from which its pull along itself is told."""


def add_bar(conversion: Conversion) -> None:
    """`[arb]`: rate = torsional stiffness over the square of the lever; 0 where there is no bar."""
    c, names = conversion, conversion.names.arb
    row = c.parameter(names.torsion)
    if row is None:
        if "arb.rate" not in c.names.values:
            c.put("arb", "rate", 0.0, "no anti-roll bar among the files")
            c.inferred.append(f"there is no anti-roll bar: none of {', '.join(names.torsion)} is there")
        return
    file, parameter = row
    torsion = file.number(parameter.cell) * TORSION_FACTORS[names.torsion_unit]
    lever = _lever(c)
    if lever is None:
        if "arb.rate" not in c.names.values:
            c.missing.append(
                f"the lever of the anti-roll bar: hardpoints {' or '.join(names.axis)} and "
                f"{' or '.join(names.arm_end)}; correct axis and arm_end under [arb], or give arb.rate"
            )
        return
    c.put(
        "arb",
        "rate",
        tidy(torsion / lever**2, PRODUCT_DIGITS),
        f"{file.path.name}: {parameter.name}, lever {lever:.6g} mm",
    )
    c.numbers.append(
        NumberPlace(
            "arb.rate",
            file,
            parameter.cell,
            parameter.side,
            parameter.side_cell,
            gain=TORSION_FACTORS[names.torsion_unit] / lever**2,
        )
    )
    c.inferred.append(
        f"{parameter.name} is in {names.torsion_unit}, by the name map, on a lever of {lever:.5g} mm along X"
    )


def _lever(c: Conversion) -> float | None:
    """mm along X from the bar's axis to the drop link's end on it."""
    axis, end = (
        next((r.place for _, r in c.row(names) if r.side != "right"), None)
        for names in (c.names.arb.axis, c.names.arb.arm_end)
    )
    if axis is None or end is None:
        return None
    lever = abs(float(end[0] - axis[0]))
    if lever < 1.0:
        raise InputError(
            f"{c.database.subsystems[0].path}: the anti-roll bar's arm has {lever:.3g} mm along X; expected "
            "more. "
            "Correct axis and arm_end under [arb] of the name map."
        )
    points = c.document.get("hardpoints", {})
    if "ARB" in points:
        link = np.array(points["ARB"]) - c.frame.place(end)
        length = float(np.linalg.norm(link))
        tilt = float(np.degrees(np.arccos(min(1.0, abs(link[2]) / length)))) if length > 0.0 else 0.0
        if tilt > LINK_TILT:
            c.inferred.append(
                f"the drop link stands {tilt:.0f} deg from the vertical; its force is taken as vertical"
            )
    return lever
