"""One element at a time: stub bodies in given poses, and numbers for every symbol of a builder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
from scipy.spatial.transform import Rotation

from doe_kc.axle.topology import Topology
from doe_kc.solver.assembly import collected
from doe_kc.solver.builder import Body, Builder, body
from tests.reference import nominal

SIDES = ("L", "R")
MIRROR = np.diag([1.0, -1.0, 1.0])


def builder(**topology: object) -> Builder:
    """Empty, of the nominal axle's topology with some flags changed."""
    return Builder(changed(**topology))


def whole(**topology: object) -> Builder:
    """With all bodies and forces of the nominal axle, wrenches not yet handed on."""
    return collected(changed(**topology))


def changed(**topology: object) -> Topology:
    changes: dict[str, Any] = dict(topology)
    return replace(nominal().topology, **changes)


def gibbs(rotation_vector: np.ndarray | list[float]) -> np.ndarray:
    """tan(phi / 2) e of a rotation vector in rad."""
    phi = np.asarray(rotation_vector, dtype=float)
    angle = np.linalg.norm(phi)
    return np.zeros(3) if angle == 0 else np.tan(angle / 2) * phi / angle


def turned(rotation_vector: np.ndarray | list[float]) -> np.ndarray:
    return Rotation.from_rotvec(np.asarray(rotation_vector, dtype=float)).as_matrix()


def stub(
    name: str,
    design: object = (0.0, 0.0, 0.0),
    shift: object = (0.0, 0.0, 0.0),
    rotation: object = (0.0, 0.0, 0.0),
) -> Body:
    """Body whose pose is numbers: shifted by `shift` mm, turned by the rotation vector in rad."""
    origin = np.asarray(design, dtype=float) + np.asarray(shift, dtype=float)
    return body(name, ca.SX(np.asarray(design, dtype=float)), ca.SX(origin), ca.SX(gibbs(rotation)))


def hardpoint(name: str, side: str = "L") -> np.ndarray:
    """Design position of a hardpoint of the nominal axle, chassis frame."""
    left = np.array([nominal().values[f"{name}.{axis}@{side}"] for axis in "xyz"])
    return left if side == "L" else MIRROR @ left


def number(b: Builder, expression: ca.SX, given: Mapping[str, float] | None = None) -> np.ndarray:
    """The expression in numbers: nominal axle values, `given`, and zero for all other symbols."""
    known: dict[str, float] = {**nominal().values, **(given or {})}
    pairs: list[tuple[ca.SX, float]] = [(s, known[n]) for n, s in b.parameters.items()]
    pairs += [(s, known.get(n, 0.0)) for n, s in b.controls.items()]
    pairs += [(s, known.get(u.name, 0.0)) for u, s in b.tail]
    pairs += [(s, known.get(u.name, 0.0)) for u, s, _ in b.multipliers]
    pairs += [(f.symbol, known.get(f.name, 0.0)) for j in b.joints for f in j.freedoms]
    result = ca.SX(expression)
    if b.constants:
        symbols, expressions = zip(*b.constants, strict=True)
        _, (result,) = ca.substitute_inplace(list(symbols), list(expressions), [result])
    names = [s for s, _ in pairs]
    known_symbols = {s.element_hash() for s in names}
    free = [s for s in ca.symvar(result) if s.element_hash() not in known_symbols]
    assert not free, f"no number for {free}"
    values = ca.Function("number", names, [result])(*[v for _, v in pairs]) if names else ca.DM(result)
    return np.asarray(ca.DM(values)).squeeze()


def wrench(b: Builder, name: str, given: Mapping[str, float] | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Force in N and moment in N mm about the body's origin that a body has received."""
    force, moment = b.wrenches[name]
    return number(b, force, given), number(b, moment, given)


def about_origin(origin: np.ndarray, force: np.ndarray, moment: np.ndarray) -> np.ndarray:
    """Moment about the chassis origin."""
    return moment + np.cross(origin, force)
