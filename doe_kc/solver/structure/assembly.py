"""From a structure to bodies, forces and outputs."""

from __future__ import annotations

from doe_kc.axle.structure import Structure
from doe_kc.curves import SIDES
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements.tyre import Tyre
from doe_kc.solver.elements.wheel import Wheel
from doe_kc.solver.structure.bodies import add_bodies
from doe_kc.solver.structure.connections import add_bushings, add_rods, add_yielding_balls, close_loops
from doe_kc.solver.structure.forces import add_bar, add_damper, add_rack_friction, add_springs
from doe_kc.solver.structure.responses import add_responses
from doe_kc.solver.structure.tree import instance, joint_tree


def assemble_structure(b: Builder, structure: Structure) -> None:
    """Everything that the type has, in an order in which each part finds what it stands on."""
    topology = b.topology
    subframe = structure.subframe
    split = subframe.body if subframe is not None and topology.flexible_subframe else ""
    tree = joint_tree(structure, (*topology.elastic_balls, *topology.play_balls), split)
    add_bodies(b, structure, tree, split)
    for side in SIDES:
        b.bodies[f"carrier.{side}"] = b.bodies[instance(structure, structure.carrier, side, split)]
    Wheel().assemble(b)
    add_bushings(b, structure, split)
    add_rods(b, structure, split)
    add_yielding_balls(b, structure, split)
    close_loops(b, tree.loops)
    add_springs(b, structure, split)
    add_damper(b, structure, split)
    add_rack_friction(b)
    add_bar(b, structure, split)
    Tyre().assemble(b)
    add_responses(b, structure, split)
