"""The static state: one spring preload that puts the mean wheel centre at its design height under load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import Datum
from doe_kc.solver.compiled import MarchLibrary
from doe_kc.solver.diagnosis import static_failure, sweep_failure
from doe_kc.solver.equilibria import Start
from doe_kc.solver.kernel import Kernel
from doe_kc.solver.march import distance, march
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.result import Failure, StaticState


def control_matrix(
    kernel: Kernel, values: Mapping[str, float | FloatArray], n: int, designs: tuple[int, ...] = ()
) -> FloatArray:
    """(n, nu) controls by column, or (d, n, nu) of `designs`, (d,); those not named are zero.

    values: one, (n,), or of designs (d, 1) or (d, n).
    """
    u = np.zeros((*designs, n, kernel.nu))
    for name, value in values.items():
        if name in kernel.layout.control_names:
            u[..., kernel.layout.control_names.index(name)] = value
    return u


FAR = 25.0
"""mm, and 1/100 Gibbs unit (29 deg): a static state so far from design is approached by a ramp."""
FINEST_RAMP = 1.0 / 256.0
LOADS = ("tyre.static_load", "damper.gas_force")
"""Values that a ramp raises from zero, besides the bushings' preloads."""


def static_state(
    kernel: Kernel, compiled: MarchLibrary | None, c: FloatArray, axle: Axle, settings: NewtonSettings
) -> StaticState | Failure:
    """The state at rest, or why there is none.

    Preload and pad heights are solved without the ride-height offset; then the pads are raised by it.
    Bushings are stress-free at the hardpoints, so static toe and camber differ slightly from nominal.
    """
    tail = [kernel.index(name) for name in ("pad L", "pad R", "preload")]
    u0 = control_matrix(kernel, {"hold_load": 1.0, "hold_height": 1.0, "bilateral": 1.0}, 1)
    x0 = _at_design_height(kernel, compiled, c, axle, u0, settings)
    if isinstance(x0, Failure):
        return x0
    pad_left, pad_right, preload = x0[tail]
    offset = axle.values["ride_height"]
    pads = (pad_left + offset, pad_right + offset)
    u = control_matrix(kernel, {"pad_L": pads[0], "pad_R": pads[1], "preload": preload}, 1)
    frozen = control_matrix(kernel, {"pad_L": pad_left, "pad_R": pad_right, "preload": preload}, 1)
    start = Start(np.zeros(1), x0[None, :], frozen[0], np.zeros(kernel.nz))
    s = np.array([offset or 1.0])
    raised = march(kernel, compiled, c, start, s, u, settings=settings)
    if raised.failed is not None:
        names = ("static equilibrium", "ride height", "mm")
        return sweep_failure(kernel, c, start, raised, s, u, names, full=False)
    read = dict(zip(kernel.layout.output_names, raised.y[0], strict=True))
    datum = Datum(
        pad=pads,
        wheel_centre_z=(read["wc_z@L"], read["wc_z@R"]),
        preload=preload,
        half_track=axle.half_track,
        rack_mm_per_rev=axle.rack_mm_per_rev,
    )
    return StaticState(x0, u0[0], raised.x[0], u[0], raised.z[0], raised.y[0], datum)


def _at_design_height(
    kernel: Kernel,
    compiled: MarchLibrary | None,
    c: FloatArray,
    axle: Axle,
    u: FloatArray,
    settings: NewtonSettings,
) -> FloatArray | Failure:
    """(nx,) the state at the design height: Newton's from design, or, where that fails or leads far off, the
    end of a ramp of the load."""
    guess = np.zeros(kernel.nx)
    guess[kernel.index("preload")] = axle.values["tyre.static_load"]
    start = Start(np.zeros(1), guess[None, :], u[0], np.zeros(kernel.nz), guess=True)
    direct = march(kernel, compiled, c, start, np.ones(1), u, full=True, settings=settings)
    if direct.failed is None and distance(kernel, direct.x[0], guess) <= FAR:
        return np.asarray(direct.x[0])
    return _ramped(kernel, compiled, axle, u, settings)


def _ramped(
    kernel: Kernel, compiled: MarchLibrary | None, axle: Axle, u: FloatArray, settings: NewtonSettings
) -> FloatArray | Failure:
    """(nx,) the state reached from the unloaded axle, whose bushings are stress-free at design."""
    x, share, part = np.zeros(kernel.nx), 0.0, 0.25
    once, c = replace(settings, max_halvings=0), kernel.constant_values(_loaded(axle, 0.0))
    while share < 1.0:
        to = min(1.0, share + part)
        c_to = kernel.constant_values(_loaded(axle, to))
        start = Start(np.array([share]), x[None, :], u[0], np.zeros(kernel.nz))
        path = march(kernel, compiled, c_to, start, np.array([to]), u, full=True, settings=once)
        if path.failed is None:
            x, share, part, c = path.x[0], to, 2.0 * part, c_to
        elif part <= FINEST_RAMP:
            return static_failure(kernel, c, x, u[0], share)
        else:
            part /= 2.0
    return np.asarray(x)


def _loaded(axle: Axle, share: float) -> dict[str, float]:
    """Values of the axle under a share of its loads, 0 to 1."""
    return {
        name: share * value if name.split("@")[0] in LOADS or ".preload." in name else value
        for name, value in axle.values.items()
    }
