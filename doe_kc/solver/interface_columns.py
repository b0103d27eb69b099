"""Laws that could rule at an interface, and what each would do to the curves: a column a probe."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import CURVE_OUTPUTS, CurveGradients, gradients_of, is_loop
from doe_kc.solver.interfaces import BranchInfluences, Influences, StaticInfluences
from doe_kc.solver.probe import Kind, Probe
from doe_kc.solver.result import BranchSolution, CaseSolution
from doe_kc.solver.sensitivity import Sensitivities

CLEARANCE_ROUNDING = 0.005
"""Share of a probe's largest response over which the sign of a clearance is rounded."""


@dataclass(frozen=True)
class Law:
    """Value h of a probe for amplitude 1, from its response v.

    kinds: probes that it applies to. unit: of the amplitude, with {unit} of the probe and {response} of its
    response. value: (v, largest |v|) -> h, elementwise; None for a law with memory (friction).
    """

    id: str
    words: str
    kinds: tuple[Kind, ...]
    unit: str
    value: Callable[[FloatArray, FloatArray], FloatArray] | None

    def amplitude_unit(self, probe: Probe) -> str:
        """Unit of its amplitude at a probe, e.g. mm/N."""
        return self.unit.format(unit=probe.unit, response=probe.response_unit)


def _rounded_sign(v: FloatArray, largest: FloatArray) -> FloatArray:
    corner = CLEARANCE_ROUNDING * np.where(largest > 0.0, largest, 1.0)
    return np.asarray(v / np.hypot(v, corner))


EITHER: tuple[Kind, ...] = ("dislocation", "force pair")
LAWS: Mapping[str, Law] = {
    law.id: law
    for law in (
        Law("compliance", "gives way in proportion to its load", ("dislocation",), "{unit}/{response}",
            lambda v, _: v),
        Law("offset", "is out of place, or preloaded", EITHER, "{unit}", lambda v, _: np.ones_like(v)),
        Law("clearance", "has play, or a preload that turns over", EITHER, "{unit}", _rounded_sign),
        Law("stiffness", "is held by a further spring", ("force pair",), "{unit}/{response}", lambda v, _: v),
        Law("progression", "stiffens with its deflection", ("force pair",), "{unit}/{response}^3",
            lambda v, _: v**3),
        Law("friction", "sticks", ("force pair",), "{unit}", None),
    )
}  # fmt: skip
"""By id."""


def stop_operator(paths: Sequence[FloatArray], presliding: FloatArray) -> list[FloatArray]:
    """Friction over its level, in [-1, 1], along consecutive paths (n_i, m).

    Dahl's law, exact over monotone steps, from zero at the first point. presliding: (m,), > 0.
    """
    out = []
    force, at = np.zeros_like(presliding), paths[0][0]
    for path in paths:
        rows = []
        for point in path:
            sign = np.where(point >= at, 1.0, -1.0)
            force = sign - (sign - force) * np.exp(-np.abs(point - at) / presliding)
            at = point
            rows.append(force)
        out.append(np.array(rows))
    return out


PRESLIDING = 0.05
"""mm or deg over which friction builds up."""


def law_columns(
    influences: Influences, law: str, presliding: float | FloatArray = PRESLIDING
) -> CurveGradients:
    """Derivatives of the curves to the amplitude of a law, at zero, referred to static as curves are.

    Columns, by `paths`, are the probes that the law applies to (`Probe.name`). law: of LAWS. presliding: of
    friction only, > 0, mm or deg, one for all probes of the axle or (m,). Friction on an axle without any
    runs its sweeps forth and back on the states known, and so has half-widths.
    KeyError for an unknown law.
    """
    chosen = LAWS[law]
    pick = np.array([i for i, p in enumerate(influences.probes) if p.kind in chosen.kinds], dtype=int)
    at_place = picked(influences, pick)
    if chosen.value is None:
        at_place = looped(at_place)
        distances = np.broadcast_to(np.asarray(presliding, dtype=float), (len(influences.probes),))[pick]
        values = {i: stop_operator([b.seen for b in c], distances) for i, c in at_place.branches.items()}
        design = static = np.zeros(pick.size)
    else:
        values, design, static = _pointwise(at_place, chosen)
    datum = at_place.static.datum_design * design + at_place.static.datum * static
    start = (
        at_place.static.output_design * design + at_place.static.output * static,
        at_place.static.state_design * design + at_place.static.state * static,
    )
    kept = [at_place.solution.column(name) for name in CURVE_OUTPUTS]
    branches = {
        ident: tuple(rows[:, kept] for rows in _case(case, values[ident], datum, start, loop=is_loop(case)))
        for ident, case in at_place.branches.items()
    }
    names = tuple(p.name for p in at_place.probes)
    return gradients_of(at_place.solution, Sensitivities(names, start[0], branches, CURVE_OUTPUTS))


