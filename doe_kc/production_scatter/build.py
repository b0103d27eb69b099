"""Builds the scatter that a study asks for on an axle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from typing import Any

import numpy as np

from doe_kc.axle.design_parameters import Parameter, design_parameters
from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import must_be_positive, not_below_zero
from doe_kc.axle.parameters import parameter_value
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.laws import DEVIATION_LAWS
from doe_kc.production_scatter.model import Scatter, ScatterModel, correlation_matrix
from doe_kc.production_scatter.options import ScatterOptions, ToleranceOptions
from doe_kc.variables.build import plain_parameter

EIGENVALUE_ROUNDING = 1e-9
"""Below zero by no more, an eigenvalue of correlations is one of rounding."""
CORRELATED_NAMED = 4
"""Parameters that a sentence on impossible correlations names."""


def build_scatter(axle: Axle, options: ToleranceOptions, source: str) -> ScatterModel:
    """The scatter of a study; InputError naming `source`, key and remedy for anything wrong.

    By default every parameter that the axle's model contains scatters by its kind (`production_sd`).
    """
    known = {p.path: p for p in design_parameters(axle)}
    _check_globs(axle, options, known, source)
    scatters = tuple(_scatters(axle, options, known, source))
    if not scatters:
        raise InputError(f'{source}: tolerance: no parameter scatters; widen `parameters`, e.g. ["*"].')
    paths = [path for s in scatters for path in s.paths]
    right = [path.startswith("right.") for path in paths]
    mirrored = [s.parameter.mirrored for s in scatters for _ in s.paths]
    model = ScatterModel(
        scatters,
        np.array([parameter_value(axle, path) for path in paths]),
        np.where(np.array(right) & np.array(mirrored), -1.0, 1.0),
        correlation_matrix(scatters, _between(scatters, options, source)),
    )
    _check_correlation(model, source)
    return model


def _check_globs(axle: Axle, options: ToleranceOptions, known: Mapping[str, Parameter], source: str) -> None:
    globs = [("parameters", g) for g in options.parameters]
    globs += [("scatter", s.match) for s in options.scatter]
    for key, glob in globs:
        if any(fnmatchcase(path, glob) for path in known):
            continue
        if key == "scatter" and not any(c in glob for c in "*?["):
            parameter_value(axle, glob, source=f"{source}: tolerance.scatter: match")
            if "." in glob and glob.split(".")[0] in ("left", "right"):
                raise InputError(
                    f"{source}: tolerance.scatter: match = {glob!r} names a side; both sides scatter alike, "
                    "name the parameter alone and say with `common` how alike a car's sides are."
                )
            continue
        raise InputError(
            f"{source}: tolerance.{key}: {glob!r} matches no parameter; expected a path or glob such as "
            f"LLF.* or llr.F?.{nearest(glob, known)}"
        )


def _scatters(
    axle: Axle, options: ToleranceOptions, known: Mapping[str, Parameter], source: str
) -> Iterator[Scatter]:
    """In the order of the parameters; then settable values that are no design parameters."""
    more = [s.match for s in options.scatter if not any(fnmatchcase(path, s.match) for path in known)]
    for path in [*known, *dict.fromkeys(more)]:
        own = [s for s in options.scatter if fnmatchcase(path, s.match)]
        asked = any(fnmatchcase(path, g) for g in options.parameters) or path in more
        parameter = known.get(path) or plain_parameter(axle, path)
        if not asked or not (parameter.in_model or any(s.match == path for s in own)):
            continue
        scatter = _scatter(axle, parameter, own, options, source)
        if scatter.sd > 0.0:
            yield scatter


def _scatter(
    axle: Axle,
    parameter: Parameter,
    own: Sequence[ScatterOptions],
    options: ToleranceOptions,
    source: str,
) -> Scatter:
    law_id = _last(own, "distribution", options.distribution)
    law = DEVIATION_LAWS[law_id](_last(own, "limits", options.limits))
    sd = parameter.production_sd
    for entry in own:
        if entry.sd is not None:
            sd = entry.sd
        elif entry.share is not None:
            sd = entry.share * abs(parameter.nominal)
        elif entry.tolerance is not None:
            sd = law.sd_of(entry.tolerance)
    scatter = Scatter(
        parameter=parameter,
        sd=sd,
        law=law,
        common=_last(own, "common", options.common),
        both_sides=f"{parameter.path}@L" in axle.values,
    )
    _check_reach(scatter, source)
    return scatter


def _last(own: Sequence[ScatterOptions], key: str, default: Any) -> Any:
    values = [getattr(o, key) for o in own if getattr(o, key) is not None]
    return values[-1] if values else default


def _check_reach(scatter: Scatter, source: str) -> None:
    """A value of size stays above zero within the limits of a law that has some."""
    path, parameter = scatter.parameter.path, scatter.parameter
    lowest = parameter.nominal - scatter.reach
    if not math.isfinite(lowest) or scatter.sd == 0.0:
        return
    if (must_be_positive(path) and lowest <= 0.0) or (not_below_zero(path) and lowest < 0.0):
        raise InputError(
            f"{source}: tolerance: {path} = {parameter.nominal:g} {parameter.unit} with a standard deviation "
            f"of {scatter.sd:g} ({scatter.law.label}) reaches {lowest:.3g}, expected above 0; give "
            f'[[tolerance.scatter]] with match = "{path}" a smaller sd or smaller limits.'
        )


def _between(scatters: Sequence[Scatter], options: ToleranceOptions, source: str) -> FloatArray:
    """(p, p) correlations between parameters on the same side."""
    paths = [s.parameter.path for s in scatters]
    out = np.eye(len(paths))
    for entry in options.correlation:
        chosen = [i for i, path in enumerate(paths) if any(fnmatchcase(path, g) for g in entry.match)]
        for glob in entry.match:
            if not any(fnmatchcase(path, glob) for path in paths):
                raise InputError(
                    f"{source}: tolerance.correlation: {glob!r} matches no parameter that scatters."
                    f"{nearest(glob, paths)}"
                )
        if len(chosen) < 2:
            raise InputError(
                f"{source}: tolerance.correlation: match = {entry.match} is one parameter, "
                f"{paths[chosen[0]]}; expected two or more. How alike its sides are is `common` of "
                "[[tolerance.scatter]]."
            )
        for a in chosen:
            for b in chosen:
                if a != b:
                    out[a, b] = entry.value
    return out


def _check_correlation(model: ScatterModel, source: str) -> None:
    """InputError for correlations that no set of cars has, or that two laws do not allow."""
    try:
        matrices = (model.correlation, model.normal_correlation)
    except ValueError as error:
        raise InputError(
            f"{source}: tolerance.correlation: two parameters of unlike distributions can correlate by "
            f"{error}; make the value smaller or the distributions alike."
        ) from None
    for matrix in matrices:
        values, vectors = np.linalg.eigh(matrix)
        if values[0] >= -EIGENVALUE_ROUNDING:
            continue
        weight = model.by_parameter(vectors[:, 0] ** 2)
        shares = np.round(weight / weight.max(), 2)  # equal ones in the order of the axle, by any eigensolver
        order = np.argsort(-shares, kind="stable")[:CORRELATED_NAMED]
        worst = [model.scatters[i].parameter.path for i in order if shares[i] > 0.0]
        raise InputError(
            f"{source}: tolerance.correlation: no cars have all these correlations at once (smallest "
            f"eigenvalue {values[0]:.3g}); make those between {', '.join(worst)} smaller, or give them the "
            "same `common`."
        )
