"""Stiffness at zero deflection of bushings that become one number an axis: torsion bar, rack mount, hub."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.adams.bushings import bushing_table
from doe_kc.adams.conversion import Conversion
from doe_kc.adams.subsystem import AdamsElement, AdamsSubsystem


def bushing_laws(
    c: Conversion,
    axes: tuple[str, ...],
    subsystem: AdamsSubsystem,
    element: AdamsElement,
    name: str,
    order: tuple[int, ...],
) -> tuple[dict[str, Any], Path]:
    """A bushing's table of an axle file of which some `axes` (`Fy`) count, and its property file.

    name: of the bushing in remarks. order: (3,) ADAMS axis of each local axis. What is remarked on other axes
    is not told. InputError for a property file that is missing or does not read, a factor below 0, and a
    curve that falls or is on one side of zero only.
    """
    before = list(c.inferred)
    table, path = bushing_table(c, subsystem, element, name, order, (1.0, 1.0, 1.0))
    remarks = c.inferred[len(before) :]
    c.inferred[:] = before + [r for r in remarks if any(f" {axis} " in r for axis in axes)]
    return table, path


def centre_slope(c: Conversion, table: Mapping[str, Any], axis: str, path: Path) -> float:
    """Stiffness of one axis (`Fy`) at zero deflection with its factor, N/mm or Nm/deg.

    Of a curve it is the slope between the points nearest to zero, which is remarked. table: the bushing's, of
    an axle file. path: of its property file.
    """
    factor = float(table.get("factor", {}).get(axis, 1.0))
    if axis not in table.get("table", {}):
        return factor * float(table["stiffness"][axis])
    x, y = np.array(table["table"][axis]).T
    reach = float(np.abs(x[x != 0.0]).min())
    c.inferred.append(f"{path.name}: {axis} is not straight; its slope at zero counts")
    return factor * float(np.interp(reach, x, y) - np.interp(-reach, x, y)) / (2.0 * reach)
