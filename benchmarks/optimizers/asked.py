"""What a peer is asked: a fingerprint of the problem by its answers. A run is valid as long as they are."""

from __future__ import annotations

import hashlib

import numpy as np

from doe_kc.correlation.methods.ego.method import OPENING
from doe_kc.correlation.problem import Candidate, Problem
from tests.correlation import cases

PROBES = 5
"""Random designs whose answers are looked at."""
WIDTH = 0.2
DIGITS = 7
"""Significant ones of a rating: a last bit is no other problem."""


def asked(problem: Problem) -> str:
    """Of variables, bounds, levels, the opening sample that peers are given, ratings of random designs."""
    space = problem.space
    found = hashlib.sha256()
    for v in space.variables:
        found.update(f"{v.path} {v.lower:.9g} {v.upper:.9g} {v.start:.9g} {v.levels}".encode())
    sample = [c.point for c in OPENING.sample(space, OPENING.size(space), 1)]
    found.update(np.round(sample, 9).tobytes())
    rng = np.random.default_rng(5)
    spread = WIDTH * rng.uniform(-1.0, 1.0, (PROBES, space.dimension))
    points = space.snapped(space.start + spread)
    solve = cases.solver(problem.axle)
    for place, (point, outcome) in enumerate(
        zip(points, solve([space.values(p) for p in points]), strict=True)
    ):
        answer = problem.judged(place, Candidate(point, "probe"), outcome)
        found.update(f"{answer.merit:.{DIGITS}g}".encode())
    return found.hexdigest()[:12]
