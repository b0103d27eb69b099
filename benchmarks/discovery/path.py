"""The path that the rig drives: a run-in, one whole loop, and the loop that is recorded.

Solved at the inputs of the samples themselves, which no analyser's grid shares, so that friction is in its
steady cycle and nothing is interpolated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.axle import Axle
from doe_kc.curves import RIG_RESPONSES, SIDES
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.solver.builder import LOAD_CASE
from doe_kc.solver.diagnosis import sweep_failure
from doe_kc.solver.equilibria import Start
from doe_kc.solver.kernel import Kernel, kernel
from doe_kc.solver.march import march
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.result import Failure, NotConverged, StaticState
from doe_kc.solver.static import control_matrix, static_state
from doe_kc.solver.suite import library_for

SAMPLES = 512
RUN_IN = 24
"""Steps of each branch before the recorded loop."""


def triangle(amplitude: float, warp: float) -> FloatArray:
    """(SAMPLES + 1,) inputs +A -> -A -> +A of one period, the last closing it.

    warp: -0.9 to 0.9, how much slower than on average the rig moves near its turning points.
    """
    share = np.arange(SAMPLES // 2 + 1) / (SAMPLES // 2)
    falling = amplitude * (1.0 - 2.0 * (share - warp * np.sin(2.0 * np.pi * share) / (2.0 * np.pi)))
    return np.concatenate([falling, falling[-2::-1]])


@dataclass
class Bench:
    """One axle on the rig, at rest: `loop` drives a load case. NotConverged when there is no equilibrium."""

    axle: Axle

    def __post_init__(self) -> None:
        self._kernel: Kernel = kernel(self.axle.topology)
        self._library = library_for(self.axle.topology, None)
        self._constants = self._kernel.constant_values(dict(self.axle.values))
        found = static_state(self._kernel, self._library, self._constants, self.axle, NewtonSettings())
        if isinstance(found, Failure):
            raise NotConverged(found)
        self._static: StaticState = found
        names = self._kernel.layout.output_names
        self._columns = {r: [names.index(f"{r}@{side}") for side in SIDES] for r in RIG_RESPONSES}

    @property
    def static(self) -> dict[str, FloatArray]:
        """Response -> (2,) at rest, deg, mm, N."""
        return {r: self._static.y[columns] for r, columns in self._columns.items()}

    def loop(self, case: LoadCase, inputs: FloatArray) -> dict[str, FloatArray]:
        """Response -> (2, n - 1) on one period of inputs (n,) that begins and ends at its largest value."""
        top, turn = float(inputs[0]), int(np.argmin(inputs))
        bottom = float(inputs[turn])
        branches = [
            np.linspace(0.0, top, RUN_IN + 1),
            np.linspace(top, bottom, 2 * RUN_IN + 1),
            np.linspace(bottom, top, 2 * RUN_IN + 1),
            inputs[: turn + 1],
            inputs[turn:],
        ]
        x, z = self._static.x, self._static.z
        kept = []
        for branch in branches:
            values = {"preload": self._static.datum.preload, **case.controls(branch, self._static.datum)}
            u = control_matrix(self._kernel, {**values, LOAD_CASE: 1.0}, branch.size)
            start = Start(branch[:1], x[None, :], u[0], z)
            full = "hold_wheel_centre" in values
            path = march(self._kernel, self._library, self._constants, start, branch[1:], u[1:], full=full)
            if path.failed is not None:
                names = (case.id, "loop", case.unit)
                raise NotConverged(
                    sweep_failure(
                        self._kernel, self._constants, start, path, branch[1:], u[1:], names, full=full
                    )
                )
            x, z = path.x[-1], path.z[-1]
            kept.append(path.y)
        y = np.vstack([kept[2][-1:], kept[3], kept[4][:-1]])
        return {r: y[:, columns].T for r, columns in self._columns.items()}
