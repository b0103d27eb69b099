"""One parameter at a time, its step up and down from nominal: a design like any other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from doe_kc.axle.parameters import Parameter
from doe_kc.sampling.design import Design


def one_at_a_time(parameters: Sequence[Parameter]) -> Design:
    """(1 + 2 d) designs: nominal, then + and - of every parameter in turn.

    Rows 1 + 2 i and 2 + 2 i belong to parameter i. A parameter that must not fall below zero and would
    (a flexibility of 0) keeps its nominal value in the - row: see `is_one_sided`.
    """
    nominal = np.array([p.nominal for p in parameters])
    rows, labels = [nominal], ["nominal"]
    for i, parameter in enumerate(parameters):
        for sign in (1.0, -1.0):
            row = nominal.copy()
            if not (sign < 0 and is_one_sided(parameter)):
                row[i] += sign * parameter.step
            rows.append(row)
            labels.append(f"{parameter.path} {sign * parameter.step:+g} {parameter.unit}".removesuffix(" -"))
    return Design("one_at_a_time", tuple(p.path for p in parameters), np.array(rows), tuple(labels))


def is_one_sided(parameter: Parameter) -> bool:
    """True for a parameter at its lower limit of zero, which can only be raised."""
    return parameter.lower == 0.0 and parameter.nominal < parameter.step
