"""From a topology to the equations of the axle."""

from __future__ import annotations

from functools import lru_cache

from doe_kc.axle.topology import EQUATIONS_CACHE, Topology
from doe_kc.curves import SIDES
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements.tyre import add_tyres
from doe_kc.solver.elements.wheel import add_wheel
from doe_kc.solver.equations import Equations, finish
from doe_kc.solver.structure.bodies import add_bodies
from doe_kc.solver.structure.connections import add_bushings, add_playing_balls, add_rods, close_loops
from doe_kc.solver.structure.forces import add_bar, add_damper, add_rack_friction, add_springs
from doe_kc.solver.structure.responses import add_responses
from doe_kc.solver.structure.tree import joint_tree
from doe_kc.solver.structure.words import in_words


@lru_cache(maxsize=EQUATIONS_CACHE)
def assemble(topology: Topology) -> Equations:
    """The equations of a topology, closed by virtual work (cached: a pure function)."""
    return finish(collected(topology))


def collected(topology: Topology) -> Builder:
    """Bodies, forces and outputs of every element of the topology's type, in order."""
    builder = Builder(topology)
    assemble_structure(builder)
    return builder


def assemble_structure(b: Builder) -> None:
    """Everything that the type has, in an order in which each part finds what it stands on."""
    structure, tree = b.topology.structure, joint_tree(b.topology)
    add_bodies(b, tree)
    for side in SIDES:
        carrier = b.bodies[structure.part_on_side(structure.carrier, side)]
        b.bodies[f"carrier.{side}"] = carrier
        add_wheel(b, carrier, side, in_words(structure.carrier))
    add_bushings(b, structure)
    add_rods(b, structure)
    add_playing_balls(b, structure)
    close_loops(b, tree.loops)
    add_springs(b, structure)
    add_damper(b, structure)
    add_rack_friction(b)
    add_bar(b, structure)
    add_tyres(b)
    add_responses(b, structure)
