"""What discovery's numbers of choice change: other values on the small cars of the tests, beside the own one.

A choice that no statistics fixes is right where neighbouring values give the same verdicts and sizes and take
longer. `python benchmarks/thresholds.py` prints verdict, effects and CPU seconds, a line a value and car.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from doe_kc.discovery import gauss_newton, thresholds
from doe_kc.discovery.discover import discover
from doe_kc.discovery.result import Discovery
from tests.discovery.cases import known_to, model

CARS = ("named", "pair", "two")
VALUES: dict[str, tuple[Any, ...]] = {
    "FRESH_DECREASE": (0.3, 30.0),
    "REUSE_DECREASE": (0.0, 300.0, 30000.0),
    "FIT_STEPS": (12, 48),
    "LARGEST_RADIUS": (0.7, 6.0),
    "LEAST_STEP": (0.001, 0.00001),
    "PROBE_FACTOR": (0.3, 0.03),
    "SCREEN_STEP_SHARES": ((1.0,), (1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01)),
    "REFITS_MOST": (2, 3, 10),
    "REFIT_SHARE": (0.5, 0.05),
    "RESCREENED_MOST": (3, 30),
    "OVERLOOKED_MOST": (2, 18),
    "UNSURE_SHARE": (0.001, 0.02),
    "CERTAIN_SHARE": (0.05, 0.2),
    "OWN_CONTRASTS": (0.15, 0.5),
    "NAME_ALWAYS_LEVEL": (8.0, 15.0),
    "ALIKE_CORRELATION": (0.7, 0.9),
}


@contextmanager
def threshold(name: str, value: Any) -> Iterator[None]:
    """Another value of a threshold, in all modules of discovery that read it."""
    own = getattr(thresholds, name)
    readers = [m for k, m in sys.modules.items() if k.startswith("doe_kc.discovery") and hasattr(m, name)]
    _assign(readers, name, value)
    try:
        yield
    finally:
        _assign(readers, name, own)


def _assign(readers: list[ModuleType], name: str, value: Any) -> None:
    for module in readers:
        setattr(module, name, value)
    if name == "FIT_STEPS":  # a default argument, read when `fit` was defined
        assert gauss_newton.fit.__kwdefaults__ is not None
        gauss_newton.fit.__kwdefaults__["steps"] = value


def line(car: str, what: str) -> str:
    """One discovery in words."""
    started = time.process_time()
    result = discover(model(car), known_to(car))
    seconds = time.process_time() - started
    words = f"{result.verdict:12}{_effects(result):60}{result.gap.with_effect:8.3f}{seconds:8.1f}"
    return f"{car:12}{what:44}{words}"


def _effects(result: Discovery) -> str:
    return ", ".join(
        f"{f.hypothesis.effect} {'/'.join(f'{e.value:.4g}' for e in f.estimates)}" for f in result.findings
    )


def main() -> None:
    names = sys.argv[1:] or list(VALUES)
    for car in CARS:
        model(car)  # records and solver are made before the first is timed
        discover(model(car), known_to(car))
        print(line(car, "own values"), flush=True)
        for name in names:
            for value in VALUES[name]:
                with threshold(name, value):
                    print(line(car, f"{name} = {value}"), flush=True)


if __name__ == "__main__":
    main()
