"""Exact tangents dy/du of an equilibrium, and paths through any sequence of controls."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import casadi as ca
import numpy as np

from doe_kc.axle import Axle
from doe_kc.solver.assembly import assemble
from doe_kc.solver.builder import LOAD_CASE
from doe_kc.solver.equilibria import March, Start
from doe_kc.solver.kernel import Kernel, kernel
from doe_kc.solver.march import march
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.result import StaticState
from doe_kc.solver.static import control_matrix, static_state

PADS = ("pad L", "pad R", "preload")


class Rig:
    """An axle at rest, on which any controls may be applied."""

    def __init__(self, axle: Axle) -> None:
        self.axle = axle
        self.kernel: Kernel = kernel(axle.topology)
        self.c = self.kernel.constant_values(dict(axle.values))
        found = static_state(self.kernel, None, self.c, axle, NewtonSettings())
        assert isinstance(found, StaticState)
        self.static = found

    def controls(self, n: int, values: Mapping[str, object]) -> np.ndarray:
        pads = self.static.datum
        held = {"pad_L": pads.pad[0], "pad_R": pads.pad[1], "preload": pads.preload}
        return control_matrix(self.kernel, {**held, **values}, n)  # type: ignore[dict-item]

    def path(self, waypoints: Sequence[Mapping[str, float]], steps: int, *, load_case: bool = False) -> March:
        """Straight lines between waypoints, which hold changes from rest (pads) or values; from rest.

        load_case: whether friction has force and memory, as in a load case.
        """
        names = sorted({n for w in waypoints for n in w})
        pads = {"pad_L": self.static.datum.pad[0], "pad_R": self.static.datum.pad[1]}
        corners = np.array([[w.get(n, 0.0) + pads.get(n, 0.0) for n in names] for w in ({}, *waypoints)])
        t = np.linspace(0.0, len(waypoints), steps * len(waypoints) + 1)[1:]
        columns = {n: np.interp(t, range(len(corners)), corners[:, i]) for i, n in enumerate(names)}
        self.u = self.controls(len(t), {**columns, LOAD_CASE: float(load_case)})
        start = Start(
            np.zeros(1),
            self.static.x[None, :],
            self.controls(1, {LOAD_CASE: float(load_case)})[0],
            self.static.z,
        )
        found = march(self.kernel, None, self.c, start, t, self.u)
        assert found.failed is None
        return found

    def output(self, path: March, name: str) -> np.ndarray:
        """Output along the path, the static state first."""
        column = self.kernel.layout.output_names.index(name)
        return np.concatenate([[self.static.y[column]], path.y[:, column]])

    def input(self, name: str) -> np.ndarray:
        """Control along the last path, the static state first."""
        column = self.kernel.layout.control_names.index(name)
        return np.concatenate([[self.controls(1, {})[0][column]], self.u[:, column]])

    def tangent(
        self, x: np.ndarray, u: np.ndarray, outputs: Sequence[str], inputs: Sequence[str]
    ) -> np.ndarray:
        """dy/du by the implicit function theorem at an equilibrium with prescribed pads."""
        eq = assemble(self.kernel.topology)
        symbols = [eq.x, eq.c, eq.u, eq.z]
        wanted = [eq.output_names.index(n) for n in outputs]
        blocks = [ca.jacobian(e, s) for e in (eq.residual, eq.outputs[wanted]) for s in (eq.x, eq.u)]
        at = (x, self.c, u, self.static.z)
        rx, ru, yx, yu = (np.array(m) for m in ca.Function("t", symbols, blocks)(*at))
        columns = [eq.control_names.index(n) for n in inputs]
        return yu[:, columns] - yx @ np.linalg.solve(rx, ru[:, columns])
