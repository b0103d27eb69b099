"""The solver that a study asks for."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from doe_kc.axle.model import Axle
from doe_kc.true_solver.options import SolverOptions
from doe_kc.true_solver.own import AxleSolver
from doe_kc.true_solver.protocol import TrueSolver


def solver_for(
    axle: Axle, options: SolverOptions, windows: Mapping[str, float] | None = None, folder: Path = Path()
) -> TrueSolver:
    """The package's own solver, or the outside command of the options.

    windows: as in `reduce_all`. folder: where the command runs, the study's.
    """
    if not options.command:
        return AxleSolver(axle, dict(windows or {}))
    from doe_kc.true_solver.command import CommandSolver  # its answers are read by pandas

    return CommandSolver(
        command=tuple(options.command),
        axle=axle,
        windows=dict(windows or {}),
        timeout=options.timeout,
        folder=folder,
        load_cases=tuple(options.load_cases),
    )
