"""What is kept of a fit and of a screening, and sent between processes: arrays."""

from __future__ import annotations

import numpy as np

from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result_cache import Arrays
from doe_kc.discovery.screening.screen import Screened
from doe_kc.effects.hypothesis import Hypothesis


def fit_arrays(fit: Fit | None) -> Arrays:
    """A fit without what its model says of it, the derivatives to linear nuisances among that. None: one
    without an equilibrium."""
    if fit is None:
        return {"z": np.zeros(0)}
    return {
        "z": fit.z,
        "residual": fit.residual,
        "jacobian": fit.jacobian.own,
        "evaluations": np.array(float(fit.evaluations)),
        "converged": np.array(float(fit.converged)),
    }


def fit_of_arrays(model: EffectModel, known: Arrays) -> Fit | None:
    """The fit of a model that `fit_arrays` gave these for."""
    if not known["z"].size:
        return None
    z, residual = known["z"], known["residual"]
    counts = int(known["evaluations"]), bool(known["converged"])
    return Fit(model, z, residual, model.jacobian(known["jacobian"]), cost_of(model, z, residual), *counts)


def screening_arrays(screening: Screened) -> Arrays:
    """All of a screening but its hypothesis."""
    return {
        "amplitudes": screening.amplitudes,
        "sd": screening.sd,
        "numbers": np.array([screening.gain, screening.detectability, screening.absorbed]),
        "columns": screening.columns,
        "change": screening.change,
        "bend": screening.bend,
        "visible": screening.size_detectability,
        "failed": np.frombuffer(screening.failed.encode(), dtype=np.uint8).astype(float),
    }


def screening_of_arrays(hypothesis: Hypothesis, known: Arrays) -> Screened:
    """The screening of a hypothesis that `screening_arrays` gave these for."""
    gain, detectability, absorbed = (float(v) for v in known["numbers"])
    return Screened(
        hypothesis,
        known["amplitudes"],
        known["sd"],
        gain,
        known["columns"],
        known["change"],
        known["bend"],
        detectability,
        absorbed,
        known["visible"],
        bytes(known["failed"].astype(np.uint8)).decode(),
    )
