"""The axle: read, changed, its parameters as a table."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from doe_kc import axle_file
from doe_kc.axle import Axle, design_parameters
from doe_kc.axle import with_values as changed_axle
from doe_kc.axle.geometry import check_geometry
from doe_kc.axle_types import BUILT_IN, read_axle_type
from doe_kc.axle_types.read import FOLDER
from doe_kc.effects import apply_effect

if TYPE_CHECKING:
    import pandas as pd


def read_axle(path: str | PathLike[str]) -> Axle:
    """The axle of an axle file (TOML); see docs/axle_file.md.

    Raises InputError naming file and key for anything wrong.

    >>> kc.read_axle("examples/front_axle/axle.toml")
    Axle('Front axle, McPherson', effects: none)
    """
    return axle_file.read_axle(Path(path))


def as_axle(axle: Axle | str | PathLike[str]) -> Axle:
    """An axle, read where a path stands for it."""
    return axle if isinstance(axle, Axle) else read_axle(axle)


def with_values(axle: Axle | str | PathLike[str], values: Mapping[str, float]) -> Axle:
    """A copy of the axle with parameters set to absolute values.

    values: path -> value. Hardpoints in mm in the chassis frame (x rearwards, y to the right, z up; the left
    side, `right.` for the other one), bushing stiffnesses as factors of the file's (1 = unchanged), the rest
    in its unit: see `parameters`. A plain path changes both sides alike; points that follow another move
    with it.

    Raises InputError for an unknown path (with the nearest name), a number that is not finite, a stiffness
    or radius that is not positive, or a geometry that no car has.

    >>> axle = kc.with_values("examples/front_axle/axle.toml", {"LLF.z": 213.0, "llr.Fx": 0.8})
    >>> kc.parameters(axle).loc[["LLF.z", "llr.Fx"], "nominal"].to_dict()
    {'LLF.z': 213.0, 'llr.Fx': 0.8}
    """
    changed = changed_axle(as_axle(axle), values, source="with_values")
    check_geometry(changed, "with_values")
    return changed


def with_effects(axle: Axle | str | PathLike[str], effects: Mapping[str, Mapping[str, Any]]) -> Axle:
    """A copy of the axle with optional effects added, in their order.

    effects: id -> options, as the tables `[effects.ID]` of an axle file; ids, keys and units in
    docs/effects.md.

    Raises InputError for an unknown effect or option, or a value out of its range.

    >>> hub = {"hub_compliance": {"camber_Nm_deg": 6000.0, "toe_Nm_deg": 9000.0}}
    >>> kc.with_effects("examples/front_axle/axle.toml", hub)
    Axle('Front axle, McPherson', effects: hub_compliance)
    """
    result = as_axle(axle)
    for ident, options in effects.items():
        result = apply_effect(result, ident, dict(options), source="with_effects")
    return result


def parameters(axle: Axle | str | PathLike[str]) -> pd.DataFrame:
    """Every design parameter of the axle, one row each, the path as index.

    Columns: label; group (HARDPOINTS, BUSHINGS, OTHER); unit ("-" for factors); nominal, the axle's value;
    lower, upper: default bounds; step: change of a one-at-a-time study; all absolute, in `unit`. active:
    whether the axle's equations contain it.

    Raises InputError as `read_axle`, where a path is given.

    >>> frame = kc.parameters("examples/front_axle/axle.toml")
    >>> frame["nominal"]["spring.rate"].item(), frame["unit"]["spring.rate"]
    (28.0, 'N/mm')
    """
    import pandas as pd

    return pd.DataFrame([vars(p) for p in design_parameters(as_axle(axle))]).set_index("path")


def types() -> pd.DataFrame:
    """The axle types, one row each, the name for `type` of an axle file as index.

    Columns: label; bodies, with commas; bushings, balls, rods: how many connections of each kind (of one
    side and the middle); rack: whether it steers; file: that describes it. An axle file without type is of
    the first, mcpherson_front.

    >>> kc.types().loc["five_link_rear", "label"]
    'Five-link, rear'
    """
    import pandas as pd

    rows: list[tuple[object, ...]] = []
    for name in BUILT_IN:
        axle_type = read_axle_type(name, Path(), source=name)
        s = axle_type.structure
        bodies = ", ".join((*s.single_bodies, *s.bodies)).replace("_", " ")
        counts = (len(s.bushings), len(s.balls), len(s.rods))
        rows.append(
            (name, axle_type.label, bodies, *counts, s.rack is not None, str(FOLDER / f"{name}.toml"))
        )
    columns = ["name", "label", "bodies", "bushings", "balls", "rods", "rack", "file"]
    return pd.DataFrame(rows, columns=columns).set_index("name")
