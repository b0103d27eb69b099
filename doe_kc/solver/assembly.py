"""From a topology to the equations of the axle."""

from __future__ import annotations

from functools import lru_cache

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements import ELEMENTS
from doe_kc.solver.equations import Equations, finish


@lru_cache(maxsize=TOPOLOGY_CACHE)
def assemble(topology: Topology) -> Equations:
    """Every registered element, in order, then virtual work (cached per topology: a pure function)."""
    builder = Builder(topology)
    for unit in ELEMENTS:
        unit.assemble(builder)
    return finish(builder)
