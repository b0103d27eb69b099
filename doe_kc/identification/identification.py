"""The axle that has a measured influence matrix, from several starts, and what the matrix says of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.campaign.executors import InProcess
from doe_kc.campaign.processes import Processes, available_cores
from doe_kc.ground.errors import RunError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.identification.agreement import MatrixAgreement, agreement
from doe_kc.identification.matrix_model import MatrixModel
from doe_kc.identification.measured_matrix import MeasuredMatrix
from doe_kc.identification.projected_fit import MatrixFit, projected_fit
from doe_kc.identification.unknowns import BOUND_SDS, Unknowns
from doe_kc.parameter_influence.study import percent_of_column

if TYPE_CHECKING:
    import pandas as pd

CELL_NOISE = 0.03
"""Share of a column's length: what the published matrix and the best axle for it differ by in a cell."""
IDENTIFICATION_STARTS = 3
START_SPREAD = 0.5
"""Prior standard deviations of the starts about the axle."""
USUAL_STEPS = 20
"""Of a fit to the published matrix, for the progress."""
DRAWS = 20
"""Starts drawn for one that has an equilibrium."""
AT_BOUND = 1e-6
"""Prior standard deviations from a bound."""
DIRECTION_UNKNOWNS = 4
"""Unknowns that a direction is described by."""
Watch = Callable[[str, int, int], None]
"""Told what is under way, steps done, of how many."""


@dataclass(frozen=True)
class Identification:
    """The best of several fits.

    fits: of every start, best first; own: (p, m) exact matrix of the identified axle, a change for a
    positive step of the parameter in the characteristic's unit; before: (p, m) that of the axle at the start.
    """

    model: MatrixModel
    fits: tuple[MatrixFit, ...]
    own: FloatArray
    before: FloatArray

    @property
    def measured(self) -> MeasuredMatrix:
        """The matrix that was fitted."""
        return self.model.measured

    @property
    def unknowns(self) -> Unknowns:
        """What was free."""
        return self.model.unknowns

    @property
    def best(self) -> MatrixFit:
        """The fit of least cost."""
        return self.fits[0]

    @cached_property
    def axle(self) -> Axle:
        """The identified axle."""
        return self.unknowns.axle_at(self.best.z)

    @cached_property
    def agreement(self) -> MatrixAgreement:
        """With the measured matrix, over the cells that were fitted."""
        return agreement(self.own, self.measured.values, self.measured.counted, any_sign=self.model.any_sign)

    @cached_property
    def agreement_before(self) -> MatrixAgreement:
        """The same of the axle at the start."""
        m = self.measured
        return agreement(self.before, m.values, m.counted, any_sign=self.model.any_sign)

    @cached_property
    def in_measured_units(self) -> FloatArray:
        """(p, m) matrix of the identified axle in the unit and with the sign of each measured column, by the
        factor that fits its cells that count best; without such cells in percent of its largest entry."""
        m = self.measured
        cells = m.counted & np.isfinite(m.values)
        own, values = (np.where(cells, np.nan_to_num(a), 0.0) for a in (self.own, m.values))
        along, length = np.einsum("ij,ij->j", own, values), np.einsum("ij,ij->j", own, own)
        factor = np.divide(along, length, out=np.zeros_like(along), where=length > 0)
        return np.where(m.fitted_columns, self.own * factor, percent_of_column(self.own))

    @property
    def cell_noise(self) -> float:
        """Root mean square of the residuals, a share of the length of a column; the noise assumed is right
        where it is near that."""
        return float(np.sqrt(np.mean(self.best.residual**2)) * self.model.noise)

    @cached_property
    def _decomposition(self) -> tuple[FloatArray, FloatArray]:
        """(d,) singular values of the Jacobian in prior standard deviations, (d, d) directions as rows."""
        _, values, directions = np.linalg.svd(self.best.jacobian, full_matrices=True)
        out = np.zeros(self.best.z.size)
        out[: values.size] = values
        return out, directions

    @property
    def informed(self) -> int:
        """Directions of which the matrix says more than the prior."""
        return int(np.sum(self._decomposition[0] > 1.0))

    def parameters(self) -> pd.DataFrame:
        """One row an unknown, its path as index.

        start, identified, lower, upper: absolute. sd_before, sd_after: prior and posterior standard
        deviation at the identified axle, to first order. moved: in prior standard deviations. at_bound.
        """
        import pandas as pd

        u, z = self.unknowns, self.best.z
        values, directions = self._decomposition
        after = np.sqrt((directions**2).T @ (1.0 / (1.0 + values**2)))
        lower, upper = u.bounds()
        columns = {
            "start": u.start,
            "identified": u.values(z),
            "lower": lower,
            "upper": upper,
            "sd_before": u.sd_of_values(z, np.ones_like(z)),
            "sd_after": u.sd_of_values(z, after),
            "moved": z,
            "at_bound": BOUND_SDS - np.abs(z) <= AT_BOUND,
            "unit": list(u.units),
        }
        return pd.DataFrame(columns, index=pd.Index(u.paths, name="parameter"))

    def directions(self) -> pd.DataFrame:
        """One row a direction of the unknowns, best known first.

        information: singular value of the Jacobian, 1 where matrix and prior say as much. sd_ratio: standard
        deviation along it after over before. unknowns: those that it mostly consists of, with their share.
        """
        import pandas as pd

        values, directions = self._decomposition
        rows = [
            (s, 1.0 / np.sqrt(1.0 + s * s), self._words(v)) for s, v in zip(values, directions, strict=True)
        ]
        index = pd.RangeIndex(1, len(rows) + 1, name="direction")
        return pd.DataFrame(rows, columns=["information", "sd_ratio", "unknowns"], index=index)

    def _words(self, direction: FloatArray) -> str:
        order = np.argsort(-np.abs(direction), kind="stable")[:DIRECTION_UNKNOWNS]
        lead = np.sign(direction[order[0]])
        return ", ".join(f"{self.unknowns.paths[i]} {lead * direction[i]:+.2f}" for i in order)

    def starts(self) -> pd.DataFrame:
        """One row a start, best first: cost, means of magnitude and signed correlation, converged, steps, and
        distance: root mean square of its unknowns from the best, in prior standard deviations."""
        import pandas as pd

        m = self.measured
        rows = []
        for fit in self.fits:
            own = self.own if fit is self.best else self.model.matrix(fit.z)
            means = agreement(own, m.values, m.counted, any_sign=self.model.any_sign).means
            far = float(np.sqrt(np.mean((fit.z - self.best.z) ** 2)))
            rows.append((fit.cost, *means, fit.converged, fit.steps, far))
        columns = ["cost", "magnitude", "signed", "converged", "steps", "distance"]
        return pd.DataFrame(rows, columns=columns, index=pd.RangeIndex(1, len(rows) + 1, name="start"))


