"""doe_kc: make a suspension simulation agree with the measured car.

The Python API is what this module exports, under the names of the commands: `import doe_kc as kc`, then
`kc.simulate(...)`. Each name is loaded at its first use, so that the import alone costs nothing.
"""

from __future__ import annotations

from importlib import import_module

__version__ = "0.1.0"

TYPE_CHECKING = False
"""As `typing.TYPE_CHECKING`, which costs as much to import as all the rest here."""

if TYPE_CHECKING:
    from doe_kc.api.axle import parameters, read_axle, with_effects, with_values
    from doe_kc.api.comparison import ComparisonResult, compare
    from doe_kc.api.correlation import CorrelationResult, correlate
    from doe_kc.api.discovery import DiscoveryResult, discover
    from doe_kc.api.influence import InfluenceResult, influence
    from doe_kc.api.measurement import ReductionResult, reduce
    from doe_kc.api.run import RunResult, run
    from doe_kc.api.samples import SamplingResult, sample
    from doe_kc.api.sensitivity import SensitivityResult, sensitivities
    from doe_kc.api.simulation import SimulationResult, simulate
    from doe_kc.api.studies import read_study
    from doe_kc.api.surrogate import Surrogate
    from doe_kc.axle.model import Axle
    from doe_kc.ground.errors import DoeKcError, InputError, RunError
    from doe_kc.study import Study

_HOMES = {
    "Axle": "doe_kc.axle.model",
    "ComparisonResult": "doe_kc.api.comparison",
    "CorrelationResult": "doe_kc.api.correlation",
    "DiscoveryResult": "doe_kc.api.discovery",
    "DoeKcError": "doe_kc.ground.errors",
    "InfluenceResult": "doe_kc.api.influence",
    "InputError": "doe_kc.ground.errors",
    "ReductionResult": "doe_kc.api.measurement",
    "RunError": "doe_kc.ground.errors",
    "RunResult": "doe_kc.api.run",
    "SamplingResult": "doe_kc.api.samples",
    "SensitivityResult": "doe_kc.api.sensitivity",
    "SimulationResult": "doe_kc.api.simulation",
    "Study": "doe_kc.study",
    "Surrogate": "doe_kc.api.surrogate",
    "compare": "doe_kc.api.comparison",
    "correlate": "doe_kc.api.correlation",
    "discover": "doe_kc.api.discovery",
    "influence": "doe_kc.api.influence",
    "parameters": "doe_kc.api.axle",
    "read_axle": "doe_kc.api.axle",
    "read_study": "doe_kc.api.studies",
    "reduce": "doe_kc.api.measurement",
    "run": "doe_kc.api.run",
    "sample": "doe_kc.api.samples",
    "sensitivities": "doe_kc.api.sensitivity",
    "simulate": "doe_kc.api.simulation",
    "with_effects": "doe_kc.api.axle",
    "with_values": "doe_kc.api.axle",
}
"""Public name -> module that defines it."""

__all__ = [
    "Axle",
    "ComparisonResult",
    "CorrelationResult",
    "DiscoveryResult",
    "DoeKcError",
    "InfluenceResult",
    "InputError",
    "ReductionResult",
    "RunError",
    "RunResult",
    "SamplingResult",
    "SensitivityResult",
    "SimulationResult",
    "Study",
    "Surrogate",
    "__version__",
    "compare",
    "correlate",
    "discover",
    "influence",
    "parameters",
    "read_axle",
    "read_study",
    "reduce",
    "run",
    "sample",
    "sensitivities",
    "simulate",
    "with_effects",
    "with_values",
]


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOMES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
