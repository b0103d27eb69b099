"""Simulation: the K&C load cases of an axle, solved."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.api.axle import as_axle
from doe_kc.api.frame_result import FrameResult
from doe_kc.axle import Axle, axle_warnings
from doe_kc.axle.kinematics import as_mechanism
from doe_kc.axle.model import with_roll
from doe_kc.curves import CurveSet
from doe_kc.reports.simulation.tables import characteristics_frame, curves_frame, write_simulation
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.newton import RIGID_SETTINGS
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

log = logging.getLogger("doe_kc")


@dataclass(frozen=True, repr=False, eq=False)
class SimulationResult(FrameResult):
    """The load cases of one axle. axle: that was solved. solution: all equilibria. seconds: of solving."""

    axle: Axle
    solution: Solution
    seconds: float

    @cached_property
    def characteristics(self) -> pd.DataFrame:
        """One row a characteristic, its id as index: load_case, response, unit, value (left wheel)."""
        return characteristics_frame(self.solution).set_index("name")

    @cached_property
    def curves(self) -> pd.DataFrame:
        """One row a load case, branch, step and side ("L", "R"); units in the names of the columns.

        Angles in deg, absolute; wheel centre in mm, change from static; tyre load in N.
        """
        return curves_frame(self.solution)

    @cached_property
    def curve_set(self) -> CurveSet:
        """Mean and half-width curves of every load case as arrays."""
        return curve_set(self.solution)

    def to_frame(self) -> pd.DataFrame:
        """`characteristics`."""
        return self.characteristics

    @property
    def lines(self) -> list[str]:
        """Axle, load cases, number of equilibria."""
        cases = ", ".join(self.solution.cases)
        return [
            f"{self.axle.name}, {self.solution.equilibria} equilibria in {self.seconds:.3f} s",
            f"load cases: {cases}",
            f"{len(self.characteristics)} characteristics",
        ]

    def plot(self, load_case: str = "vertical", response: str = "toe", ax: Axes | None = None) -> Axes:
        """Curves of both wheels of one response over the load case's input; InputError for unknown names.

        response: toe, camber, caster, spin (deg), wc_x, wc_y, wc_z (mm), changes from static; tyre_load (N).
        """
        from doe_kc.api.axes import axes_or_new, check_curve, draw_curves

        check_curve(self.curve_set, load_case, response)
        ax = axes_or_new(ax, (6.4, 4.4))
        draw_curves(ax, self.curve_set, load_case, response)
        return ax

    def write(self, out: str | PathLike[str]) -> list[Path]:
        """curves.csv and characteristics.csv in `out`, as `doe-kc simulate --out`; returns the paths."""
        return write_simulation(self.solution, Path(out))


def simulate(
    axle: Axle | str | PathLike[str],
    load_cases: Sequence[str] | None = None,
    *,
    roll: str | None = None,
    kinematic: bool = False,
) -> SimulationResult:
    """Solve the K&C load cases of an axle.

    load_cases: ids, all eight by default: vertical, roll, lateral, lateral_opposite, lateral_offset, drive,
    brake, steer. roll: technique of the roll, "body" or "counter_phase", by default the axle's.
    kinematic: joints in place of all bushings, and a rigid column, so that curves can be compared with
    programs of pure kinematics. An axle that is unlikely for a car is solved too, with a warning in the log
    `doe_kc`.

    Raises InputError for an unknown load case or technique, and for kinematics of an axle whose links bind or
    that has elastic effects; RunError where the axle has no equilibrium.

    >>> result = kc.simulate("examples/front_axle/axle.toml", ["vertical", "roll"])
    >>> round(result.characteristics.loc["vertical.bump_steer", "value"].item(), 2)  # deg/m
    -3.92
    >>> sorted(result.curves["load_case"].unique())
    ['roll', 'vertical']
    """
    model = with_roll(as_axle(axle), roll)
    for sentence in axle_warnings(model):
        log.warning(sentence)
    if kinematic:
        model = as_mechanism(model)
    started = time.perf_counter()
    cases = None if load_cases is None else list(load_cases)
    solution = solve(model, cases, settings=RIGID_SETTINGS if kinematic else None)
    return SimulationResult(model, solution, time.perf_counter() - started)
