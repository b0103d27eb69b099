"""The nominal axle once more in numpy: poses, reactions and stored energy from a state vector.

Written from the definition of the reference axle, without the project's symbolic elements.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.spatial.transform import Rotation

from doe_kc.axle import Axle
from doe_kc.solver.kernel import Kernel

NM_PER_DEG = 1000.0 * 180.0 / np.pi
MIRROR = np.diag([1.0, -1.0, 1.0])
ARM_AXES = Rotation.from_euler("z", -90.0, degrees=True).as_matrix()
SIDES = ("L", "R")


@dataclass(frozen=True)
class Pose:
    design: np.ndarray
    origin: np.ndarray
    rotation: Rotation

    def point(self, position: np.ndarray) -> np.ndarray:
        return self.origin + self.rotation.apply(position - self.design)


GROUND = Pose(np.zeros(3), np.zeros(3), Rotation.identity())


@dataclass
class State:
    """reactions: (force, where) of the vehicle body on the axle; couples: its moments; energy: N mm."""

    poses: dict[str, Pose]
    reactions: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)
    couples: list[np.ndarray] = field(default_factory=list)
    energy: float = 0.0


def from_gibbs(p: np.ndarray) -> Rotation:
    """Quaternion (p, 1) normalised."""
    return Rotation.from_quat(np.append(p, 1.0))


def position(axle: Axle, name: str, side: str) -> np.ndarray:
    left = np.array([axle.values[f"{name}.{a}@{side}"] for a in "xyz"])
    return left if side == "L" else MIRROR @ left


def poses(axle: Axle, kernel: Kernel, x: np.ndarray) -> dict[str, Pose]:
    value = {u.name: float(v) for u, v in zip(kernel.layout.unknowns, x, strict=True)}

    def shift(name: str) -> np.ndarray:
        return np.array([value[f"{name}.{a}"] for a in "xyz"])

    def turn(name: str) -> Rotation:
        return from_gibbs(np.array([value[f"{name}.r{a}"] for a in "xyz"]))

    mounts = [position(axle, n, s) for n in ("SFF", "SFR") for s in SIDES]
    centre = np.mean(mounts, axis=0)
    out = {"subframe": Pose(centre, centre + shift("sub-frame"), turn("sub-frame"))}
    for side in SIDES:
        ball = position(axle, "LWB", side)
        arm = Pose(ball, ball + shift(f"lower arm {side}"), turn(f"lower arm {side}"))
        knuckle = Pose(ball, arm.origin, turn(f"knuckle {side}"))
        top = position(axle, "UPB", side)
        axis = top - position(axle, "LWD", side)
        axis /= np.linalg.norm(axis)
        origin = knuckle.point(top) + knuckle.rotation.apply(axis) * value[f"strut slide {side}"]
        twist = from_gibbs(axis * value[f"strut twist {side}"])
        out |= {f"arm.{side}": arm, f"knuckle.{side}": knuckle}
        out[f"rod.{side}"] = Pose(top, origin, knuckle.rotation * twist)
    return out


def _bushing(
    state: State, axle: Axle, name: str, side: str, at: np.ndarray, axes: np.ndarray, inner: str, outer: str
) -> None:
    values = axle.values
    a, o = (GROUND if inner == "body" else state.poses[inner]), state.poses[outer]
    d = axes.T @ a.rotation.inv().apply(o.point(at) - a.point(at))
    phi = axes.T @ (a.rotation.inv() * o.rotation).as_rotvec()

    def by_axis(kind: str, letters: str) -> np.ndarray:
        return np.array([values.get(f"{name}.{kind}{c}@{side}", 0.0) for c in letters.split()])

    k = by_axis("", "Fx Fy Fz") * by_axis("stiffness.", "Fx Fy Fz")
    kr = by_axis("", "Tx Ty Tz") * by_axis("stiffness.", "Tx Ty Tz") * NM_PER_DEG
    b = by_axis("cubic.", "Fx Fy Fz")
    state.energy += float(np.sum(k * (d**2 / 2 + b * d**4 / 4)) + np.sum(kr * phi**2) / 2)
    if inner == "body":
        state.reactions.append((-axes @ (k * (d + b * d**3)), o.point(at)))
        # m.dtheta = (K phi).dphi, dtheta in chassis axes: m = J^-T K phi, J the left Jacobian
        state.couples.append(-_left_jacobian_inverse(axes @ phi).T @ axes @ (kr * phi))


def _left_jacobian_inverse(phi: np.ndarray) -> np.ndarray:
    """dphi/dtheta of a rotation vector, dtheta in the fixed axes (Bortz)."""
    angle = float(np.linalg.norm(phi))
    cross = np.array([[0, -phi[2], phi[1]], [phi[2], 0, -phi[0]], [-phi[1], phi[0], 0]])
    if angle < 1e-4:
        return np.eye(3) - cross / 2 + cross @ cross / 12
    factor = (1 - angle / 2 / np.tan(angle / 2)) / angle**2
    return np.eye(3) - cross / 2 + factor * cross @ cross


def _stop_energy(axle: Axle, name: str, side: str, points: int, travel: float) -> float:
    contact = travel - axle.values[f"{name}.clearance@{side}"]
    if contact <= 0:
        return 0.0
    x, y = (np.array([axle.values[f"{name}.table.{c}{i}"] for i in range(points)]) for c in "xy")
    assert contact <= x[-1]
    return axle.values[f"{name}.factor@{side}"] * float(PchipInterpolator(x, y).integrate(0.0, contact))


def evaluate(axle: Axle, kernel: Kernel, x: np.ndarray, u: np.ndarray) -> State:
    """The axle without effects at state x under the controls u."""
    state = State(poses(axle, kernel, x))
    value = {n.name: float(v) for n, v in zip(kernel.layout.unknowns, x, strict=True)}
    control = dict(zip(kernel.layout.control_names, u, strict=True))
    values = axle.values
    heights = []
    for side in SIDES:
        flip = np.eye(3) if side == "L" else MIRROR
        for name in ("SFF", "SFR"):
            at = position(axle, name, side)
            _bushing(state, axle, name.lower(), side, at, flip, "body", "subframe")
        for name in ("LLF", "LLR"):
            at = position(axle, name, side)
            _bushing(state, axle, name.lower(), side, at, flip @ ARM_AXES, "subframe", f"arm.{side}")
        _bushing(state, axle, "upb", side, position(axle, "UPB", side), flip, "body", f"rod.{side}")
        knuckle = state.poses[f"knuckle.{side}"]
        upper, lower = position(axle, "UPS", side), position(axle, "LWS", side)
        seat = knuckle.point(lower)
        length = float(np.linalg.norm(upper - seat))
        longer = length - float(np.linalg.norm(upper - lower))
        rate = values[f"spring.rate@{side}"]
        force = value["preload"] - rate * longer
        state.energy += rate * longer**2 / 2 - value["preload"] * longer
        state.reactions.append((force * (seat - upper) / length, upper))
        slide = value[f"strut slide {side}"]
        state.energy += _stop_energy(axle, "bump_stop", side, 7, -slide)
        state.energy += _stop_energy(axle, "rebound_stop", side, 5, slide)
        heights.append(knuckle.point(position(axle, "ARB", side)))
    rate = values["arb.rate"] * (values["arb.radius"] / values["arb.nominal_radius"]) ** 4
    difference = float(heights[0][2] - heights[1][2])
    state.energy += rate * difference**2 / 2
    # the bar's mounts: the reference gives the pair of forces alone
    pair = np.array([0.0, 0.0, rate * difference])
    state.reactions += [(-pair, heights[0]), (pair, heights[1])]
    column = values["scb.Tz"] * values["steering.column"]
    state.energy += column * (value["rack"] - control["rack"]) ** 2 / 2
    return state


def tyre_energy(axle: Axle, y: Mapping[str, float]) -> float:
    """1/2 k (R - t)^2 of both tyres, from load and camber to the pad: R - t = N cos(camber) / k."""
    total = 0.0
    for side in SIDES:
        squash = y[f"tyre_load@{side}"] * np.cos(np.radians(y[f"camber_ground@{side}"]))
        total += squash**2 / axle.values[f"tyre.rate@{side}"] / 2
    return float(total)
