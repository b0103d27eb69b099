"""The static state: one spring preload that puts the mean wheel centre at its design height under load."""

from __future__ import annotations

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.solver.compiled import CompiledKernel
from doe_kc.solver.kernel import Kernel
from doe_kc.solver.load_cases import Datum
from doe_kc.solver.march import Path, Settings, Start, march
from doe_kc.solver.result import StaticState
from doe_kc.typing import FloatArray


def control_matrix(kernel: Kernel, values: dict[str, float | FloatArray], n: int) -> FloatArray:
    """(n, nu) controls by column; those not named are zero."""
    u = np.zeros((n, kernel.nu))
    for name, value in values.items():
        if name in kernel.equations.control_names:
            u[:, kernel.equations.control_names.index(name)] = value
    return u


def static_state(
    kernel: Kernel, compiled: CompiledKernel | None, c: FloatArray, axle: Axle, settings: Settings
) -> StaticState | Path:
    """The state at rest, or the path that did not converge.

    Preload and pad heights are solved without the ride-height offset; then the pads are raised by it.
    Bushings are stress-free at the hardpoints, so static toe and camber differ slightly from nominal.
    """
    guess = np.zeros(kernel.nx)
    tail = [kernel.index(name) for name in ("pad L", "pad R", "preload")]
    guess[tail[2]] = axle.values["tyre.static_load"]
    u0 = control_matrix(kernel, {"hold_load": 1.0, "hold_height": 1.0, "bilateral": 1.0}, 1)
    start = Start(np.zeros(1), guess[None, :], u0[0], np.zeros(kernel.nz))
    found = march(kernel, compiled, c, start, np.ones(1), u0, full=True, settings=settings)
    if found.failed is not None:
        return found
    x0 = found.x[0]
    pad_left, pad_right, preload = x0[tail]
    offset = axle.values["ride_height"]
    pads = (pad_left + offset, pad_right + offset)
    u = control_matrix(kernel, {"pad_L": pads[0], "pad_R": pads[1], "preload": preload}, 1)
    frozen = control_matrix(kernel, {"pad_L": pad_left, "pad_R": pad_right, "preload": preload}, 1)
    start = Start(np.zeros(1), x0[None, :], frozen[0], found.z[0])
    raised = march(kernel, compiled, c, start, np.ones(1), u, settings=settings)
    if raised.failed is not None:
        return raised
    names = kernel.equations.output_names
    read = {n: raised.y[0][names.index(n)] for n in names}
    datum = Datum(
        pad=pads,
        wheel_centre_z=(read["wc_z@L"], read["wc_z@R"]),
        preload=preload,
        half_track=axle.half_track,
        rack_mm_per_rev=axle.rack_mm_per_rev,
    )
    return StaticState(x0, u0[0], raised.x[0], u[0], raised.z[0], raised.y[0], datum)
