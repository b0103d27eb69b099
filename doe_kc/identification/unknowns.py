"""What an identification may change: positions by so many mm, sizes by so many times, about the start."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np

from doe_kc.axle.design_parameters import design_parameters, is_active
from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import COORDINATES, kind_of, must_be_positive, not_below_zero
from doe_kc.axle.parameters import ParameterMap, parameter_value, settable_paths
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray

COORDINATE_SD = 10.0
"""mm; prior standard deviation of a coordinate: another car of the same layout."""
SIZE_SD = 2.5
"""Prior standard deviation of a stiffness or other size, as a ratio: between 1/2.5 and 2.5 times."""
BOUND_SDS = 2.5
"""Prior standard deviations from the start to either bound: 25 mm, a tenth to ten times."""
Free = Sequence[str] | Mapping[str, float] | Mapping[str, float | None]
"""Paths or globs; with a prior standard deviation each: mm of a coordinate, a ratio above 1 of a size, None
for the default."""


@dataclass(frozen=True)
class Unknowns:
    """d parameters of an axle in prior standard deviations z about its values.

    start: (d,) values of the axle. sd: (d,) mm, or the logarithm of a ratio. sized: (d,) bool, changed by
    a ratio instead of a difference.
    """

    axle: Axle
    paths: tuple[str, ...]
    start: FloatArray
    sd: FloatArray
    sized: np.ndarray

    @property
    def units(self) -> tuple[str, ...]:
        """(d,) of the values; "-" for a factor, empty for a size that is no design parameter."""
        kinds = [kind_of(path) for path in self.paths]
        named = ["" if kind is None else kind.unit for kind in kinds]
        return tuple("mm" if _is_coordinate(p) else unit for p, unit in zip(self.paths, named, strict=True))

    def values(self, z: FloatArray) -> FloatArray:
        """(d,) absolute values at z (d,)."""
        move = self.sd * z
        return np.where(self.sized, self.start * np.exp(np.where(self.sized, move, 0.0)), self.start + move)

    def axle_at(self, z: FloatArray) -> Axle:
        """The axle at z (d,)."""
        return ParameterMap(self.axle, self.paths, source="identify").axle(self.values(z).tolist())

    def sd_of_values(self, z: FloatArray, sd: FloatArray) -> FloatArray:
        """(d,) standard deviations sd (d,) of z as those of the values, to first order."""
        return np.asarray(sd * self.sd * np.where(self.sized, self.values(z), 1.0))

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """(d,), (d,) smallest and largest values."""
        ends = np.full(len(self.paths), BOUND_SDS)
        return self.values(-ends), self.values(ends)


def unknowns(axle: Axle, free: Free | None, source: str) -> Unknowns:
    """The paths that match `free`; None: every hardpoint and bushing stiffness that the equations contain.

    Globs meet hardpoints, those that follow another too, and the sizes among the design parameters; further
    sizes, such as steering.column, are named whole.

    Raises InputError for a glob that matches nothing, a parameter that is neither a coordinate nor a size,
    or a standard deviation that is not positive (of a size: not above 1).
    """
    priors = _default(axle) if free is None else _priors(axle, free, source)
    if not priors:
        raise InputError(f"{source}: free names no parameter; name paths or globs such as LLF.* or llr.F?.")
    paths = tuple(priors)
    sized = np.array([_is_size(axle, path) for path in paths])
    start = np.array([parameter_value(axle, path, source=source) for path in paths])
    sd = [_checked_sd(path, priors[path], size, source) for path, size in zip(paths, sized, strict=True)]
    return Unknowns(axle, paths, start, np.array(sd), sized)


def _default(axle: Axle) -> dict[str, float | None]:
    groups = ("HARDPOINTS", "BUSHINGS")
    return {p.path: None for p in design_parameters(axle) if p.in_model and p.group in groups}


def _priors(axle: Axle, free: Free, source: str) -> dict[str, float | None]:
    """Path -> its own standard deviation; of several globs that match, the last decides."""
    if isinstance(free, str):
        raise InputError(f"{source}: free is one text, {free!r}; expected a list of paths or globs.")
    settable = [p for p in settable_paths(axle) if is_active(axle, p)]
    declared = {p.path for p in design_parameters(axle)}
    known = [p for p in settable if _is_coordinate(p) or (p in declared and _is_size(axle, p))]
    pairs = free.items() if isinstance(free, Mapping) else ((glob, None) for glob in free)
    out: dict[str, float | None] = {}
    for glob, sd in pairs:
        alone = glob in settable and (_is_coordinate(glob) or _is_size(axle, glob))
        matches = [glob] if alone else [p for p in known if fnmatchcase(p, glob)]
        if not matches:
            raise InputError(
                f"{source}: free: {glob!r} matches no coordinate, stiffness or other size of the axle's "
                f"equations; expected a path or glob such as LLF.* or llr.F?.{nearest(glob, known)}"
            )
        out |= dict.fromkeys(matches, sd)
    return out


def _is_coordinate(path: str) -> bool:
    return path.partition(".")[2] in COORDINATES


def _is_size(axle: Axle, path: str) -> bool:
    """Whether ratios change it: what must be positive, and a flexibility or rate that is above zero."""
    if must_be_positive(path):
        return True
    return not_below_zero(path) and ".cubic." not in path and parameter_value(axle, path) > 0.0


def _checked_sd(path: str, sd: float | None, size: bool, source: str) -> float:
    value = (SIZE_SD if size else COORDINATE_SD) if sd is None else sd
    if size and not (math.isfinite(value) and value > 1.0):
        raise InputError(f"{source}: free: {path} has the standard deviation {value}, expected a ratio > 1.")
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{source}: free: {path} has the standard deviation {value}, expected mm > 0.")
    return math.log(value) if size else value
