"""One parameter at a time, its step up and down from nominal: a design like any other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from doe_kc.axle.design_parameters import Parameter
from doe_kc.sampling._base import Request, Sampler, design_of, sampler
from doe_kc.sampling.design import Design
from doe_kc.variables import Space, Variable


def one_at_a_time(parameters: Sequence[Parameter]) -> Design:
    """(1 + 2 d) designs: nominal, then + and - of every parameter in turn.

    Rows 1 + 2 i and 2 + 2 i belong to parameter i. A parameter that must not fall below zero and would
    (a flexibility of 0) keeps its nominal value in the - row: see `Parameter.one_sided`.
    """
    nominal = np.array([p.nominal for p in parameters])
    rows, labels = [nominal], ["nominal"]
    for i, parameter in enumerate(parameters):
        for sign in (1.0, -1.0):
            row = nominal.copy()
            if not (sign < 0 and parameter.one_sided):
                row[i] += sign * parameter.step
            rows.append(row)
            labels.append(f"{parameter.path} {sign * parameter.step:+g} {parameter.unit}".removesuffix(" -"))
    return Design("one_at_a_time", tuple(p.path for p in parameters), np.array(rows), tuple(labels))


@sampler
class OneAtATime(Sampler):
    """(1 + 2 d) designs of a space: its start, then every variable its parameter's step up and down.

    Within the bounds and on the levels; where these are coarser than the step, the next level.
    """

    id: ClassVar[str] = "one_at_a_time"
    sized: ClassVar[bool] = False
    seeded: ClassVar[bool] = False

    def sample(self, space: Space, request: Request) -> Design:
        start = space.snapped(space.start)
        points, labels = [start], ["start"]
        for i, variable in enumerate(space.variables):
            for sign in (1.0, -1.0):
                point = start.copy()
                point[i] = stepped(variable, float(start[i]), sign)
                points.append(point)
                labels.append(_label(variable, float(start[i]), float(point[i])))
        return design_of(self.id, space, np.array(points), labels)


def stepped(variable: Variable, start: float, sign: float) -> float:
    """u of a variable, in [0, 1], one step up or down from the u of its start."""
    value = variable.value(start) + sign * variable.parameter.step
    u = variable.snapped(variable.place(min(max(value, variable.lower), variable.upper)))
    if u == start and variable.levels is not None:
        u = start + sign / (variable.levels - 1)
    return min(max(u, 0.0), 1.0)


def _label(variable: Variable, start: float, u: float) -> str:
    change = variable.value(u) - variable.value(start)
    return f"{variable.path} {change:+.6g} {variable.unit}".removesuffix(" -")
