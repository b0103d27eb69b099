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
    from doe_kc.api.adams import AdamsAxle, export_adams, export_kc, import_adams
    from doe_kc.api.axle import parameters, read_axle, types, with_effects, with_values
    from doe_kc.api.check import CheckResult, check
    from doe_kc.api.comparison import ComparisonResult, compare
    from doe_kc.api.correlation import CorrelationResult, correlate
    from doe_kc.api.discovery import DiscoveryResult, discover
    from doe_kc.api.identify import IdentificationResult, identify
    from doe_kc.api.influence import InfluenceResult, influence
    from doe_kc.api.map_rig import map
    from doe_kc.api.measurement import ReductionResult, reduce
    from doe_kc.api.predict import predict
    from doe_kc.api.report import ReportResult, report
    from doe_kc.api.run import RunResult, run
    from doe_kc.api.samples import SamplingResult, sample
    from doe_kc.api.sensitivity import SensitivityResult, sensitivities
    from doe_kc.api.simulation import SimulationResult, simulate
    from doe_kc.api.studies import init, read_study
    from doe_kc.api.surrogate import Surrogate
    from doe_kc.api.surrogates import SurrogatesResult, surrogates
    from doe_kc.axle.model import Axle
    from doe_kc.ground.errors import DoeKcError, InputError, RunError
    from doe_kc.study import Study
    from doe_kc.workflow.export_adams import AdamsExport

_HOMES = {
    "AdamsAxle": "doe_kc.api.adams",
    "AdamsExport": "doe_kc.workflow.export_adams",
    "Axle": "doe_kc.axle.model",
    "CheckResult": "doe_kc.api.check",
    "ComparisonResult": "doe_kc.api.comparison",
    "CorrelationResult": "doe_kc.api.correlation",
    "DiscoveryResult": "doe_kc.api.discovery",
    "DoeKcError": "doe_kc.ground.errors",
    "IdentificationResult": "doe_kc.api.identify",
    "InfluenceResult": "doe_kc.api.influence",
    "InputError": "doe_kc.ground.errors",
    "ReductionResult": "doe_kc.api.measurement",
    "ReportResult": "doe_kc.api.report",
    "RunError": "doe_kc.ground.errors",
    "RunResult": "doe_kc.api.run",
    "SamplingResult": "doe_kc.api.samples",
    "SensitivityResult": "doe_kc.api.sensitivity",
    "SimulationResult": "doe_kc.api.simulation",
    "Study": "doe_kc.study",
    "Surrogate": "doe_kc.api.surrogate",
    "SurrogatesResult": "doe_kc.api.surrogates",
    "check": "doe_kc.api.check",
    "compare": "doe_kc.api.comparison",
    "correlate": "doe_kc.api.correlation",
    "discover": "doe_kc.api.discovery",
    "export_adams": "doe_kc.api.adams",
    "export_kc": "doe_kc.api.adams",
    "import_adams": "doe_kc.api.adams",
    "identify": "doe_kc.api.identify",
    "influence": "doe_kc.api.influence",
    "init": "doe_kc.api.studies",
    "map": "doe_kc.api.map_rig",
    "parameters": "doe_kc.api.axle",
    "predict": "doe_kc.api.predict",
    "read_axle": "doe_kc.api.axle",
    "read_study": "doe_kc.api.studies",
    "reduce": "doe_kc.api.measurement",
    "report": "doe_kc.api.report",
    "run": "doe_kc.api.run",
    "sample": "doe_kc.api.samples",
    "sensitivities": "doe_kc.api.sensitivity",
    "simulate": "doe_kc.api.simulation",
    "surrogates": "doe_kc.api.surrogates",
    "types": "doe_kc.api.axle",
    "with_effects": "doe_kc.api.axle",
    "with_values": "doe_kc.api.axle",
}
"""Public name -> module that defines it."""

__all__ = [
    "AdamsAxle",
    "AdamsExport",
    "Axle",
    "CheckResult",
    "ComparisonResult",
    "CorrelationResult",
    "DiscoveryResult",
    "DoeKcError",
    "IdentificationResult",
    "InfluenceResult",
    "InputError",
    "ReductionResult",
    "ReportResult",
    "RunError",
    "RunResult",
    "SamplingResult",
    "SensitivityResult",
    "SimulationResult",
    "Study",
    "Surrogate",
    "SurrogatesResult",
    "__version__",
    "check",
    "compare",
    "correlate",
    "discover",
    "export_adams",
    "export_kc",
    "identify",
    "import_adams",
    "influence",
    "init",
    "map",
    "parameters",
    "predict",
    "read_axle",
    "read_study",
    "reduce",
    "report",
    "run",
    "sample",
    "sensitivities",
    "simulate",
    "surrogates",
    "types",
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
