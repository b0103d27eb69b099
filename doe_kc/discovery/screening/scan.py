"""The generic scan: a law at every interface and degree of freedom, so that naming is not limited to a list.

Columns come from reactions and influences of one solved axle, without a further solution. Left and right are
taken alike, or one side alone; the degrees of freedom of an interface together, their amplitudes of the sign
that physics allows.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import nnls

from doe_kc.axle.model import FORCE_AXES, Axle
from doe_kc.axle.structure import of_side
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.thresholds import COLUMN_SHARE, PLACE_PROBABILITY
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.interface_columns import LAWS, law_columns
from doe_kc.solver.interfaces import Influences, interface_influences
from doe_kc.solver.probe import Probe

SIGNED = ("offset", "stiffness")
"""Laws whose amplitude may be negative."""
ALL_BUSHINGS = "all bushings"
RUBBER_YIELD = 0.2
"""mm over which the friction of rubber builds up."""
AXIS_WORDS = {
    "x": "along x",
    "y": "along y",
    "z": "along z",
    "rx": "about x",
    "ry": "about y",
    "rz": "about z",
}


@dataclass(frozen=True)
class Place:
    """A law at an interface."""

    interface: str
    """Names of its two bodies as `one|other`, or of a bushing, or `all bushings`."""
    law: str
    """compliance, offset, clearance, stiffness, progression or friction."""
    side: str
    """both, L or R."""
    dofs: tuple[str, ...]
    """Degrees of freedom that count, the largest first."""
    score: float
    """Standard deviations by which it improves the fit."""
    explained: float
    """Share of what re-tuning leaves that it explains, 0 to 1."""
    probability: float
    """Among all places of the scan."""

    @property
    def words(self) -> str:
        """e.g. an unlisted compliance about x between wheel and knuckle."""
        one, _, other = self.interface.partition("|")
        between = f"between {one} and {other}" if other else f"at {one}"
        axes = " and ".join(AXIS_WORDS.get(d, d) for d in self.dofs)
        side = {"L": ", left", "R": ", right"}.get(self.side, "")
        return f"an unlisted {self.law} {axes} {between}{side}"


@dataclass(frozen=True)
class Scan:
    """All places of the generic scan."""

    places: tuple[Place, ...]
    """Best first."""
    interface: str | None
    """The interface whose summed probability is above PLACE_PROBABILITY, None without one."""

    @staticmethod
    def of(scanned: Sequence[tuple[Place, float]], temper: float = 1.0) -> Scan:
        """scanned: see `scanned_places`. temper: ln evidence is divided by it."""
        logs = np.array([gain for _, gain in scanned]) / temper
        shares = np.exp(logs - logs.max()) / np.exp(logs - logs.max()).sum()
        places = tuple(
            replace(place, probability=float(share))
            for (place, _), share in zip(scanned, shares, strict=True)
        )
        return Scan(places, _sure_interface(places))


def scanned_places(tuned: Fit) -> list[tuple[Place, float]]:
    """Every place with its ln evidence at a model without effects, best first, yet without probabilities.

    NotConverged as `solve`.
    """
    axle = tuned.model.axle_at(tuned.z)
    influences = interface_influences(axle, tuned.model.solutions(axle))
    scored: list[tuple[Place, float]] = []
    for law in LAWS:
        scored += _of_law(law, influences, tuned)
    scored += _of_rubber(influences, tuned)
    return sorted(scored, key=lambda item: -item[1])


def _sure_interface(places: Sequence[Place]) -> str | None:
    sums: dict[str, float] = {}
    for p in places:
        sums[p.interface] = sums.get(p.interface, 0.0) + p.probability
    best = max(sums, key=lambda k: sums[k])
    return best if sums[best] > PLACE_PROBABILITY else None


def _of_law(law: str, influences: Influences, tuned: Fit) -> Iterator[tuple[Place, float]]:
    gradients = law_columns(influences, law)
    probes = {p.name: p for p in influences.probes}
    chosen = [probes[name] for name in gradients.paths]
    columns = _Columns.of(tuned.model.likelihood.jacobian(gradients, np.zeros((0, len(chosen)))), tuned)
    groups: dict[str, list[int]] = {}
    for i, p in enumerate(chosen):
        groups.setdefault(p.interface, []).append(i)
    for interface, members in groups.items():
        for side in ("both", "L", "R"):
            dofs, sums = _sums(chosen, members, side)
            if dofs:
                yield _place(interface, law, side, dofs, columns.summed(sums), tuned)


def _of_rubber(influences: Influences, tuned: Fit) -> Iterator[tuple[Place, float]]:
    """Friction of every bushing along its axes, in proportion to their stiffness: as rubber has it.

    No axis of a single bushing explains what all of them do together.
    """
    gradients = law_columns(influences, "friction", RUBBER_YIELD)
    axle = tuned.model.axle_at(tuned.z)
    probes = {p.name: p for p in influences.probes}
    weights = np.array([_stiffness(axle, probes[name]) for name in gradients.paths])
    if not weights.any():
        return
    columns = tuned.model.likelihood.jacobian(gradients, np.zeros((0, weights.size)))
    block = (columns @ (weights / weights.max()))[:, None]
    yield _place(ALL_BUSHINGS, "friction", "both", ["along x, y and z"], _Columns.of(block, tuned), tuned)


def _stiffness(axle: Axle, probe: Probe) -> float:
    """N/mm of a bushing's axis, 0 of any other probe and of a tabulated axis."""
    axis = dict(zip("xyz", FORCE_AXES, strict=True)).get(probe.dof, "")
    names = [of_side(f"{probe.interface}.{key}{axis}", probe.side) for key in ("", "stiffness.")]
    return float(np.prod([axle.values.get(name, 0.0) for name in names]))


