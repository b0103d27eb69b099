"""Tyre: radial spring in the wheel plane against a frictionless pad, with lift-off.

N = k (R - t) / cos(camber to the pad) at P, where the ray in the wheel plane, downwards through the
wheel centre, meets the pad; t is the distance. Of a wheel that has lifted off P is at the distance R.
Horizontal forces act at P, which a laterally and longitudinally compliant tyre moves by F / k along the
force.
"""

from __future__ import annotations

import casadi as ca

from doe_kc.curves import SIDES
from doe_kc.solver.builder import HOLD_WHEEL, LENGTH_SCALE, Builder
from doe_kc.solver.elements._base import mirror
from doe_kc.solver.elements._cuts import stretch


def add_tyres(b: Builder) -> None:
    """`contact.L`/`.R`: P in mm; `tyre.L`/`.R`: load N in N; `pad.L`/`.R`; pad height equations."""
    roll = b.control("roll")
    normal = ca.vertcat(0, -ca.sin(roll), ca.cos(roll))
    b.points["pad normal"] = normal
    static_load = b.constant(b.parameter("tyre.static_load"))
    for side in SIDES:
        pad = b.tail_unknown(f"pad {side}", f"pad {side}", LENGTH_SCALE)
        rate = b.constant(b.parameter(f"tyre.rate@{side}"))
        centre, spin = b.points[f"wheel centre.{side}"], b.points[f"spin.{side}"]
        sine = ca.dot(normal, spin)
        cosine = ca.sqrt(1 - sine**2)
        distance = (ca.dot(normal, centre) - pad) / cosine
        radius, held = _unloaded_radius(b, side), b.control("bilateral")
        squash = radius - distance
        squash = held * squash + (1 - held) * ca.fmax(squash, 0)
        reach = held * distance + (1 - held) * ca.fmin(distance, radius)
        load, contact = rate * squash / cosine, centre - reach * (normal - sine * spin) / cosine
        b.points[f"tyre.{side}"], b.points[f"pad.{side}"] = load, pad
        b.points[f"contact.{side}"] = contact + _horizontal_deflection(b, side) + _patch_probes(b, side)
        _loads(b, side, load * normal)
        b.close_tail(f"pad {side}", _pad_equation(b, side, pad, static_load, rate))
    _close_preload(b)


def _unloaded_radius(b: Builder, side: str) -> ca.SX:
    """R = h / cos(camber) + F_static cos(camber) / k: carries the static load at the design height."""
    camber = b.parameter(f"static.camber@{side}") * ca.pi / 180
    height, load = b.parameter(f"WLC.z@{side}"), b.parameter("tyre.static_load")
    return b.constant(height / ca.cos(camber) + load * ca.cos(camber) / b.parameter(f"tyre.rate@{side}"))


def _horizontal_deflection(b: Builder, side: str) -> ca.SX:
    """F / k of a horizontally compliant tyre; zero without the effect."""
    if not b.topology.tyre_horizontal:
        return ca.SX.zeros(3)
    along, across = (b.constant(1 / b.parameter(f"tyre.{a}_rate@{side}")) for a in ("long", "lat"))
    return ca.vertcat(along * b.control(f"brake_{side}"), across * b.control(f"lateral_{side}"), 0)


def _patch_probes(b: Builder, side: str) -> ca.SX:
    """Dislocation of the contact point along the horizontal forces on it."""
    y = mirror(side)
    brake, lateral = b.control(f"brake_{side}"), y * b.control(f"lateral_{side}")
    along = stretch(b, "contact patch|wheel", "x", side, lambda: brake)
    return ca.vertcat(along, y * stretch(b, "contact patch|wheel", "y", side, lambda: lateral), 0)


def _loads(b: Builder, side: str, normal_force: ca.SX) -> None:
    """Pad force and brake force at P, lateral force behind it, drive force at the wheel centre."""
    wheel, contact = b.bodies[f"wheel.{side}"], b.points[f"contact.{side}"]
    lateral, brake = b.control(f"lateral_{side}"), b.control(f"brake_{side}")
    behind = contact + ca.vertcat(b.control("lateral_offset"), 0, 0)
    b.push(wheel, normal_force + ca.vertcat(brake, 0, 0), contact)
    b.push(wheel, ca.vertcat(0, lateral, 0), behind)
    drive = ca.vertcat(-b.control(f"drive_{side}"), 0, 0)
    b.push(wheel, drive, b.points[f"wheel centre.{side}"])


def _pad_equation(b: Builder, side: str, pad: ca.SX, static_load: ca.SX, rate: ca.SX) -> ca.SX:
    """Prescribed pad height, or wheel-centre height, or static tyre load, all in mm."""
    by_centre, by_load = b.control(HOLD_WHEEL), b.control("hold_load")
    return (
        (1 - by_centre - by_load) * (pad - b.control(f"pad_{side}"))
        + by_centre * (b.points[f"wheel centre.{side}"][2] - b.control(f"wc_z_{side}"))
        + by_load * (b.points[f"tyre.{side}"] - static_load) / rate
    )


def _close_preload(b: Builder) -> None:
    """Prescribed preload, or the one that puts the mean wheel centre at its design height."""
    height = b.constant((b.parameter("WLC.z@L") + b.parameter("WLC.z@R")) / 2)
    mean = (b.points["wheel centre.L"][2] + b.points["wheel centre.R"][2]) / 2
    by_height = b.control("hold_height")
    rate = b.constant(b.parameter("spring.rate@L"))
    b.close_tail(
        "preload",
        (1 - by_height) * (b.points["preload"] - b.control("preload")) + by_height * rate * (mean - height),
    )