def _pointwise(
    influences: Influences, law: Law
) -> tuple[dict[str, list[FloatArray]], FloatArray, FloatArray]:
    """Values h of a law without memory: by load case and branch, static at design height, static."""
    assert law.value is not None
    seen = [b.seen for case in influences.branches.values() for b in case]
    largest = np.abs(np.vstack([*seen, influences.static.seen[None]])).max(axis=0)
    values = {i: [law.value(b.seen, largest) for b in case] for i, case in influences.branches.items()}
    return (
        values,
        law.value(influences.static.seen_design, largest),
        law.value(influences.static.seen, largest),
    )


def _case(
    branches: tuple[BranchInfluences, ...],
    values: list[FloatArray],
    datum: FloatArray,
    start: tuple[FloatArray, FloatArray],
    *,
    loop: bool,
) -> tuple[FloatArray, ...]:
    """(n, ny, m) per branch; a loop hands its friction states from branch to branch."""
    out: list[FloatArray] = []
    first, dz = start
    for b, h in zip(branches, values, strict=True):
        if not loop:
            first, dz = start
        columns = b.influence * h[:, None, :] + b.datum @ datum
        columns[0] = first
        if dz.size:
            for i in range(1, len(h)):
                columns[i] += b.state[i] @ dz
                dz = b.next_influence[i] * h[i] + b.next_datum[i] @ datum + b.next_state[i] @ dz
        out.append(columns[b.ends])
        first = columns[-1]
    return tuple(out)


def picked(influences: Influences, probes: FloatArray) -> Influences:
    """The influences of some probes, by their index."""
    static = StaticInfluences(
        **{n: getattr(influences.static, n)[..., probes] for n in vars(influences.static)}
    )
    branches = {
        ident: tuple(
            replace(
                b,
                seen=b.seen[:, probes],
                influence=b.influence[..., probes],
                next_influence=b.next_influence[..., probes],
            )
            for b in case
        )
        for ident, case in influences.branches.items()
    }
    return Influences(influences.solution, tuple(influences.probes[i] for i in probes), static, branches)


def looped(influences: Influences) -> Influences:
    """The same with two branches from zero rearranged as the loop that a rig runs: 0, +A, -A, +A."""
    cases, branches = dict(influences.solution.cases), dict(influences.branches)
    for ident, case in influences.solution.cases.items():
        if is_loop(case.branches):
            continue
        cases[ident] = _looped_case(case)
        pos, neg = influences.branches[ident]
        rising = _joined(neg, pos)
        branches[ident] = (pos, _reversed(rising), rising)
    return replace(influences, solution=replace(influences.solution, cases=cases), branches=branches)


def _looped_case(case: CaseSolution) -> CaseSolution:
    pos, neg = case.branches
    fields = ("input", "y", "x", "z", "u")
    up = {f: np.concatenate([getattr(neg, f)[:0:-1], getattr(pos, f)]) for f in fields}
    load = BranchSolution("load", path=pos.path, **up)
    unload = BranchSolution("unload", path=neg.path, **{f: v[::-1] for f, v in up.items()})
    return CaseSolution(case.load_case, (replace(pos, name="init"), unload, load))


def _joined(neg: BranchInfluences, pos: BranchInfluences) -> BranchInfluences:
    return BranchInfluences(*(np.concatenate([a[:0:-1], b]) for a, b in _pairs(neg, pos)))


def _reversed(b: BranchInfluences) -> BranchInfluences:
    return BranchInfluences(*(a[::-1] for a, _ in _pairs(b, b)))


def _pairs(one: BranchInfluences, other: BranchInfluences) -> list[tuple[FloatArray, FloatArray]]:
    return [(getattr(one, name), getattr(other, name)) for name in vars(one)]
