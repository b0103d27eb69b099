"""The places of the axle that an axle file describes when it names no type."""

from __future__ import annotations

from doe_kc.axle.places import structure_places
from doe_kc.axle_types import DEFAULT_TYPE, built_in

DEFAULT_PLACES = structure_places(built_in(DEFAULT_TYPE).structure)
"""Of DEFAULT_TYPE: where effects are looked for when no axle says otherwise."""