@one_thread()
def identification(
    model: MatrixModel,
    *,
    starts: int = IDENTIFICATION_STARTS,
    seed: int = 0,
    workers: int | None = None,
    watch: Watch = lambda *_: None,
) -> Identification:
    """Fits from the axle itself and from starts drawn about it (normal, half a prior standard deviation).

    watch: its number of steps in all is an estimate. RunError when the axle has no equilibrium, or none of
    20 draws for a start has one.
    """
    size = len(model.unknowns.paths)
    before = model.matrix(np.zeros(size))
    count = available_cores() if workers is None else workers
    rng = np.random.default_rng(seed)
    fits: list[MatrixFit] = []
    total, done = starts * USUAL_STEPS, 0

    def step_done(cost: float) -> None:
        nonlocal done
        done += 1
        watch(f"start {len(fits) + 1} of {starts}, cost {cost:.1f}", min(done, total - 1), total)

    executor = InProcess() if count == 1 else Processes(count)
    try:
        for k in range(starts):
            points = _draws(rng, size) if k else iter([np.zeros(size)])
            fits.append(_first_fit(points, model, executor, count, step_done))
            done = USUAL_STEPS * len(fits)
            watch(f"start {len(fits)} of {starts}, cost {fits[-1].cost:.1f}", done, total)
    finally:
        executor.shutdown(cancel_futures=True)
    ordered = tuple(sorted(fits, key=lambda fit: fit.cost))
    return Identification(model, ordered, model.matrix(ordered[0].z), before)


def _draws(rng: np.random.Generator, size: int) -> Iterator[FloatArray]:
    for _ in range(DRAWS):
        yield np.clip(START_SPREAD * rng.normal(size=size), -BOUND_SDS, BOUND_SDS)


def _first_fit(
    points: Iterator[FloatArray],
    model: MatrixModel,
    executor: Executor,
    workers: int,
    step_done: Callable[[float], None],
) -> MatrixFit:
    """From the first of the points that has an equilibrium."""
    for point in points:
        result = projected_fit(model, point, executor, workers, step_done)
        if result is not None:
            return result
    raise RunError(
        f"identify: none of {DRAWS} starts about the axle has an equilibrium; free fewer parameters or give "
        "them smaller standard deviations."
    )
