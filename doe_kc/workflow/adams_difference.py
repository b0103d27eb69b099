"""What an axle has else than the import of ADAMS/Car files, and what of it has no place there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from doe_kc.adams.conversion import Conversion
from doe_kc.axle.design_parameters import is_active
from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import parameter_value
from doe_kc.effects import EFFECTS
from doe_kc.workflow.import_adams import AdamsImport

EXPORT_TOLERANCE = 1e-9
"""Relative difference of a value from which it is written."""
STOPS = ("bump_stop", "rebound_stop")
CURVE_SIZE = 1e3
"""N; a point of a curve is compared in absolute terms, since most curves go through zero."""
EFFECTS_WRITTEN = {
    *("bushing_preload", "bushing_progression", "left_right_asymmetry", "steering_ratio"),
    *("hub_compliance", "rack_mount_compliance", "anti_roll_bar_link_compliance"),
}
"""Effects that are numbers of ADAMS files, where the original has the element."""


def folded(axle: Axle) -> Axle:
    """The axle with what ADAMS has one number for in one number: column and its bushing, bar and links."""
    v = axle.values
    changed: dict[str, float] = {}
    if "steering.column" in v:
        changed |= {"steering.column": v["steering.column"] * v["scb.Tz"], "scb.Tz": 1.0}
    if "arb.rate" in v:
        bar = v["arb.rate"] * (v["arb.radius"] / v["arb.nominal_radius"]) ** 4
        rate = bar / (1.0 + 2.0 * bar * v["arb.link_flexibility"])
        changed |= {"arb.rate": rate, "arb.radius": v["arb.nominal_radius"], "arb.link_flexibility": 0.0}
    for stop in STOPS:
        factors = {v.get(f"{stop}.factor@{side}", 1.0) for side in "LR"}
        if factors != {1.0} and len(factors) == 1:
            factor = factors.pop()
            heads = (f"{stop}.table.y", f"{stop}.table.m")
            changed |= {name: factor * value for name, value in v.items() if name.startswith(heads)}
            changed |= {f"{stop}.factor@{side}": 1.0 for side in "LR"}
    return axle.changed(changed)


def differs(a: float, b: float) -> bool:
    return abs(a - b) > EXPORT_TOLERANCE * max(abs(a), abs(b), 1e-3)


@dataclass(frozen=True)
class AxleDifference:
    """A value of the axle that the copies do not have. path: without a side; left, right: as wanted."""

    path: str
    left: float
    right: float
    left_differs: bool
    right_differs: bool


def axle_differences(wanted: Axle, now: Axle) -> Iterator[AxleDifference]:
    """By path; curves and axes, which are compared as wholes, and the static load, which a spring tells, are
    left out."""
    paths = dict.fromkeys(name.partition("@")[0] for name in wanted.values)
    for path in paths:
        if ".table." in path or path == "tyre.static_load":
            continue
        sides = [f"{path}@{s}" for s in "LR"] if f"{path}@L" in wanted.values else [path]
        if any(name not in now.values for name in sides):
            continue
        apart = [differs(wanted.values[name], now.values[name]) for name in sides]
        if any(apart):
            left = parameter_value(wanted, path)
            right = parameter_value(wanted, f"right.{path}") if len(sides) == 2 else left
            yield AxleDifference(path, left, right, apart[0], apart[-1])


def unwritten_sentences(axle: Axle, wanted: Axle, result: AdamsImport) -> Iterator[str]:
    """Sentences on all that the import of the copies does not have."""
    now = folded(result.axle)
    for ident in axle.effects:
        if ident not in EFFECTS_WRITTEN:
            yield f"effect {ident} ({EFFECTS[ident].label}): there is no place for it in the files"
    if wanted.topology.hub and not now.topology.hub:
        yield "effect hub_compliance: the files have no bushing of the hub"
    elif wanted.topology.hub_stiffens and not now.topology.hub_stiffens:
        yield "effect hub_compliance: its law stiffening; the files' bushing has the stiffness at rest alone"
    if wanted.topology.rack_mount and not now.topology.rack_mount:
        yield "effect rack_mount_compliance: the files have no bushing of the rack's housing"
    own = set(_effect_names(axle))
    for d in axle_differences(wanted, now):
        if d.path not in own and _of_influence(wanted, d.path):
            sides = (
                f"{d.left:.10g}"
                if not differs(abs(d.left), abs(d.right))
                else f"{d.left:.10g} left, {d.right:.10g} right"
            )
            yield f"{d.path} = {sides}: there is no place for it in the files"
    if not _has_spring(result.conversion) and differs(
        wanted.values["tyre.static_load"], now.values["tyre.static_load"]
    ):
        yield f"tyre.static_load = {wanted.values['tyre.static_load']:.10g}: the name map says it, no file"
    for head in other_curves(wanted, now):
        yield f"the curve of {head}: the axle has other points than the files; they are not written"


def _of_influence(axle: Axle, path: str) -> bool:
    return is_active(axle, path) and not (path.startswith("CLAMP.") and not axle.topology.strut_bending)


def other_curves(wanted: Axle, now: Axle) -> list[str]:
    """Bushings and stops whose points are others."""
    names = {n for n in {*wanted.values, *now.values} if ".table." in n}
    nan = float("nan")
    other = {
        n.partition(".table.")[0]
        for n in names
        if not abs(wanted.values.get(n, nan) - now.values.get(n, nan)) <= EXPORT_TOLERANCE * CURVE_SIZE
    }
    return sorted(other)


def _effect_names(axle: Axle) -> Iterator[str]:
    """Values that belong to effects which are listed as a whole."""
    if "ride_height_offset" in axle.effects:
        yield "ride_height"


def _has_spring(c: Conversion) -> bool:
    return c.spring_force is not None and "tyre.static_load" not in c.names.values
