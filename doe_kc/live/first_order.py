"""The first-order model of a design: exact slopes of curves and characteristics, and how far they hold."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.curves import RESPONSE_UNITS, response_name
from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray
from doe_kc.live.advice import influence
from doe_kc.live.answer import Compilation, LiveAnswer, LiveSlopes, solve_live
from doe_kc.live.frames import drawn_curves
from doe_kc.load_cases import case_label
from doe_kc.variables import Space

MOST_SLIDERS = 30
"""Of a page of about two MB."""
JOINT_DESIGNS = 12
"""Random designs over all ranges by which the model is checked, beside each slider alone at its bounds."""


@dataclass(frozen=True)
class FirstOrder:
    """y(u) = y + dy/du (u - u0) in the places u of k sliders. columns: (k,) their places in the space.

    curves, slopes: (N,) and (N, k) as `drawn_curves`. characteristics, characteristic_slopes: (m,), (m, k).
    chi, pull, hessian: r'r, (k,) J'r and (k, k) J'J of the residual. data: M.
    """

    answer: LiveAnswer
    space: Space
    columns: np.ndarray
    curves: FloatArray
    slopes: FloatArray
    characteristics: FloatArray
    characteristic_slopes: FloatArray
    chi: float
    pull: FloatArray
    hessian: FloatArray
    data: int

    @property
    def paths(self) -> tuple[str, ...]:
        """(k,) its sliders."""
        return tuple(self.space.paths[i] for i in self.columns)

    def shift(self, values: Mapping[str, float]) -> FloatArray:
        """(k,) u - u0 of absolute values; those not named stay."""
        own = [self.answer.model.space.variables[i] for i in self.columns]
        base = self.answer.point[self.columns]
        return np.array(
            [v.place(values[v.path]) - u if v.path in values else 0.0 for v, u in zip(own, base, strict=True)]
        )

    def predict(self, values: Mapping[str, float]) -> tuple[FloatArray, FloatArray, float]:
        """Curves (N,), characteristics (m,) and gap at slider values."""
        s = self.shift(values)
        square = self.chi + 2.0 * float(self.pull @ s) + float(s @ self.hessian @ s)
        gap = math.sqrt(max(0.0, square) / self.data) if self.data else math.nan
        return self.curves + self.slopes @ s, self.characteristics + self.characteristic_slopes @ s, gap


@dataclass(frozen=True)
class CheckedRange:
    """designs: solved by the true model. curve_error: largest error of a curve, as a share of its range over
    the checked designs, joint_error: of the designs with all sliders moved; where: load case and response of
    the former. unsolved: designs without equilibrium.
    """

    designs: int
    curve_error: float
    joint_error: float
    where: str
    unsolved: int


def first_order(slopes: LiveSlopes, space: Space) -> FirstOrder:
    """The model about an answer, in the sliders that matter most for what is measured (else for the curves),
    those that were moved among them. space: with the bounds."""
    answer = slopes.answer
    columns = _chosen(slopes, space)
    expansion, residual = slopes.expansion, answer.residual
    jacobian = slopes.jacobian[:, columns]
    return FirstOrder(
        answer=answer,
        space=space,
        columns=columns,
        curves=drawn_curves(answer.curves, answer.curves),
        slopes=_curve_slopes(slopes)[:, columns],
        characteristics=answer.characteristics,
        characteristic_slopes=expansion.characteristics[:, columns],
        chi=float(residual @ residual),
        pull=jacobian.T @ residual,
        hessian=jacobian.T @ jacobian,
        data=residual.size,
    )


def _chosen(slopes: LiveSlopes, space: Space) -> np.ndarray:
    table = influence(slopes, space)
    ranges = np.array([v.upper - v.lower for v in space.variables])
    curves = np.abs(table[1 + len(slopes.answer.characteristics) :]) * ranges
    largest = curves.max(axis=1, keepdims=True)
    shares = np.divide(curves, largest, out=np.zeros_like(curves), where=largest > 0).sum(axis=0)
    weight = np.abs(table[0]) if slopes.answer.residual.size else shares
    moved = [abs(slopes.answer.values[v.path] - v.start) > 1e-9 for v in space.variables]
    order = sorted(range(len(weight)), key=lambda i: (not moved[i], -weight[i]))
    return np.array(sorted(order[:MOST_SLIDERS]))


def _curve_slopes(slopes: LiveSlopes) -> FloatArray:
    """(N, d) in the order of `drawn_curves`; a load case without friction has no slope of its loop."""
    curves, gradients = slopes.answer.curves, slopes.expansion.curves
    d = slopes.answer.model.space.dimension
    mean = [gradients.cases[case][r].reshape(-1, d) for case in curves.cases for r in RESPONSE_UNITS]
    half = [
        gradients.half_width[case][r].reshape(-1, d)
        if case in gradients.half_width
        else np.zeros((2 * of_case.input.size, d))
        for case, of_case in curves.cases.items()
        for r in RESPONSE_UNITS
    ]
    return np.concatenate([*mean, *half])


def checked_range(model: FirstOrder, compilation: Compilation, *, seed: int) -> CheckedRange:
    """The first-order model against the true one: each slider alone at both bounds, then all at random.

    RunError when none of these designs has an equilibrium.
    """
    answer, free = model.answer, [model.space.variables[i] for i in model.columns]
    alone = [{v.path: edge} for v in free for edge in (v.lower, v.upper)]
    random = np.random.default_rng(seed).random((JOINT_DESIGNS, len(free)))
    joint = [
        {v.path: v.lower + u * (v.upper - v.lower) for v, u in zip(free, row, strict=True)} for row in random
    ]
    base = {v.path: answer.values[v.path] for v in model.space.variables}
    truth: list[FloatArray | None] = []
    for design in (*alone, *joint):
        solved = solve_live(answer.model, {**base, **design}, compilation)
        truth.append(None if isinstance(solved, str) else drawn_curves(solved.curves, model.answer.curves))
    known = [t for t in truth if t is not None]
    if not known:
        raise RunError("none of the designs by which the page would be checked has an equilibrium.")
    slices, names = _curve_places(answer)
    ranges = np.array([np.ptp(np.array([t[s] for t in (*known, model.curves)])) for s in slices])
    errors = np.zeros((len(truth), len(slices)))
    for i, (design, curves) in enumerate(zip((*alone, *joint), truth, strict=True)):
        if curves is not None:
            gap = np.abs(model.predict(design)[0] - curves)
            errors[i] = [gap[s].max() for s in slices]
    share = np.divide(errors, ranges, out=np.zeros_like(errors), where=ranges > 1e-6)
    worst = int(np.argmax(share.max(axis=0)))
    return CheckedRange(
        designs=len(known),
        curve_error=float(share[: len(alone)].max()),
        joint_error=float(share[len(alone) :].max()),
        where=names[worst],
        unsolved=len(truth) - len(known),
    )


def _curve_places(answer: LiveAnswer) -> tuple[list[slice], list[str]]:
    """Where the mean curves of both wheels lie in `drawn_curves`, and their names."""
    slices, names, at = [], [], 0
    for ident, case in answer.curves.cases.items():
        for response in RESPONSE_UNITS:
            slices.append(slice(at, at + 2 * case.input.size))
            names.append(f"{case_label(ident).lower()}, {response_name(response)}")
            at += 2 * case.input.size
    return slices, names
