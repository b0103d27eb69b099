"""From a topology to the equations of the axle."""

from __future__ import annotations

from functools import lru_cache

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.solver.builder import Builder
from doe_kc.solver.equations import Equations, finish
from doe_kc.solver.structure.assembly import assemble_structure


@lru_cache(maxsize=TOPOLOGY_CACHE)
def assemble(topology: Topology) -> Equations:
    """The equations of a topology, closed by virtual work (cached: a pure function)."""
    return finish(collected(topology))


def collected(topology: Topology) -> Builder:
    """Bodies, forces and outputs of every element of the topology's type, in order."""
    builder = Builder(topology)
    assemble_structure(builder)
    return builder
