"""A correlation problem without a solver: outputs are a known, nearly linear map of the variables.

Real targets, rating and space, so that methods meet what they meet in practice; one evaluation takes
microseconds. The answer is known: the targets are the map's values at `truth`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from doe_kc.axle.design_parameters import design_parameters
from doe_kc.axle_file import read_axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.curve_data import CurveData
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.loop import Evaluate
from doe_kc.correlation.problem import Problem
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import CurveGradients
from doe_kc.targets import CharacteristicOptions, CurveTarget, Objective, build_targets
from doe_kc.true_solver.outcome import Outcome, failure
from doe_kc.variables import Change, VariableOptions, build_space

AXLE = Path(__file__).parents[2] / "examples" / "front_axle" / "axle.toml"
INPUT = np.linspace(-50.0, 50.0, 11)
LINES = ("toe", "camber")
CASE = "vertical"
COUNT = len(CHARACTERISTICS)

Fails = Callable[[FloatArray], bool]


@dataclass(frozen=True)
class Map:
    """y = value + slope z + bend z^2, z = u - centre; value (m,), slope, bend (m, d).

    First the characteristics, then the curves (response, side, point). jump: share of its value by which
    every output is larger where the first variable is below `edge`: a discontinuity.
    """

    centre: FloatArray
    value: FloatArray
    slope: FloatArray
    bend: FloatArray
    jump: float = 0.0
    edge: float = 0.0

    def __call__(self, u: FloatArray) -> FloatArray:
        z = u - self.centre
        stepped = self.jump * np.abs(self.value) if u[0] < self.edge else 0.0
        return np.asarray(self.value + self.slope @ z + self.bend @ z**2 + stepped)

    def gradient(self, u: FloatArray) -> FloatArray:
        """(m, d)."""
        return np.asarray(self.slope + 2.0 * self.bend * (u - self.centre))


@dataclass(frozen=True, kw_only=True)
class Synthetic(Problem):
    """The problem with its map and the answer (d,)."""

    map: Map
    truth: FloatArray

    def linearize(self, point: FloatArray) -> Linearization:
        found = self.map.gradient(point)
        lines = found[COUNT:].reshape(len(LINES), 2, INPUT.size, -1)
        gradients = CurveGradients(
            self.space.paths, {CASE: INPUT}, {CASE: dict(zip(LINES, lines, strict=True))}, {}
        )
        return Linearization(found[:COUNT], gradients)


def synthetic(dimension: int = 12, *, seed: int = 3, jump: float = 0.0, curves: bool = True) -> Synthetic:
    """Problem of `dimension` variables: all on 101 levels but the second (11) and the third (continuous)."""
    axle = read_axle(AXLE)
    paths = [p.path for p in design_parameters(axle) if p.active][:dimension]
    changes = [Change(match=paths[1], levels=11), Change(match=paths[2], levels="continuous")]
    space = build_space(axle, VariableOptions(use=paths, change=changes), "test")
    rng = np.random.default_rng(seed)
    known = _map(space.start, rng, jump)
    truth = space.snapped(space.start + rng.uniform(-0.3, 0.3, dimension))
    known = replace(known, edge=float(0.5 * (truth[0] + space.start[0])))
    wanted = known(truth)
    typed = [CharacteristicOptions(match=c, target=v) for c, v in zip(CHARACTERISTICS, wanted, strict=False)]
    targets = build_targets(axle, None, typed, [], source="test")
    lines = _lines(wanted)
    likelihood = Likelihood(
        tuple(
            CurveData(CASE, r, side, INPUT, lines[r][side], 0.01 * np.eye(INPUT.size))
            for r in LINES
            for side in (0, 1)
        ),
        (),
    )
    targets = replace(targets, curves=tuple(_target(r, lines[r]) for r in LINES) if curves else ())
    return Synthetic(axle, space, targets, likelihood, {}, True, map=known, truth=truth)


def _map(centre: FloatArray, rng: np.random.Generator, jump: float) -> Map:
    m, d = COUNT + 2 * len(LINES) * INPUT.size, centre.size
    value = rng.uniform(1.0, 3.0, m)
    slope = 0.6 * value[:, None] * rng.standard_normal((m, d))
    shape = np.tile(INPUT / INPUT.max(), 2 * len(LINES))
    sensitive = np.repeat(rng.standard_normal((2 * len(LINES), d)), INPUT.size, axis=0)
    value[COUNT:], slope[COUNT:] = shape, 0.6 * shape[:, None] * sensitive
    return Map(centre, value, slope, 0.15 * slope * rng.standard_normal((m, d)), jump)


def _lines(outputs: FloatArray) -> dict[str, FloatArray]:
    return dict(zip(LINES, outputs[COUNT:].reshape(len(LINES), 2, INPUT.size), strict=True))


def _target(response: str, curve: FloatArray) -> CurveTarget:
    return CurveTarget(
        load_case=CASE,
        response=response,
        input_unit="mm",
        input=INPUT,
        curve=curve,
        noise=0.001,
        objective=Objective(norm=float(np.ptp(curve))),
    )


def answer(problem: Synthetic, point: FloatArray) -> Outcome:
    """What the solver says of a point (d,)."""
    outputs = problem.map(point)
    lines = _lines(outputs)
    flat = {r: np.zeros_like(c) for r, c in lines.items()}
    case = CaseCurves(CASE, "mm", INPUT, lines, flat)
    return Outcome(CurveSet("test", {CASE: case}, None, 750.0), outputs[:COUNT], "", 0.0)


def solver(problem: Synthetic, *, fails: Fails = lambda _: False) -> Evaluate:
    """Evaluations; the design that the search starts from never fails."""

    def one(values: Mapping[str, float]) -> Outcome:
        point = problem.space.unit(values)
        baseline = np.allclose(point, problem.space.start, atol=1e-9)
        return failure("no equilibrium") if fails(point) and not baseline else answer(problem, point)

    def evaluate(designs: Sequence[Mapping[str, float]]) -> list[Outcome]:
        return [one(values) for values in designs]

    return evaluate


def at_random(share: float) -> Fails:
    """Fails on that share of all designs, the same ones every time."""

    def fails(point: FloatArray) -> bool:
        digest = hashlib.sha256(np.round(point, 6).tobytes()).digest()
        return int.from_bytes(digest[:4], "big") / 2**32 < share

    return fails


def everywhere(_: FloatArray) -> bool:
    """Fails on every design."""
    return True
