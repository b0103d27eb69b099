"""Solvers that cost nothing, and fail, kill or dawdle as told."""

from __future__ import annotations

import math
import os
import signal
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.errors import InputError
from doe_kc.true_solver.outcome import Outcome, failure, from_curves
from doe_kc.true_solver.protocol import TrueSolver, digest

BUMP_STEER = list(CHARACTERISTICS).index("vertical.bump_steer")


@dataclass(frozen=True)
class Toy:
    """Bump steer 1000 x deg/m, and cubic further out. log: file that every run is written to.

    fails, kills, breaks, poisons: values of x at which a run fails, ends its process, raises, gives nan.
    kills_once: as kills, but only the first time.
    """

    log: Path
    windows: Mapping[str, float] = field(default_factory=dict)
    quick: bool = False
    exact: bool = False
    seconds: float = 0.0
    fails: tuple[float, ...] = ()
    kills: tuple[float, ...] = ()
    kills_once: tuple[float, ...] = ()
    breaks: tuple[float, ...] = ()
    poisons: tuple[float, ...] = ()
    with_curves: bool = True
    version: str = "1"

    @property
    def name(self) -> str:
        return "toy"

    def describe(self) -> dict[str, str]:
        return {"solver": "toy", "version": self.version}

    def fingerprint(self) -> str:
        return digest(self.describe())

    def prepare(self, designs: Sequence[Mapping[str, float]]) -> TrueSolver:
        return self

    def evaluate(self, values: Mapping[str, float]) -> Outcome:
        if set(values) != {"x"}:
            raise InputError(f"toy: unknown parameter {min(set(values) - {'x'})!r}")
        x = values["x"]
        before = runs_of(self)
        with self.log.open("a") as file:
            file.write(f"{x!r} {os.getpid()}\n")
        time.sleep(self.seconds)
        if x in self.kills or (x in self.kills_once and before.count(x) == 0):
            os.kill(os.getpid(), signal.SIGKILL)
        if x in self.breaks:
            raise ZeroDivisionError("by x")
        if x in self.fails:
            return failure(f"no equilibrium at x = {x:g}")
        curves = toy_curves(math.nan if x in self.poisons else x)
        outcome = from_curves(curves, self.windows, self.seconds)
        return outcome if self.with_curves else replace(outcome, curves=None)


def toy_curves(x: float) -> CurveSet:
    z = np.linspace(-80.0, 80.0, 65)
    both = np.vstack([z, z])
    toe = x * both + 1e-4 * x * both**3
    mean = {"toe": toe, "wc_z": both, "tyre_load": 4000.0 + 20.0 * both}
    still = {name: np.zeros_like(both) for name in mean}
    still["toe"] = still["toe"] + 0.25
    case = CaseCurves("vertical", "mm", z, mean, still)
    return CurveSet("toy", {"vertical": case}, {"toe": np.array([0.1, 0.2])}, 750.0)


def lines(toy: Toy) -> list[list[str]]:
    return [line.split() for line in toy.log.read_text().splitlines()] if toy.log.exists() else []


def runs_of(toy: Toy) -> list[float]:
    """x of every run so far."""
    return [float(words[0]) for words in lines(toy)]


def pids_of(toy: Toy) -> set[int]:
    """Processes that ran something."""
    return {int(words[1]) for words in lines(toy)}


def designs(count: int, start: float = 1.0) -> list[dict[str, float]]:
    return [{"x": start + i} for i in range(count)]


def bump_steer(outcomes: Sequence[Outcome]) -> list[float]:
    return [float(o.characteristics[BUMP_STEER]) for o in outcomes]
