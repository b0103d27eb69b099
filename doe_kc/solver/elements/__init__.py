"""The units that an axle is assembled from, one textbook element a module.

An element registers itself with `@element`; `ELEMENTS` is the registry in the order of assembly:
bodies first, then forces, then outputs.
"""

from __future__ import annotations

import sys

from doe_kc.ground.registry import import_members
from doe_kc.solver.elements._base import ELEMENTS, Element, element

import_members(sys.modules[__name__])

__all__ = ["ELEMENTS", "Element", "element"]
