"""Axles of five more types: curves solved by an independent multibody code (EXUDYN 1.13.6)."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import pandas as pd

from doe_kc.axle import Axle, parameter_value, with_values
from doe_kc.axle_file import read_axle
from doe_kc.effects import apply_effect
from tests.reference import OTHER_PATHS

DATA = Path(__file__).parent / "data" / "axle_types"
EXAMPLES = Path(__file__).parents[1] / "examples"
TYPES = tuple(sorted(path.name for path in DATA.iterdir()))
PATHS = OTHER_PATHS | {"springs.SPRING.k_N_mm": "spring.rate", "rack.column_N_mm": "steering.column"}
BUSHING_NAMES = {"BEAM": "beam_joint"}


def own_bushing(name: str) -> str:
    """Their name of a bushing as ours."""
    return BUSHING_NAMES.get(name, name.lower())


@lru_cache
def nominal(axle_type: str) -> Axle:
    return read_axle(EXAMPLES / axle_type / "axle.toml")


def document(axle_type: str, name: str) -> dict[str, dict[str, object]]:
    """What a file changes."""
    return tomllib.loads((DATA / axle_type / f"{name}.toml").read_text(encoding="utf-8"))


def variant(axle_type: str, name: str) -> Axle:
    """The nominal axle with the changes of a variant."""
    axle, changes = nominal(axle_type), document(axle_type, name)
    values: dict[str, float] = {}
    for table in ("points", "points_single"):
        for point, change in changes.get(table, {}).items():
            for axis, delta in zip("xyz", change, strict=True):
                path = f"{'WLC' if point == 'WC' else point}.{axis}"
                values[path] = parameter_value(axle, path) + delta
    for bushing, factors in changes["bushings"].items():
        for axis, factor in zip(("Fx", "Fy", "Fz", "Tx", "Ty", "Tz"), factors, strict=True):
            values[f"{own_bushing(bushing)}.{axis}"] = factor
    for key, value in changes["other"].items():
        path = PATHS[key]
        base = parameter_value(axle, path)
        values[path] = base + value if key.startswith("wheel.") else base * value
    return with_values(axle, values)


def curves(axle_type: str, name: str) -> pd.DataFrame:
    return pd.read_csv(DATA / axle_type / f"{name}.csv.xz")


def files(axle_type: str) -> list[str]:
    """Names of the type's curves."""
    return sorted(path.name.removesuffix(".csv.xz") for path in (DATA / axle_type).glob("*.csv.xz"))


EFFECT_IDS = {
    "bushing_cubic": "bushing_progression",
    "link_compliance": "tie_rod_compliance",
}
"""Their tables whose effects have other names here."""


def with_effect(axle_type: str, name: str) -> Axle:
    """The nominal axle with the effect of a file."""
    ((table, options),) = document(axle_type, name).items()
    axle, ident = nominal(axle_type), EFFECT_IDS.get(table, table)
    if table == "free_play" and name == "effect_ball_free_play":
        ident = "ball_free_play"
    return apply_effect(axle, ident, own_options(table, options), source=name)


def own_options(table: str, options: Mapping[str, Any]) -> dict[str, Any]:
    """Their options by our names."""
    out = dict(options)
    if table == "link_compliance":
        del out["links"]
    if table == "free_play":
        out["contact_N_mm"] = out.pop("k_contact_N_mm")
        assert out.pop("k_residual_N_mm") == 20.0
    if table == "subframe":
        wanted = {"body": "subframe", "centre": ["SFF", "SFR"]}
        assert {key: out.pop(key) for key in wanted} == wanted
        assert out.pop("k_N_mm") == [40000, 40000, 20000]
        assert out.pop("kr_Nm_deg") == [1500, 3000, 6000]
    return out
