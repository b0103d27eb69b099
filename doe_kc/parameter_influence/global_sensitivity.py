"""Global sensitivities over the ranges of the variables, beside the slopes of the unchanged axle.

Where the two disagree the model is not linear over the ranges, and an answer by slopes alone would mislead.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.campaign.runner import Campaign
from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.ground.errors import RunError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.global_methods import GlobalIndex, GlobalMethod
from doe_kc.solver.curve_gradient import characteristic_gradients
from doe_kc.solver.suite import solve
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import Space, Variable

MISSED_SHARE, MISSED_EFFECT = 0.02, 0.1
"""Of the variance, of the largest mean effect: what slopes miss of a variable from which it counts as not
linear. The solver has no noise, so that anything above 0 is real; this much is worth a word."""
SIMULTANEOUS = 2.1
"""Times the half width of one interval: thousands of pairs of variable and characteristic are compared, and
with 95 % confidence none of 2000 is beyond 4.1 standard deviations by chance (Bonferroni)."""
WEAK_SHARE, CLEAR_SHARE = 0.01, 0.1
"""Share of the local variance below which a variable has no influence, and from which it has."""
CONVERGENCE_SHARES = (0.25, 0.5, 1.0)
"""Of the blocks of a method, with which its indices are computed."""


@dataclass(frozen=True)
class MethodResult:
    """indices: of the method, with all blocks. designs: that were solved for it; failed: blocks left out
    because a design of theirs has no equilibrium. errors: (len(CONVERGENCE_SHARES), k) largest error of the
    main index over the variables; changes: (k,) largest change of the main index by the second half of the
    blocks."""

    id: str
    label: str
    main: str
    indices: tuple[GlobalIndex, ...]
    designs: int
    blocks: int
    failed: int
    errors: FloatArray
    changes: FloatArray

    def index(self, ident: str) -> GlobalIndex:
        """One of the indices; StopIteration for one that the method does not give."""
        return next(i for i in self.indices if i.id == ident)


@dataclass(frozen=True)
class Disagreement:
    """Of one variable and characteristic: what slopes say, what the method says with its error, and what the
    slope misses (nan where the method does not say), in the method's measure. size: of the last, of the
    difference for PAWN, as a share of the variance or of the largest effect."""

    variable: Variable
    characteristic: Characteristic
    method: str
    local: float
    overall: float
    error: float
    missed: float
    size: float
    sentence: str


@dataclass(frozen=True)
class GlobalSensitivity:
    """d variables of a space, k characteristics.

    effects: (d, k) slopes at the start times the range. shares: (d, k) of the variance that these slopes
    would give over the distributions. explained: (k,) share of the variance over the ranges that a plane
    through the start explains; negative where it makes it worse; nan where no method says it.
    """

    variables: tuple[Variable, ...]
    characteristics: tuple[Characteristic, ...]
    effects: FloatArray
    shares: FloatArray
    explained: FloatArray
    methods: tuple[MethodResult, ...]
    runs: int
    seconds: float

    def disagreements(self) -> list[Disagreement]:
        """Where slopes miss what a method sees, the largest first."""
        out = [d for m in self.methods for d in _disagreements(self, m)]
        return sorted(out, key=lambda d: -d.size)


def global_runs(methods: Mapping[GlobalMethod, int], d: int) -> int:
    """Designs that methods of these sizes ask for over d variables."""
    return sum(size * method.block(d) for method, size in methods.items())


@one_thread()
def global_sensitivity(
    axle: Axle,
    space: Space,
    characteristics: Sequence[Characteristic],
    methods: Mapping[GlobalMethod, int],
    *,
    seed: int,
    store: Path | None = None,
    windows: Mapping[str, float] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> GlobalSensitivity:
    """Indices of every method over a space, by the package's own solver.

    methods: with their sizes. store: file of the evaluations; what it has is not run again. progress: told
    how many more designs are done. RunError when the start has no equilibrium, or more than half of a
    method's blocks have a design that has none.
    """
    started = time.perf_counter()
    columns = [list(CHARACTERISTICS).index(c.id) for c in characteristics]
    effects = _effects(axle, space, characteristics, windows)
    shares = _shares(effects, space)
    done: list[MethodResult] = []
    explained = np.full(len(characteristics), np.nan)
    solver = AxleSolver(axle, dict(windows or {}), curves=False)
    with Campaign(solver, store, workers=workers, scheduler=scheduler, stored_curves="none") as campaign:
        for method, size in methods.items():
            points = method.points(space.dimension, size, seed)
            places = space.snapped(space.drawn(points) if method.distributed else points)
            designs = [space.values(place) for place in places]
            outcomes = campaign.evaluate(designs, f"influence:{method.id}", progress, curves=False)
            values = np.array([o.characteristics[columns] for o in outcomes])
            done.append(_method_result(method, points, values, (places - space.start) @ effects, seed))
            if method.distributed:
                explained = _explained(space, places, values, effects)
    return GlobalSensitivity(
        variables=space.variables,
        characteristics=tuple(characteristics),
        effects=effects,
        shares=shares,
        explained=explained,
        methods=tuple(done),
        runs=campaign.runs,
        seconds=time.perf_counter() - started,
    )


def _effects(
    axle: Axle, space: Space, characteristics: Sequence[Characteristic], windows: Mapping[str, float] | None
) -> FloatArray:
    """(d, k) exact derivatives to the places in [0, 1] at the start, ties included."""
    from doe_kc.axle.parameters import with_values

    start = with_values(axle, space.values(space.start))
    paths = list(dict.fromkeys([*space.paths, *(t.follower for t in space.ties)]))
    slopes = characteristic_gradients(start, solve(start), paths, characteristics, windows=windows).T
    row = dict(zip(paths, slopes, strict=True))
    out = np.array([row[path] for path in space.paths])
    for tie in space.ties:
        out[space.paths.index(tie.leader)] += tie.slope * row[tie.follower]
    return np.asarray(np.nan_to_num(out) * space.slopes(space.start)[:, None])


def _shares(effects: FloatArray, space: Space) -> FloatArray:
    parts = (effects * space.prior_sd[:, None]) ** 2
    total = parts.sum(axis=0)
    return np.asarray(np.divide(parts, total, out=np.zeros_like(parts), where=total > 0.0))


def _explained(space: Space, places: FloatArray, values: FloatArray, effects: FloatArray) -> FloatArray:
    """(k,) 1 - variance about the plane over variance, of the designs that were solved."""
    known = np.isfinite(values).all(axis=1)
    plane = (places[known] - space.start) @ effects
    variance = values[known].var(axis=0)
    rest = (values[known] - plane).var(axis=0)
    return np.asarray(1.0 - np.divide(rest, variance, out=np.ones_like(rest), where=variance > 0.0))


def _method_result(
    method: GlobalMethod, points: FloatArray, values: FloatArray, plane: FloatArray, seed: int
) -> MethodResult:
    size = method.block(points.shape[1])
    solved = np.isfinite(values).all(axis=1)
    blocks = np.asarray(solved.reshape(-1, size).all(axis=1), dtype=bool)
    kept = int(blocks.sum())
    if kept < max(4, len(blocks) // 2):
        raise RunError(
            f"global sensitivity by {method.label}: {len(blocks) - kept} of {len(blocks)} samples hold a "
            "design without equilibrium; narrow the ranges in [variables]."
        )
    rows = np.repeat(blocks, size)
    inside, results, slopes = points[rows], values[rows], plane[rows]
    stages = []
    for share in CONVERGENCE_SHARES:
        count = max(2, round(share * kept)) * size
        stages.append(_indices(method, inside[:count], results[:count], slopes[:count], seed))
    mains = [next(i for i in stage if i.id == method.main) for stage in stages]
    return MethodResult(
        id=method.id,
        label=method.label,
        main=method.main,
        indices=stages[-1],
        designs=len(values),
        blocks=kept,
        failed=len(blocks) - kept,
        errors=np.array([m.error.max(axis=0) for m in mains]),
        changes=np.abs(mains[-1].values - mains[-2].values).max(axis=0),
    )


def _indices(
    method: GlobalMethod, points: FloatArray, values: FloatArray, plane: FloatArray, seed: int
) -> tuple[GlobalIndex, ...]:
    """Zero for an output that never changes."""
    spread = np.ptp(values, axis=0)
    moving = spread > 1e-12 * np.abs(values).max(axis=0)
    indices = method.indices(points, values[:, moving], plane[:, moving], seed) if moving.any() else ()
    out = []
    for index in indices:
        full, error = np.zeros((2, points.shape[1], values.shape[1]))
        full[:, moving], error[:, moving] = index.values, index.error
        out.append(GlobalIndex(index.id, index.label, full, error))
    return tuple(out)


def _disagreements(result: GlobalSensitivity, method: MethodResult) -> Iterator[Disagreement]:
    main = method.index(method.main)
    for i, k in np.ndindex(*main.values.shape):
        overall, error = float(main.values[i, k]), float(main.error[i, k])
        variable, entry = result.variables[i], result.characteristics[k]
        share, effect = float(result.shares[i, k]), abs(float(result.effects[i, k]))
        if method.id == "pawn":
            chance, margin = float(method.index("chance").values[i, k]), SIMULTANEOUS * error
            hidden = overall - margin > chance and share < WEAK_SHARE
            if not hidden and not (overall + margin < chance and share > CLEAR_SHARE):
                continue
            own, missed, size = share, math.nan, abs(overall - chance)
            words = (
                f"{variable.path} shifts the distribution of {entry.id} by {overall:.2f} ± {error:.2f} "
                f"(chance {chance:.2f}), by its slope it has {100.0 * share:.1f} % of the variance"
            )
        elif method.id == "morris":
            own, missed = effect, float(method.index("missed").values[i, k])
            size = missed / max(float(main.values[:, k].max()), effect, 1e-300)
            if size < MISSED_EFFECT:
                continue
            words = (
                f"{variable.path} moves {entry.id} by {overall:.3g} ± {error:.2g} {entry.unit} over its "
                f"range on average, by its slope by {own:.3g}; what it does beyond its slope is {missed:.3g}"
            )
        else:
            own, missed = share, float(method.index("missed").values[i, k])
            size = missed
            if size < MISSED_SHARE:
                continue
            words = (
                f"{variable.path} takes part in {100.0 * overall:.0f} ± {100.0 * error:.0f} % of the "
                f"variance of {entry.id} over the ranges, by its slope in {100.0 * own:.0f} %; "
                f"{100.0 * missed:.0f} % are beyond its slope"
            )
        yield Disagreement(
            variable, entry, method.label, own, overall, error, missed, size, f"{words} ({method.label})."
        )
