"""Designs of experiments over the variables of an axle: one module a method, registered by its id."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from doe_kc.ground.errors import InputError
from doe_kc.ground.registry import import_members
from doe_kc.ground.typing import FloatArray
from doe_kc.sampling._base import SAMPLERS, Request, Sampler, find_sampler
from doe_kc.sampling.constraints import LinearConstraint, constrained
from doe_kc.sampling.design import Design
from doe_kc.variables import Space

import_members(sys.modules[__name__])

__all__ = ["SAMPLERS", "Design", "LinearConstraint", "Request", "Sampler", "find_sampler", "sample"]


def sample(
    space: Space,
    n: int,
    *,
    seed: int,
    method: str = "lhs",
    levels: int = 3,
    table: Path | None = None,
    existing: FloatArray | None = None,
    constraints: Sequence[LinearConstraint] = (),
) -> Design:
    """n designs by a registered method; the seed is kept in the design of a method that has chance in it.

    levels: of each variable, for `full_factorial`. table: file of designs, for `table`. existing: (k, d)
    designs in the unit cube that the n new ones complete. constraints: that all of them hold.
    InputError for an unknown method, a space or constraints that do not suit it, or a method that cannot
    complete designs.
    """
    sampler = find_sampler(method, "sampling")
    if existing is not None and not sampler.extends:
        able = ", ".join(name for name, s in SAMPLERS.items() if s.extends)
        raise InputError(f"sampling: {method} cannot complete existing designs; use {able}.")
    request = Request(n=n, seed=seed, levels=levels, table=table, existing=existing)
    if constraints:
        return constrained(sampler, space, request, constraints)
    return sampler.sample(space, request)
