"""The answer of a hidden car as TOML, sealed by its SHA-256."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import tomlkit

from benchmarks.discovery.car import Car
from benchmarks.discovery.hidden import Hidden
from benchmarks.discovery.sensors import Levels
from benchmarks.discovery.suites import Content
from doe_kc.axle import Axle

DIGITS = 9


def seal(text: str) -> str:
    """SHA-256 of a key, hexadecimal."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def key_text(
    name: str, seed: int, suite: str, base: str, nominal: Axle, car: Car, content: Content, errors: Levels
) -> str:
    """All that differs from the nominal model. [values]: internal values of the axle without effects."""
    document: dict[str, Any] = {
        "name": name,
        "seed": seed,
        "suite": suite,
        "base": base,
        "hidden_effects": [h.id for h in car.hidden],
        "exclude": list(content.exclude),
        "alike": list(content.pair),
        "effects": [_effect(h) for h in car.hidden],
        "clutter": [_effect(h) for h in car.clutter],
        "spread": asdict(content.spread),
        "noise": asdict(errors),
        "values": {k: v for k, v in car.axle.values.items() if v != nominal.values[k]},
    }
    if car.outside is not None:
        document["outside"] = {
            "kind": car.outside.kind,
            "size": car.outside.size,
            "unit": car.outside.unit,
            "shows": [list(place) for place in car.outside.shows],
        }
    return tomlkit.dumps(_plain(document))


def _effect(hidden: Hidden) -> dict[str, Any]:
    out = {
        "id": hidden.id,
        "size": hidden.size,
        "location": hidden.location or "",
        "stiffening": hidden.stiffening,
        "approximate": hidden.approximate,
        "parameters": dict(hidden.parameters),
        "options": dict(hidden.options),
    }
    if hidden.tables:
        out["tables"] = {f"{name}.{of}": points for (name, of), points in hidden.tables.items()}
    return out


def _plain(value: Any) -> Any:
    """Numbers rounded, tuples as lists: the same text on every machine."""
    if isinstance(value, Mapping):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    return value
