"""Derivatives of one equilibrium to the probes: what the equations with probes add to those without."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca
import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.assembly import assemble
from doe_kc.solver.blocks import Block, blocks, equilibrium_change
from doe_kc.solver.kernel import Buffered, kernel
from doe_kc.solver.probe import Probe


@dataclass(frozen=True)
class _ProbeFunctions:
    """of: R_e, Y_e (and Z_e), seen of (x, c, u, z); constants: c of p, by parameter_names."""

    probes: tuple[Probe, ...]
    parameter_names: tuple[str, ...]
    constants: ca.Function
    of: dict[str, ca.Function]


@lru_cache(maxsize=TOPOLOGY_CACHE)
def _functions(topology: Topology) -> _ProbeFunctions:
    """Of a topology without probes: theirs are zero, so that both have the same equilibria."""
    plain, eq = kernel(topology).layout, assemble(replace(topology, probes=True))
    for name in ("unknowns", "control_names", "output_names"):
        assert getattr(plain, name) == getattr(eq, name), f"probes change the {name}"
    assert plain.states == eq.z.numel()
    symbols = [eq.x, eq.c, eq.u, eq.z]
    parts = {"R_e": eq.residual, "Y_e": eq.outputs} | ({"Z_e": eq.next_state} if eq.z.numel() else {})
    expressions = {name: ca.jacobian(e, eq.e) for name, e in parts.items()} | {"seen": ca.densify(eq.seen)}
    none = ca.SX.zeros(*eq.e.shape)
    return _ProbeFunctions(
        eq.probes,
        eq.parameter_names,
        ca.Function("probe_constants", [eq.p], [ca.densify(eq.constants)]),
        {n: ca.Function(n, symbols, [ca.substitute(e, eq.e, none)]) for n, e in expressions.items()},
    )


@dataclass(frozen=True)
class Local:
    """Derivatives at one equilibrium; columns: m probes, then the 5 of the datum, then nz earlier states.

    seen: (m,) what the probes show. dx: (nx, .), dy: (ny, .), dz: (nz, .).
    """

    seen: FloatArray
    dx: FloatArray
    dy: FloatArray
    dz: FloatArray


class InterfaceBlocks:
    """Derivatives of an axle's equilibria. probes: m of them."""

    def __init__(self, axle: Axle) -> None:
        self.kernel = kernel(axle.topology)
        functions = _functions(axle.topology)
        self.probes = functions.probes
        self._c = self.kernel.constant_values(dict(axle.values))
        p = np.array([axle.values[name] for name in functions.parameter_names])
        self._c_probes = np.asarray(functions.constants(p)).ravel()
        plain = {n: f for n, f in blocks(axle.topology).items() if n[1:] in ("_x", "_u", "_z")}
        self._plain = {name: Block(f) for name, f in plain.items()}
        self._probed = {name: Block(f) for name, f in functions.of.items() if name != "seen"}
        self._seen = Buffered(functions.of["seen"])

    def at(self, x: FloatArray, u: FloatArray, z: FloatArray, du: FloatArray) -> Local:
        """At x (nx,) under the controls u, with earlier states z; du: (nu, 5) of the datum."""
        plain, probed = (x, self._c, u, z), (x, self._c_probes, u, z)

        def explicit(part: str) -> FloatArray:
            own = [self._probed[f"{part}_e"](*probed), self._plain[f"{part}_u"](*plain) @ du]
            if self.kernel.nz:
                own.append(self._plain[f"{part}_z"](*plain))
            return np.hstack(own)

        dx = equilibrium_change(self.kernel, self._plain["R_x"](*plain), explicit("R"))
        dy = explicit("Y") + self._plain["Y_x"](*plain) @ dx
        dz = explicit("Z") + self._plain["Z_x"](*plain) @ dx if self.kernel.nz else np.zeros((0, dx.shape[1]))
        return Local(self._seen(*probed).copy(), dx, dy, dz)