@dataclass(frozen=True)
class _Columns:
    """Changes of the residual by k unknowns, as far as their evidence takes them."""

    before: FloatArray
    """(k, k) inner products before re-tuning."""
    left: FloatArray
    """(k, k) inner products after re-tuning."""
    along: FloatArray
    """(k,) inner products with the residual after re-tuning."""

    @staticmethod
    def of(columns: FloatArray, tuned: Fit) -> _Columns:
        """columns: (M, k)."""
        own, seen = tuned.changes(columns), tuned.projection
        return _Columns(columns.T @ columns, seen.gram_of(own), seen.inner(own, tuned.remainder)[:, 0])

    def summed(self, sums: FloatArray) -> _Columns:
        """Of sums of the unknowns' changes, (k, l) factors."""
        return _Columns(sums.T @ self.before @ sums, sums.T @ self.left @ sums, sums.T @ self.along)


def _sums(probes: Sequence[Probe], members: Sequence[int], side: str) -> tuple[list[str], FloatArray]:
    """(dofs, (probes, dofs)) of an interface: factors that add both sides up or take one alone.

    What has no side is `both`.
    """
    by_dof: dict[str, FloatArray] = {}
    for i in members:
        p = probes[i]
        if p.side == side or side == "both":
            by_dof.setdefault(p.dof, np.zeros(len(probes)))[i] = 1.0
    return list(by_dof), np.array(list(by_dof.values())).T


def _place(
    interface: str,
    law: str,
    side: str,
    dofs: Sequence[str],
    columns: _Columns,
    tuned: Fit,
) -> tuple[Place, float]:
    """The place with its ln evidence: ln(1 + score^2) / 2 is taken off for each degree of freedom."""
    before, left = np.diag(columns.before), np.diag(columns.left)
    use = (left > COLUMN_SHARE**2 * before) & (left > 0.0)
    if not use.any():
        return Place(interface, law, side, (), 0.0, 0.0, 0.0), 0.0
    length = np.sqrt(left[use])
    gram = columns.left[np.ix_(use, use)] / np.outer(length, length)
    slope = columns.along[use] / length
    amplitudes = _amplitudes(gram, slope, signed=law in SIGNED)
    gained = max(0.0, float(-2.0 * slope @ amplitudes - amplitudes @ gram @ amplitudes))
    order = np.argsort(-np.abs(amplitudes))
    names = np.array(list(dofs))[use]
    strongest = float(np.abs(amplitudes).max())
    counted = tuple(str(names[i]) for i in order if strongest > 0 and abs(amplitudes[i]) > 0.2 * strongest)
    gain = 0.5 * gained - 0.5 * len(counted) * float(np.log1p(gained))
    beyond_noise = tuned.misfit_left - tuned.residual.size
    explained_share = gained / max(beyond_noise, 1.0)
    return Place(interface, law, side, counted, float(np.sqrt(gained)), min(1.0, explained_share), 0.0), gain


def _amplitudes(gram: FloatArray, slope: FloatArray, *, signed: bool) -> FloatArray:
    """(k,) that minimize a'Ga + 2 s'a, G (k, k) and s (k,); not negative unless `signed`."""
    if signed:
        return np.asarray(-np.linalg.lstsq(gram, slope, rcond=1e-10)[0])
    # the normal equations' square root keeps the size of the problem at the degrees of freedom
    values, vectors = np.linalg.eigh(gram)
    keep = values > 1e-10 * values.max()
    root = (vectors[:, keep] * np.sqrt(values[keep])).T
    target = -(vectors[:, keep] / np.sqrt(values[keep])).T @ slope
    amplitudes: FloatArray = nnls(root, target)[0]
    return amplitudes
