"""Names and sizes of a topology's equations: all that a loaded kernel needs of them."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np

from doe_kc.solver.builder import Unknown
from doe_kc.solver.equations import Equations
from doe_kc.solver.minimum_degree import minimum_degree_order


@dataclass(frozen=True)
class EquationLayout:
    """As in `Equations`, without its expressions.

    states: number of friction states z. rows, cols: (nnz,) places of the Jacobian's nonzeros.
    order: (nx,) of its elimination, see `minimum_degree_order`.
    """

    unknowns: tuple[Unknown, ...]
    tail: int
    parameter_names: tuple[str, ...]
    control_names: tuple[str, ...]
    output_names: tuple[str, ...]
    slips: tuple[str, ...]
    states: int
    rows: np.ndarray
    cols: np.ndarray
    order: np.ndarray


def layout_of(equations: Equations, rows: np.ndarray, cols: np.ndarray) -> EquationLayout:
    """Of assembled equations; rows, cols: of their Jacobian."""
    return EquationLayout(
        unknowns=equations.unknowns,
        tail=equations.tail,
        parameter_names=equations.parameter_names,
        control_names=equations.control_names,
        output_names=equations.output_names,
        slips=equations.slips,
        states=int(equations.z.numel()),
        rows=np.asarray(rows, dtype=np.int32),
        cols=np.asarray(cols, dtype=np.int32),
        order=minimum_degree_order(rows, cols, len(equations.unknowns), equations.tail),
    )


def layout_text(layout: EquationLayout) -> str:
    """As JSON."""
    return json.dumps(
        {
            "unknowns": [[u.name, u.joint, u.scale] for u in layout.unknowns],
            "tail": layout.tail,
            "parameter_names": layout.parameter_names,
            "control_names": layout.control_names,
            "output_names": layout.output_names,
            "slips": layout.slips,
            "states": layout.states,
            "rows": layout.rows.tolist(),
            "cols": layout.cols.tolist(),
            "order": layout.order.tolist(),
        }
    )


def read_layout(text: str) -> EquationLayout:
    """Of `layout_text`; ValueError, KeyError or TypeError for another text."""
    entries = json.loads(text)
    names = ("parameter_names", "control_names", "output_names", "slips")
    return EquationLayout(
        unknowns=tuple(Unknown(*entry) for entry in entries["unknowns"]),
        tail=int(entries["tail"]),
        states=int(entries["states"]),
        rows=np.array(entries["rows"], dtype=np.int32),
        cols=np.array(entries["cols"], dtype=np.int32),
        order=np.array(entries["order"], dtype=np.int32),
        **{name: tuple(entries[name]) for name in names},
    )
